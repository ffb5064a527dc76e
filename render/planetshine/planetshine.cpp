#include "render/planetshine/planetshine.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "render/brdf/microfacet.h"
#include "render/scene/material.h"
#include "render/vocabulary/clones.h"
#include "render/vocabulary/lane_sum.h"

namespace hilcam {
namespace {

constexpr float kGoldenTurns = 0.61803399f;
constexpr std::size_t kSkyLanes = 16;

// Sums over a body in a lobe, by its brightest bin: of the light, and of the light times Schlick's Fresnel
// term.
struct SchlickSums {
    float light = 0, term = 0;

    // Returns the cosine at which Fresnel's term equals its mean.
    float facet_cosine() const { return light > 0 ? 1 - std::pow(std::max(term / light, 0.0f), 0.2f) : 1.0f; }
};
// Vectors are written out because GCC 12 splits a plain loop over sixteen lanes. count: a multiple of kLanes.
[[gnu::always_inline]] inline SchlickSums schlick_sums(const float* weight, const float* brightest,
                                                       const float* schlick, std::size_t count) {
    using Eight [[gnu::vector_size(32)]] = float;
    constexpr std::size_t kEach = 8;
    std::array<Eight, kSkyLanes / kEach> lights = {}, terms = {};
    for (std::size_t first = 0; first < count; first += kSkyLanes)
        for (std::size_t k = 0; k < lights.size(); ++k) {
            const std::size_t i = first + kEach * k;
            Eight weights, values, schlicks;
            std::memcpy(&weights, weight + i, sizeof weights);
            std::memcpy(&values, brightest + i, sizeof values);
            std::memcpy(&schlicks, schlick + i, sizeof schlicks);
            const Eight light = weights * values;
            lights[k] += light, terms[k] += light * schlicks;
        }
    std::array<float, kSkyLanes> light, term;
    std::memcpy(light.data(), lights.data(), sizeof light);
    std::memcpy(term.data(), terms.data(), sizeof term);
    return {lane_sum(light), lane_sum(term)};
}

// Sums weight times value: a vector holds the bins of one value, and four sums in parallel do not wait for
// each other. count: a multiple of four.
[[gnu::always_inline]] inline void weighted_sum(const float* weights, const Spectrum* values,
                                                std::size_t count, Spectrum& sum) {
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

// Returns direction i of `count`, spread evenly over a cone.
Vec3f spiral(Vec3f axis, float one_minus_cosine, std::size_t i, std::size_t count) {
    const float below =
        (static_cast<float>(i) + 0.5f) / static_cast<float>(count) * one_minus_cosine;  // 1 - cos
    const float r = std::sqrt(below * (2 - below)), phi = 2 * kPiF * kGoldenTurns * static_cast<float>(i);
    return Frame(axis).to_world({r * std::cos(phi), r * std::sin(phi), 1 - below});
}

// Returns the share of a uniform sky that a lobe without Fresnel's term reflects: wide facets shadow each
// other, and their further reflections are not in the lobe. Tabulated at 17 widths, linear in between.
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

// Returns half the angle of a body's cone.
float half_angle_rad(const PlanetshineSource& lamp) {
    return 2 * std::asin(std::sqrt(0.5f * lamp.one_minus_cosine));
}

float sign(float x) { return x >= 0 ? 1.0f : -1.0f; }

// Bilinear in a square of steps + 1 values per side; x and y are below `steps`.
Spectrum interpolated(const std::vector<Spectrum>& value, int steps, float x, float y) {
    const int ix = static_cast<int>(x), iy = static_cast<int>(y);
    const float tx = x - static_cast<float>(ix), ty = y - static_cast<float>(iy);
    const Spectrum* corner = value.data() + iy * (steps + 1) + ix;
    return (1 - ty) * ((1 - tx) * corner[0] + tx * corner[1]) +
           ty * ((1 - tx) * corner[steps + 1] + tx * corner[steps + 2]);
}

}  // namespace

Planetshine::Planetshine(float narrowest_alpha) : narrowest_alpha_(narrowest_alpha) {
    whole_lobe(0, 1);  // makes the table here, so that no frame has to
}

bool Planetshine::is_clear_of_bodies(Vec3f dir) const {
    return std::none_of(cones_.begin(), cones_.begin() + static_cast<std::ptrdiff_t>(cone_count_),
                        [&](const Cone& cone) { return dot(cone.axis, dir) >= cone.cosine; });
}

float Planetshine::brightness(std::size_t body, Vec3f dir) const {
    if (!is_met(body, dir)) return 0;
    const Disk& disk = disks_[body].of[kEven];
    float nearest = -1, brightest = 0;
    for (std::size_t i = 0; i < kParts[kEven]; ++i) {
        const float cosine = disk.x[i] * dir.x + disk.y[i] * dir.y + disk.z[i] * dir.z;
        if (cosine > nearest) nearest = cosine, brightest = disk.brightest[i];
    }
    return brightest;
}

Vec3f Planetshine::DirectionMap::direction(int index) {
    const float x = 2 * static_cast<float>(index % (kSteps + 1)) / kSteps - 1;
    const float y = 2 * static_cast<float>(index / (kSteps + 1)) / kSteps - 1;
    const float z = 1 - std::abs(x) - std::abs(y);
    return normalized(z >= 0 ? Vec3f{x, y, z}
                             : Vec3f{(1 - std::abs(y)) * sign(x), (1 - std::abs(x)) * sign(y), z});
}

Spectrum Planetshine::DirectionMap::at(Vec3f dir) const {
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

void Planetshine::place(const Background& background, float margin_rad) {
    background_ = &background;
    cone_count_ = 0;
    for (const PlanetshineSource& lamp : background.planetshine_sources()) {
        const float half_rad = std::min(half_angle_rad(lamp) + margin_rad, kPiF);
        cones_[cone_count_++] = {to_float(lamp.world_dir), std::cos(half_rad)};
    }
    count_ = 0;
    for (std::size_t number = 0; number < background.planetshine_sources().size(); ++number) {
        const PlanetshineSource& lamp = background.planetshine_sources()[number];
        const float solid_angle = 2 * kPiF * lamp.one_minus_cosine;
        if (count_ == kMaxBodies || max_component(lamp.max_over_sun) * solid_angle < kMinOverSun) continue;
        const std::array<Look, kLooks> looks = looks_at(background, number);
        place_disks(background, lamp, looks, disks_[count_]);
        Body& body = bodies_[count_];
        body = {to_float(lamp.world_dir), {}, 1, {}};
        // All looks count: with a fourth as many, surfaces that see a part of the disk are up to 3 % off.
        const auto add_to = [&looks](Vec3f normal, Spectrum& sum) {
            for (const Look& look : looks) sum += std::max(0.0f, dot(look.dir, normal)) * look.irradiance;
        };
        add_to(body.world_dir, body.irradiance_w_m2_um);
        if (!(max_component(body.irradiance_w_m2_um) > 0)) continue;
        place_light(disks_[count_].of[kEven], body);
        DirectionMap& irradiance = irradiance_[count_];
        for (std::size_t i = 0; i < irradiance.value.size(); ++i) {
            irradiance.value[i] = {};
            add_to(DirectionMap::direction(static_cast<int>(i)), irradiance.value[i]);
        }
        ++count_;
    }
}

// Equal areas on the cone, by a golden-angle spiral (Vogel 1979).
std::array<Planetshine::Look, Planetshine::kLooks> Planetshine::looks_at(const Background& background,
                                                                         std::size_t number) {
    const PlanetshineSource& lamp = background.planetshine_sources()[number];
    Spectrum each_sr;
    each_sr.bin.fill(2 * kPiF * lamp.one_minus_cosine / kLooks);
    const auto look_rad = static_cast<double>(std::sqrt(each_sr[0]));
    std::array<Look, kLooks> looks;
    for (std::size_t i = 0; i < kLooks; ++i) {
        looks[i] = {spiral(to_float(lamp.world_dir), lamp.one_minus_cosine, i, kLooks), {}};
        Spectrum weight = each_sr;
        background.add_bodies({}, to_double(looks[i].dir), weight, looks[i].irradiance, look_rad);
    }
    return looks;
}

void Planetshine::place_disks(const Background& background, const PlanetshineSource& lamp,
                              std::span<const Look> looks, Disks& disks) const {
    const float half_angle = half_angle_rad(lamp);
    disks.cosine = std::cos(half_angle), disks.sine = std::sin(half_angle);
    disks.half_angle_rad = half_angle;
    const Vec3f axis = to_float(lamp.world_dir);
    for (std::size_t k = 0; k < kParts.size(); ++k) {
        if (k > kEven && narrowest_alpha_ >= disks.of[kEven].min_alpha) break;
        // The distance between patches is the cone's full angle over the root of their number; facets turn by
        // half of that.
        disks.of[k].min_alpha = half_angle / std::sqrt(static_cast<float>(kParts[k]));
        place_parts(looks, axis, lamp.one_minus_cosine, kParts[k], disks.of[k]);
    }
    if (narrowest_alpha_ < std::min(disks.of[kEven].min_alpha, disks.of.back().min_alpha))
        disks.map.place(background, axis, lamp.one_minus_cosine, narrowest_alpha_);
}

// Assigns each look's light to the nearest of fewer parts, each at the centroid of its light.
void Planetshine::place_parts(std::span<const Look> looks, Vec3f axis, float one_minus_cosine,
                              std::size_t count, Disk& out) {
    std::array<Vec3f, kPatches> seed, middle{};
    for (std::size_t k = 0; k < count; ++k)
        seed[k] = spiral(axis, one_minus_cosine, k, count), out.irradiance[k] = {};
    for (const Look& look : looks) {
        std::size_t best = 0;
        float nearest = -2;
        for (std::size_t k = 0; k < count; ++k)
            if (const float cosine = dot(seed[k], look.dir); cosine > nearest) nearest = cosine, best = k;
        out.irradiance[best] += look.irradiance;
        middle[best] = middle[best] + max_component(look.irradiance) * look.dir;
    }
    for (std::size_t k = 0; k < count; ++k) {
        out.brightest[k] = max_component(out.irradiance[k]);
        const Vec3f dir = dot(middle[k], middle[k]) > 0 ? normalized(middle[k]) : seed[k];
        out.x[k] = dir.x, out.y[k] = dir.y, out.z[k] = dir.z;
    }
}

namespace {

// Slopes of facets that represent equal shares of the GGX distribution: a share u leans by at most alpha
// sqrt(u / (1 - u)) (Walter et al., EGSR 2007, eq. 35).
struct FacetSlopes {
    static constexpr std::size_t kMax = 64;
    std::size_t count;
    std::array<float, kMax> x{}, y{}, squared{};  // in units of alpha

    explicit FacetSlopes(std::size_t n) : count(n) {
        for (std::size_t i = 0; i < n; ++i) {
            const float u = (static_cast<float>(i) + 0.5f) / static_cast<float>(n);
            const float phi = 2 * kPiF * kGoldenTurns * static_cast<float>(i);
            squared[i] = u / (1 - u);
            x[i] = std::sqrt(squared[i]) * std::cos(phi), y[i] = std::sqrt(squared[i]) * std::sin(phi);
        }
    }
};
// The limb is an edge, for which sixteen are not enough: 0.04 of the disk's light.
const FacetSlopes kSlopes(16), kSlopesAtLimb(64);

}  // namespace

// Facets of the lobe, each with what it sees of the map over its share of the directions (Krivanek & Colbert,
// GPU Gems 3, 2007, ch. 20). Facets for which the map is too coarse look together along the mirror direction,
// and one by one near the disk's limb.
Planetshine::Glossy Planetshine::narrow_lobe(std::size_t body, Vec3f normal, Vec3f view_dir,
                                             float alpha) const {
    const Disks& disks = disks_[body];
    const Frame local(normal);
    const float no = std::max(dot(normal, view_dir), 1e-2f);
    const auto look_at = [&](Vec3f dir, float spread_sr) {
        Spectrum weight, out;
        weight.bin.fill(1);
        background_->add_bodies({}, to_double(dir), weight, out, std::sqrt(static_cast<double>(spread_sr)));
        return out;
    };
    constexpr float kLimb = 4;  // reach of four fifths of the facets [alpha]
    const Vec3f mirror = normalized(reflect(view_dir, normal));
    const float off = std::acos(std::clamp(dot(mirror, bodies_[body].world_dir), -1.0f, 1.0f));
    const bool at_limb = std::abs(off - disks.half_angle_rad) < kLimb * alpha;
    const FacetSlopes& slopes = at_limb ? kSlopesAtLimb : kSlopes;
    Spectrum sum;
    float all = 0, together = 0, density = 0;
    SchlickSums sums;
    const auto add = [&](const Spectrum& light, float weight, float vh) {
        const float bright = weight * max_component(light);
        sum += weight * light;
        sums.light += bright, sums.term += bright * schlick_weight(vh);
    };
    for (std::size_t i = 0; i < slopes.count; ++i) {
        const float steep = 1 + alpha * alpha * slopes.squared[i], nh = 1 / std::sqrt(steep);
        const Vec3f facet = nh * local.to_world({alpha * slopes.x[i], alpha * slopes.y[i], 1});
        const Vec3f dir = reflect(view_dir, facet);
        const float vh = dot(view_dir, facet), ni = dot(normal, dir);
        if (!(vh > 0 && ni > 0)) continue;
        // The density of the facet's mirrored direction is D nh / (4 vh) (Walter et al., eq. 38). The weight
        // is the lobe's reflection over that density; the spread is the share of directions that the facet
        // represents.
        const float weight = 4 * vh / nh * ni * ggx_visibility(alpha, no, ni);
        const float spread_sr =
            4 * vh / (nh * ggx_distribution(alpha, nh) * static_cast<float>(slopes.count));
        all += weight;
        if (spread_sr >= disks.map.texel_sr())
            add(disks.map.about(dir, spread_sr), weight, vh);
        else if (at_limb)
            add(look_at(dir, spread_sr), weight, vh);
        else
            together += weight, density += weight / spread_sr;
    }
    // Together they cover about as much as a uniform disk of the same mean density.
    if (together > 0) add(look_at(mirror, together * together / density), together, no);
    if (!(all > 0)) return {};
    return {(whole_lobe(alpha, no) / all) * sum, sums.facet_cosine()};
}

// Finds middle and size of the uniform disk whose light has the same mean direction and spread: its half
// angle is the root of twice the mean square.
void Planetshine::place_light(const Disk& disk, Body& body) {
    Vec3f mean{};
    float sum = 0, square = 0;
    for (std::size_t i = 0; i < kParts[kEven]; ++i) {
        const float light = max_component(disk.irradiance[i]);
        mean = mean + light * Vec3f{disk.x[i], disk.y[i], disk.z[i]};
        sum += light;
    }
    body.light_dir = normalized(mean);
    for (std::size_t i = 0; i < kParts[kEven]; ++i) {
        const Vec3f off = Vec3f{disk.x[i], disk.y[i], disk.z[i]} - body.light_dir;
        square += max_component(disk.irradiance[i]) * dot(off, off);
    }
    body.light_cosine = std::max(-1.0f, 1 - square / sum);  // |off|^2 is 2 - 2 cos
}

// The part of a disk that lobes see.
struct Planetshine::Seen {
    static constexpr float kNextToNothing = 1e-3f;
    std::array<float, Lobes::kMax> off;   // cosine between the mirror's direction and the disk's
    std::array<float, Lobes::kMax> most;  // upper bound of radiance over irradiance
    // For lobes in which this is not negligible.
    std::array<SchlickSums, Lobes::kMax> sums;
    std::array<Spectrum, Lobes::kMax> radiance;
};

// One kernel for everything, because calls through clones cost as much as sixteen directions.
HILCAM_CLONES
void Planetshine::look(const Disks& disks, const Disk& disk, std::size_t count, Vec3f body_dir,
                       const Lobes& lobes, Seen& seen) {
    const Vec3f view = lobes.view_dir;
    const float alpha = lobes.alpha;
    // The lobe's value at the point of the limb nearest to the mirror direction: if it is negligible there,
    // so it is on the whole disk.
    constexpr std::size_t kEach = 8;
    const std::size_t filled = (lobes.count + kEach - 1) / kEach * kEach;
    for (std::size_t k = 0; k < filled; ++k) {
        const Vec3f normal{lobes.x[k], lobes.y[k], lobes.z[k]};
        const float off = std::clamp(dot(reflect(view, normal), body_dir), -1.0f, 1.0f);
        const float beside = off * disks.cosine + std::sqrt(1 - off * off) * disks.sine;
        const float limb = off >= disks.cosine ? 1.0f : beside;
        const float no = std::max(dot(normal, view), 1e-2f);
        seen.off[k] = off;
        seen.most[k] = lobes.reflectance * ggx_distribution(alpha, std::sqrt(0.5f + 0.5f * limb)) * 0.5f /
                       (no * std::max(alpha, 1e-4f));
    }
    // Schlick's Fresnel term, relative to full reflection, depends only on the viewer.
    alignas(64) std::array<float, kPatches> to_view, schlick, weight;
    for (std::size_t i = 0; i < count; ++i) {
        to_view[i] = disk.x[i] * view.x + disk.y[i] * view.y + disk.z[i] * view.z;
        const float left = 1 - std::sqrt(std::max(0.5f + 0.5f * to_view[i], 0.0f)), squared = left * left;
        schlick[i] = squared * squared * left;
    }
    for (std::size_t k = 0; k < lobes.count; ++k) {
        if (seen.most[k] < Seen::kNextToNothing) continue;
        const Vec3f normal{lobes.x[k], lobes.y[k], lobes.z[k]};
        const GgxLobe law(alpha, std::max(dot(normal, view), 1e-2f));
        for (std::size_t i = 0; i < count; ++i) {
            const float ni =
                std::max(disk.x[i] * normal.x + disk.y[i] * normal.y + disk.z[i] * normal.z, 0.0f);
            // The patches' irradiance is on a facing surface, so the weight includes their cosine.
            weight[i] = ni * law.at(std::max(ni, 1e-3f), to_view[i]);
        }
        weighted_sum(weight.data(), disk.irradiance.data(), count, seen.radiance[k]);
        seen.sums[k] = schlick_sums(weight.data(), disk.brightest.data(), schlick.data(), count);
    }
}

Planetshine::Glossy Planetshine::glossy(std::size_t body, Vec3f normal, Vec3f view_dir, float alpha,
                                        float reflectance) const {
    Lobes lobes{view_dir, alpha, reflectance};
    lobes.add(normal);
    Glossy out;
    glossy(body, lobes, {&out, 1});
    return out;
}

void Planetshine::glossy(std::size_t body, const Lobes& lobes, std::span<Glossy> out) const {
    const Disks& disks = disks_[body];
    const float alpha = lobes.alpha;
    // Few parts if facets turn by at most half of alpha from one part to the next.
    const std::size_t parts =
        alpha < disks.of[kEven].min_alpha ? 2 : (alpha < 2 * disks.of.front().min_alpha ? 1 : 0);
    const Disk& disk = disks.of[parts];
    Seen seen;
    look(disks, disk, kParts[parts], bodies_[body].world_dir, lobes, seen);
    // Two parts' distance beyond the limb a narrow lobe's tail is uniform over a part, and the disk is less
    // than half of the sky.
    const bool narrow = alpha < disk.min_alpha;
    const float close = narrow ? std::cos(disks.half_angle_rad + 4 * disk.min_alpha) : 1.0f;
    for (std::size_t k = 0; k < lobes.count; ++k) {
        if (narrow && seen.off[k] > close)
            out[k] = narrow_lobe(body, lobes.normal(k), lobes.view_dir, alpha);
        else if (!(seen.most[k] < Seen::kNextToNothing) && seen.sums[k].light > 0)
            out[k] = {seen.radiance[k], seen.sums[k].facet_cosine()};
        else
            out[k] = {};
    }
}

}  // namespace hilcam
