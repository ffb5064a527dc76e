#include "render/light/sky_light.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "render/scene/brdf_microfacet.h"

namespace hilcam {
namespace {

// Equal areas on the cone by a golden-angle spiral (Vogel 1979): 64 directions, 1 % of a half-lit disk.
constexpr int kQuadrature = 64;
constexpr float kGolden = 0.61803399f;

struct Patch {
    Vec3f dir;
    Spectrum irradiance;  // on a surface that faces it
};

std::array<Patch, kQuadrature> patches_of(const Background& background, const BodyLamp& lamp) {
    const Frame axis(to_float(lamp.world_dir));
    const float each_sr = 2 * kPiF * lamp.one_minus_cosine / kQuadrature;
    std::array<Patch, kQuadrature> out;
    for (int i = 0; i < kQuadrature; ++i) {
        const float below = (static_cast<float>(i) + 0.5f) / kQuadrature * lamp.one_minus_cosine;  // 1 - cos
        const float r = std::sqrt(below * (2 - below)), phi = 2 * kPiF * kGolden * static_cast<float>(i);
        Patch& patch = out[static_cast<std::size_t>(i)];
        patch.dir = axis.to_world({r * std::cos(phi), r * std::sin(phi), 1 - below});
        Spectrum weight;
        weight.bin.fill(each_sr);
        background.add_bodies({}, to_double(patch.dir), weight, patch.irradiance);
    }
    return out;
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
    return normalized(z >= 0 ? Vec3f{x, y, z} : Vec3f{(1 - std::abs(y)) * sign(x), (1 - std::abs(x)) * sign(y), z});
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
        const std::array<Patch, kQuadrature> patches = patches_of(background, lamp);
        Body& body = bodies_[count_];
        body = {to_float(lamp.world_dir), 1 - lamp.one_minus_cosine, {}};
        for (const Patch& patch : patches)
            body.irradiance_w_m2_um += std::max(0.0f, dot(patch.dir, body.world_dir)) * patch.irradiance;
        if (!(largest(body.irradiance_w_m2_um) > 0)) continue;
        DirectionMap& irradiance = irradiance_[count_];
        tbb::parallel_for(0, static_cast<int>(irradiance.value.size()), [&](int i) {
            const Vec3f normal = DirectionMap::direction(i);
            Spectrum sum;
            for (const Patch& patch : patches) sum += std::max(0.0f, dot(normal, patch.dir)) * patch.irradiance;
            irradiance.value[static_cast<std::size_t>(i)] = sum;
        });
        std::array<ConeMap, kAlphas.size()>& glossy = glossy_[count_];
        const Frame axis(body.world_dir);
        const float half_angle = std::acos(std::clamp(body.cone_cosine, -1.0f, 1.0f));
        for (std::size_t a = 0; a < kAlphas.size(); ++a)
            // Beyond twenty times its alpha a lobe has 1 / 400 of its light.
            glossy[a].reach_rad = std::min(kPiF, half_angle + 20 * kAlphas[a]);
        tbb::parallel_for(0, static_cast<int>(glossy.size() * glossy[0].value.size()), [&](int i) {
            const std::size_t a = static_cast<std::size_t>(i) / glossy[0].value.size();
            const std::size_t k = static_cast<std::size_t>(i) % glossy[0].value.size();
            const Vec3f mirror = glossy[a].direction(axis, static_cast<int>(k));
            // No lobe is narrower than the patches lie apart.
            const float alpha = std::max(kAlphas[a], 0.5f * half_angle / std::sqrt(static_cast<float>(kQuadrature)));
            Spectrum sum;
            for (const Patch& patch : patches) {
                // Seen along the normal, all of the lobe is D / 4 d omega, which sums to 1 but for what goes below.
                const float half = std::sqrt(std::max(0.0f, 0.5f + 0.5f * dot(mirror, patch.dir)));
                sum += (0.25f * ggx_distribution(alpha, half)) * patch.irradiance;
            }
            glossy[a].value[k] = sum;
        });
        ++count_;
    }
}

Vec3f SkyLight::ConeMap::direction(const Frame& axis, int index) const {
    const float x = 2 * static_cast<float>(index % (kSteps + 1)) / kSteps - 1;
    const float y = 2 * static_cast<float>(index / (kSteps + 1)) / kSteps - 1;
    const float r = std::sqrt(x * x + y * y), angle = std::min(kPiF, r * reach_rad);
    if (!(r > 0)) return axis.n;
    const float sine = std::sin(angle) / r;
    return axis.to_world({x * sine, y * sine, std::cos(angle)});
}

Spectrum SkyLight::ConeMap::at(const Frame& axis, Vec3f dir) const {
    const Vec3f local = axis.to_local(dir);
    const float across = std::sqrt(local.x * local.x + local.y * local.y);
    const float r = std::atan2(across, local.z) / reach_rad;
    if (r >= 1) return {};
    const float scale = across > 0 ? r / across : 0.0f;
    const auto place = [](float v) { return std::clamp((0.5f * v + 0.5f) * kSteps, 0.0f, kSteps - 1e-3f); };
    return interpolated(value, kSteps, place(local.x * scale), place(local.y * scale));
}

Spectrum SkyLight::glossy(std::size_t body, Vec3f world_dir, float alpha) const {
    const std::array<ConeMap, kAlphas.size()>& maps = glossy_[body];
    const Frame axis(bodies_[body].world_dir);
    std::size_t i = 0;
    while (i + 2 < kAlphas.size() && alpha > kAlphas[i + 1]) ++i;
    const float t = std::clamp((alpha - kAlphas[i]) / (kAlphas[i + 1] - kAlphas[i]), 0.0f, 1.0f);
    return (1 - t) * maps[i].at(axis, world_dir) + t * maps[i + 1].at(axis, world_dir);
}

}  // namespace hilcam
