#include "render/light/sky_light.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "render/brdf/microfacet.h"
#include "render/scene/material.h"
#include "render/vocabulary/clones.h"

namespace hilcam {
namespace {

constexpr float kGolden = 0.61803399f;
constexpr std::size_t kLanes = 16;

// Weights of directions in a facet lobe: D V cos.
HILCAM_CLONES
void lobe_weights(const float* x, const float* y, const float* z, std::size_t count, Vec3f normal, Vec3f view,
                  float alpha, float* weight) {
    const GgxLobe law(alpha, std::max(dot(normal, view), 1e-2f));
    for (std::size_t i = 0; i < count; ++i) {
        const float ni = std::max(x[i] * normal.x + y[i] * normal.y + z[i] * normal.z, 0.0f);
        const float io = x[i] * view.x + y[i] * view.y + z[i] * view.z;
        // The patches' irradiance is across the way: their cosine belongs to the weight.
        weight[i] = ni * law.at(std::max(ni, 1e-3f), io);
    }
}

// Sum of weight times value: a vector holds the bins of one, and four sums side by side do not wait for each other.
// count: a multiple of four.
HILCAM_CLONES
void weighted_sum(const float* weights, const Spectrum* values, std::size_t count, Spectrum& sum) {
    using Bins [[gnu::vector_size(sizeof(Spectrum))]] = float;
    constexpr std::size_t kSums = 4;
    std::array<Bins, kSums> sums = {};
    for (std::size_t i = 0; i < count; i += kSums)
        for (std::size_t k = 0; k < kSums; ++k) {
            Bins value;
            std::memcpy(&value, values[i + k].bin.data(), sizeof value);
            sums[k] += weights[i + k] * value;
        }
    const Bins all = (sums[0] + sums[1]) + (sums[2] + sums[3]);
    std::memcpy(sum.bin.data(), &all, sizeof all);
}

// Direction i of count, evenly on a cone.
Vec3f spiral(Vec3f axis, float one_minus_cosine, std::size_t i, std::size_t count) {
    const float below =
        (static_cast<float>(i) + 0.5f) / static_cast<float>(count) * one_minus_cosine;  // 1 - cos
    const float r = std::sqrt(below * (2 - below)), phi = 2 * kPiF * kGolden * static_cast<float>(i);
    return Frame(axis).to_world({r * std::cos(phi), r * std::sin(phi), 1 - below});
}

// Returns the share of an even sky that a lobe without Fresnel's term reflects: facets that are wide shadow
// each other, and what they then reflect again is not the lobe's. Between 17 widths, linear.
float whole_lobe(float alpha, float no) {
    constexpr int kSteps = 16;
    static const std::array<LobeAlbedo, kSteps + 1> by_alpha = [] {
        std::array<LobeAlbedo, kSteps + 1> out;
        for (int i = 0; i <= kSteps; ++i)
            out[static_cast<std::size_t>(i)] = ggx_albedo(static_cast<float>(i) / kSteps, 0);
        return out;
    }();
    const float x = std::min(alpha, 1.0f) * kSteps;
    const int i = std::min(static_cast<int>(x), kSteps - 1);
    const LobeAlbedo* const at = by_alpha.data() + i;
    const float below = at[0](no);
    return below + (x - static_cast<float>(i)) * (at[1](no) - below);
}

float sign(float x) { return x >= 0 ? 1.0f : -1.0f; }

// Bilinear in a square of steps + 1 values a side; x and y below steps.
Spectrum interpolated(const std::vector<Spectrum>& value, int steps, float x, float y) {
    const int ix = static_cast<int>(x), iy = static_cast<int>(y);
    const float tx = x - static_cast<float>(ix), ty = y - static_cast<float>(iy);
    const Spectrum* corner = value.data() + iy * (steps + 1) + ix;
    return (1 - ty) * ((1 - tx) * corner[0] + tx * corner[1]) +
           ty * ((1 - tx) * corner[steps + 1] + tx * corner[steps + 2]);
}

}  // namespace

SkyLight::SkyLight() { whole_lobe(0, 1); }  // the table is made here, so that no frame makes it

Vec3f SkyLight::DirectionMap::direction(int index) {
    const float x = 2 * static_cast<float>(index % (kSteps + 1)) / kSteps - 1;
    const float y = 2 * static_cast<float>(index / (kSteps + 1)) / kSteps - 1;
    const float z = 1 - std::abs(x) - std::abs(y);
    return normalized(z >= 0 ? Vec3f{x, y, z}
                             : Vec3f{(1 - std::abs(y)) * sign(x), (1 - std::abs(x)) * sign(y), z});
}

Spectrum SkyLight::DirectionMap::at(Vec3f dir) const {
    const float sum = std::abs(dir.x) + std::abs(dir.y) + std::abs(dir.z);
    float x = dir.x / sum, y = dir.y / sum;
    if (dir.z < 0) {
        const float folded = (1 - std::abs(y)) * sign(x);
        y = (1 - std::abs(x)) * sign(y);
        x = folded;
    }
    const auto place = [](float v) { return std::clamp((0.5f * v + 0.5f) * kSteps, 0.0f, kSteps - 1e-3f); };
    const float px = place(x), py = place(y);
    return interpolated(value, kSteps, px, py);
}

void SkyLight::place(const Background& background) {
    background_ = &background;
    count_ = 0;
    for (std::size_t number = 0; number < background.body_lights().size(); ++number) {
        const BodyLight& lamp = background.body_lights()[number];
        const float solid_angle = 2 * kPiF * lamp.one_minus_cosine;
        if (count_ == kMaxBodies || largest(lamp.max_over_sun) * solid_angle < kMinOverSun) continue;
        place_disks(background, number, disks_[count_]);
        const Disk& disk = disks_[count_].of.back();
        Body& body = bodies_[count_];
        body = {to_float(lamp.world_dir), {}, 1, {}};
        const auto add_to = [&disk](Vec3f normal, Spectrum& sum) {
            for (std::size_t i = 0; i < kPatches; ++i)
                sum += std::max(0.0f, disk.x[i] * normal.x + disk.y[i] * normal.y + disk.z[i] * normal.z) *
                       disk.irradiance[i];
        };
        add_to(body.world_dir, body.irradiance_w_m2_um);
        if (!(largest(body.irradiance_w_m2_um) > 0)) continue;
        place_light(disk, body);
        DirectionMap& irradiance = irradiance_[count_];
        for (std::size_t i = 0; i < irradiance.value.size(); ++i) {
            irradiance.value[i] = {};
            add_to(DirectionMap::direction(static_cast<int>(i)), irradiance.value[i]);
        }
        ++count_;
    }
}

// Equal areas on the cone by a golden-angle spiral (Vogel 1979): 64 directions, 1 % of a half-lit disk.
void SkyLight::place_disks(const Background& background, std::size_t number, Disks& disks) {
    const BodyLight& lamp = background.body_lights()[number];
    const float half_angle = 2 * std::asin(std::sqrt(0.5f * lamp.one_minus_cosine));
    disks.cosine = std::cos(half_angle), disks.sine = std::sin(half_angle);
    disks.half_angle_rad = half_angle;
    Disk& whole = disks.of.back();
    const Vec3f axis = to_float(lamp.world_dir);
    find_limb(background, number, disks);
    Spectrum each_sr;
    each_sr.bin.fill(2 * kPiF * lamp.one_minus_cosine / kPatches);
    const auto patch_rad = static_cast<double>(std::sqrt(each_sr[0]));
    for (std::size_t i = 0; i < kPatches; ++i) {
        const Vec3f dir = spiral(axis, lamp.one_minus_cosine, i, kPatches);
        whole.x[i] = dir.x, whole.y[i] = dir.y, whole.z[i] = dir.z;
        whole.irradiance[i] = {};
        Spectrum weight = each_sr;
        background.add_bodies({}, to_double(dir), weight, whole.irradiance[i], patch_rad);
    }
    for (std::size_t k = 0; k < kParts.size(); ++k) {
        // Patches stand twice the cone's half angle over the root of their number apart; facets turn by half
        // of that.
        disks.of[k].min_alpha = half_angle / std::sqrt(static_cast<float>(kParts[k]));
        if (kParts[k] < kPatches) place_parts(whole, axis, lamp.one_minus_cosine, kParts[k], disks.of[k]);
    }
}

void SkyLight::find_limb(const Background& background, std::size_t lamp, Disks& disks) {
    const Frame frame(to_float(background.body_lights()[lamp].world_dir));
    for (std::size_t i = 0; i < Disks::kPlanes; ++i) {
        const float phi = 2 * kPiF * static_cast<float>(i) / Disks::kPlanes;
        const Vec3f way = std::cos(phi) * frame.t + std::sin(phi) * frame.b;
        disks.limb_rad[i] = static_cast<float>(background.limb_angle_rad(lamp, to_double(way)));
    }
}

// way: unit, across the axis.
float SkyLight::Disks::limb_in(Vec3f axis, Vec3f way) const {
    const Frame frame(axis);
    const float turn = std::atan2(dot(way, frame.b), dot(way, frame.t)) / (2 * kPiF);
    const float x = (turn < 0 ? turn + 1 : turn) * static_cast<float>(kPlanes);
    const std::size_t i = static_cast<std::size_t>(x) % kPlanes;
    const float part = std::min(x - std::floor(x), 1.0f);
    return limb_rad[i] + part * (limb_rad[(i + 1) % kPlanes] - limb_rad[i]);
}

// Each patch's light goes to the nearest of fewer, which stand in the middle of what they have of it.
void SkyLight::place_parts(const Disk& whole, Vec3f axis, float one_minus_cosine, std::size_t count,
                           Disk& out) {
    std::array<Vec3f, kPatches> seed, middle{};
    for (std::size_t k = 0; k < count; ++k)
        seed[k] = spiral(axis, one_minus_cosine, k, count), out.irradiance[k] = {};
    for (std::size_t i = 0; i < kPatches; ++i) {
        const Vec3f dir{whole.x[i], whole.y[i], whole.z[i]};
        std::size_t best = 0;
        for (std::size_t k = 1; k < count; ++k)
            if (dot(seed[k], dir) > dot(seed[best], dir)) best = k;
        out.irradiance[best] += whole.irradiance[i];
        middle[best] = middle[best] + largest(whole.irradiance[i]) * dir;
    }
    for (std::size_t k = 0; k < count; ++k) {
        const Vec3f dir = dot(middle[k], middle[k]) > 0 ? normalized(middle[k]) : seed[k];
        out.x[k] = dir.x, out.y[k] = dir.y, out.z[k] = dir.z;
    }
}

// Returns the light that a lobe reflects which is narrow against the disk: all that it sees of the disk has
// one radiance, and the limb cuts off the rest as a straight line does.
Spectrum SkyLight::past_limb(std::size_t body, Vec3f normal, Vec3f view_dir, float alpha) const {
    const Disks& disks = disks_[body];
    const Vec3f axis = bodies_[body].world_dir, mirror = normalized(reflect(view_dir, normal));
    const float cosine = std::clamp(dot(mirror, axis), -1.0f, 1.0f);
    const Vec3f across = mirror - cosine * axis;
    const float sine = length(across);
    const Vec3f way = sine > 1e-6f ? across / sine : Frame(axis).t;
    // Along the great circle from the disk's middle through the mirror's direction.
    const auto at = [&](float angle) { return std::cos(angle) * axis + std::sin(angle) * way; };
    const float limb_rad = disks.limb_in(axis, way), outside = std::acos(cosine) - limb_rad;
    const Vec3f limb = at(limb_rad);
    if (outside > 0 && (alpha == 0 || dot(limb, normal) <= 0)) return {};
    // GGX slopes along one axis: density a^2 / (2 (a^2 + s^2)^1.5) (Heitz, JCGT 3(2), 2014, sec. 5,
    // integrated over the other axis).
    float share = 1;
    if (alpha > 0) {
        const float nh = std::min(dot(normalized(limb + view_dir), normal), 1.0f);
        const float slope = std::sqrt(std::max(1 / std::max(nh * nh, 1e-6f) - 1, 0.0f));
        share = 0.5f + std::copysign(0.5f, -outside) * slope / std::sqrt(slope * slope + alpha * alpha);
    }
    // Past the limb the lobe sees it about as deep as it is away; within, not before its own width.
    const float depth = std::clamp(std::max(outside, alpha), 0.01f * limb_rad, limb_rad);
    const Vec3f seen = outside > -depth ? at(limb_rad - depth) : mirror;
    Spectrum weight, out;
    weight.bin.fill(share);
    // A mirrored ray turns by twice what its facet does: so wide a part of the maps it sees.
    background_->add_bodies({}, to_double(seen), weight, out, 2 * static_cast<double>(alpha));
    return out;
}

// Middle and size of the even disk whose light has the same mean direction and spread: half angle is the root
// of twice the mean square.
void SkyLight::place_light(const Disk& disk, Body& body) {
    Vec3f mean{};
    float sum = 0, square = 0;
    for (std::size_t i = 0; i < kPatches; ++i) {
        const float light = largest(disk.irradiance[i]);
        mean = mean + light * Vec3f{disk.x[i], disk.y[i], disk.z[i]};
        sum += light;
    }
    body.light_dir = normalized(mean);
    for (std::size_t i = 0; i < kPatches; ++i) {
        const Vec3f off = Vec3f{disk.x[i], disk.y[i], disk.z[i]} - body.light_dir;
        square += largest(disk.irradiance[i]) * dot(off, off);
    }
    body.light_cosine = std::max(-1.0f, 1 - square / sum);  // |off|^2 is 2 - 2 cos
}

Spectrum SkyLight::glossy(std::size_t body, Vec3f normal, Vec3f view_dir, float alpha,
                          float reflectance) const {
    const Disks& disks = disks_[body];
    // So many parts that facets' alpha is what they lie apart; else all.
    std::size_t k = 0;
    while (k + 1 < kParts.size() && alpha < 2 * disks.of[k].min_alpha) ++k;
    const Disk& disk = disks.of[k];
    // Those beyond its own shine with nothing.
    const std::size_t count = std::max(kParts[k], kLanes);
    // The lobe at the limb that is nearest to the mirror's direction: where it has next to nothing, all of
    // the disk has.
    const float off = std::clamp(dot(reflect(view_dir, normal), bodies_[body].world_dir), -1.0f, 1.0f);
    // Two parts' distance past the limb a narrow lobe's tail is even over a part, and the disk is no half of
    // the sky.
    if (alpha < disk.min_alpha && off > std::cos(disks.half_angle_rad + 4 * disk.min_alpha))
        return past_limb(body, normal, view_dir, alpha);
    const float limb =
        off >= disks.cosine ? 1.0f : off * disks.cosine + std::sqrt(1 - off * off) * disks.sine;
    const float no = std::max(dot(normal, view_dir), 1e-2f);
    constexpr float kNextToNothing = 1e-3f;  // radiance as a share of the irradiance
    if (reflectance * ggx_distribution(alpha, std::sqrt(0.5f + 0.5f * limb)) * 0.5f /
            (no * std::max(alpha, 1e-4f)) <
        kNextToNothing)
        return {};
    alignas(64) std::array<float, kPatches> weight;
    lobe_weights(disk.x.data(), disk.y.data(), disk.z.data(), count, normal, view_dir, alpha, weight.data());
    Spectrum sum;
    weighted_sum(weight.data(), disk.irradiance.data(), kParts[k], sum);
    return (1 / whole_lobe(alpha, no)) * sum;
}

}  // namespace hilcam
