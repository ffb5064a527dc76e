#include "render/light/sky_light.h"

#include <algorithm>
#include <cmath>

#include "render/scene/brdf_microfacet.h"
#include "render/vocabulary/clones.h"

namespace hilcam {
namespace {

constexpr float kGolden = 0.61803399f;

// Weights of directions in a facet lobe: D V cos, brdf_microfacet.h, without branches.
HILCAM_CLONES
void lobe_weights(const float* x, const float* y, const float* z, std::size_t count, Vec3f normal, Vec3f view,
                  float alpha, float* weight) {
    const float no = std::max(dot(normal, view), 1e-2f), a2 = alpha * alpha;
    const float masked_o = std::sqrt(no * no * (1 - a2) + a2);
    for (std::size_t i = 0; i < count; ++i) {
        const float ni = std::max(x[i] * normal.x + y[i] * normal.y + z[i] * normal.z, 0.0f);
        const float io = x[i] * view.x + y[i] * view.y + z[i] * view.z;
        const float nh2 = std::min((no + ni) * (no + ni) / std::max(2 + 2 * io, 1e-6f), 1.0f);
        const float t = nh2 * (a2 - 1) + 1;
        const float masked_i = std::sqrt(ni * ni * (1 - a2) + a2);
        // The patches' irradiance is across the way: their cosine belongs to the weight.
        weight[i] = ni * a2 / (kPiF * t * t) * 0.5f / (std::max(ni, 1e-3f) * masked_o + no * masked_i);
    }
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

SkyLight::SkyLight() = default;

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
    count_ = 0;
    for (const BodyLamp& lamp : background.lamps()) {
        const float solid_angle = 2 * kPiF * lamp.one_minus_cosine;
        if (count_ == kMostBodies || largest(lamp.most_over_sun) * solid_angle < kLeastOverSun) continue;
        Disk& disk = disks_[count_] = disk_of(background, lamp);
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
SkyLight::Disk SkyLight::disk_of(const Background& background, const BodyLamp& lamp) {
    const Frame axis(to_float(lamp.world_dir));
    Spectrum each_sr;
    each_sr.bin.fill(2 * kPiF * lamp.one_minus_cosine / kPatches);
    Disk out{};
    for (std::size_t i = 0; i < kPatches; ++i) {
        const float below = (static_cast<float>(i) + 0.5f) / kPatches * lamp.one_minus_cosine;  // 1 - cos
        const float r = std::sqrt(below * (2 - below)), phi = 2 * kPiF * kGolden * static_cast<float>(i);
        const Vec3f dir = axis.to_world({r * std::cos(phi), r * std::sin(phi), 1 - below});
        out.x[i] = dir.x, out.y[i] = dir.y, out.z[i] = dir.z;
        Spectrum weight = each_sr;
        background.add_bodies({}, to_double(dir), weight, out.irradiance[i]);
    }
    // Patches stand twice the cone's half angle over the root of their number apart; facets turn by half of
    // that.
    const float half_angle = 2 * std::asin(std::sqrt(0.5f * lamp.one_minus_cosine));
    out.cosine = std::cos(half_angle), out.sine = std::sin(half_angle);
    out.least_alpha = half_angle / std::sqrt(static_cast<float>(kPatches));
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
    const Disk& disk = disks_[body];
    const float width = std::max(alpha, disk.least_alpha);
    // The lobe at the limb that is nearest to the mirror's direction: where it has next to nothing, all of
    // the disk has.
    const float off = std::clamp(dot(reflect(view_dir, normal), bodies_[body].world_dir), -1.0f, 1.0f);
    const float limb = off >= disk.cosine ? 1.0f : off * disk.cosine + std::sqrt(1 - off * off) * disk.sine;
    const float no = std::max(dot(normal, view_dir), 1e-2f);
    constexpr float kNextToNothing = 1e-3f;  // of the irradiance, as radiance
    if (reflectance * ggx_distribution(width, std::sqrt(0.5f + 0.5f * limb)) * 0.5f / (no * width) <
        kNextToNothing)
        return {};
    alignas(64) std::array<float, kPatches> weight;
    lobe_weights(disk.x.data(), disk.y.data(), disk.z.data(), kPatches, normal, view_dir, width,
                 weight.data());
    Spectrum sum;
    for (std::size_t i = 0; i < kPatches; ++i) sum += weight[i] * disk.irradiance[i];
    return sum;
}

}  // namespace hilcam
