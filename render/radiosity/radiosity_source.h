#pragma once
// A source whose light is cached (irradiance_cache.h): its place in an object's axes, rounded, so that the
// cached light depends on the rounded place alone.

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "render/brdf/microfacet.h"
#include "render/scene/lamp.h"
#include "render/vocabulary/vec.h"

namespace hilcam {

// Rounds a direction to the middle of a cell of a grid on an octahedron's faces (Cigolle et al., JCGT 3(2),
// 2014).
inline Vec3f rounded_dir(Vec3f dir, float step_rad) {
    const float sum = std::abs(dir.x) + std::abs(dir.y) + std::abs(dir.z);
    const auto sign = [](float x) { return x >= 0 ? 1.0f : -1.0f; };
    float x = dir.x / sum, y = dir.y / sum;
    if (dir.z < 0) {
        const float folded = (1 - std::abs(y)) * sign(x);
        y = (1 - std::abs(x)) * sign(y);
        x = folded;
    }
    // A face's edge of length 1 spans a right angle.
    const float cells = std::ceil(0.5f * kPiF / step_rad);
    // Shifted, because many sources are on an axis, which should not be on the border of two cells.
    const auto middle = [cells](float v) { return (std::floor(v * cells + 0.3f) + 0.2f) / cells; };
    x = std::clamp(middle(x), -1.0f, 1.0f), y = std::clamp(middle(y), -1.0f, 1.0f);
    const float z = 1 - std::abs(x) - std::abs(y);
    return normalized(z >= 0 ? Vec3f{x, y, z}
                             : Vec3f{(1 - std::abs(y)) * sign(x), (1 - std::abs(x)) * sign(y), z});
}

// A source in an object's own axes.
struct RadiositySource {
    enum class Kind : std::uint8_t {
        kNone,
        kSun,   // a point far away; unit: 1 W m^-2 um^-1 across its direction
        kCone,  // a body's disk with uniform radiance; unit: the same on a surface that faces it
        kLamp,  // unit: intensity on its axis
        kGlow   // emission of the materials
    };
    Kind kind = Kind::kNone;
    Vec3f dir{};            // towards the source, unit; a lamp's axis
    float cone_cosine = 1;  // cosine of the cone's half angle
    Vec3f position_m{};     // position of a lamp
    const LampBeam* beam = nullptr;

    bool operator==(const RadiositySource& o) const {
        return kind == o.kind && dir == o.dir && cone_cosine == o.cone_cosine && position_m == o.position_m &&
               beam == o.beam;
    }
    // Returns the source at the middle of its cell, in a grid of about `step_rad`. A lamp's position is
    // rounded to about a hundredth of its distance from the origin.
    RadiositySource rounded(float step_rad) const;
};

// The weight of each of a probe's directions in a cone of light: 1 inside the cone, falling outside it so far
// that about six directions count. Of all directions, a cone contains the share sin^2(half angle) times the
// cosine of its axis.
struct ConeShare {
    Vec3f axis{0, 0, 1};  // probe axes
    float inside = 1, outside = 1;

    ConeShare() = default;
    ConeShare(Vec3f probe_axis, float cone_cosine, int directions) : axis(probe_axis), inside(cone_cosine) {
        constexpr float kEnough = 6, kMinCosine = 0.25f, kSoft_rad = 0.05f;
        const float share = kEnough / (static_cast<float>(directions) * std::max(axis.z, kMinCosine));
        const float half_angle = std::acos(std::clamp(cone_cosine, -1.0f, 1.0f));
        outside = std::cos(std::max(half_angle + kSoft_rad, std::asin(std::sqrt(std::min(share, 1.0f)))));
    }
    float of(float x, float y, float z) const {
        const float past = x * axis.x + y * axis.y + z * axis.z - outside;
        const float in = std::clamp(past / std::max(inside - outside, 1e-3f), 0.0f, 1.0f);
        return in * in;
    }
};

inline RadiositySource RadiositySource::rounded(float step_rad) const {
    RadiositySource out = *this;
    if (kind == Kind::kNone || kind == Kind::kGlow) return out;
    out.dir = rounded_dir(dir, step_rad);
    // Steps of a sixty-fourth of an octave in the sine: about 1 % of the half angle.
    const float sine = std::sqrt(std::max(0.0f, 1 - cone_cosine * cone_cosine));
    if (kind == Kind::kCone && cone_cosine > 0) {
        const float cached = std::exp2(std::round(std::log2(std::max(sine, 1e-6f)) * 64) / 64);
        out.cone_cosine = std::sqrt(std::max(0.0f, 1 - cached * cached));
    }
    if (kind == Kind::kLamp) {
        const float grid_m = std::exp2(std::floor(std::log2(std::max(length(position_m), 1e-3f))) - 6);
        const auto middle = [grid_m](float x) { return (std::floor(x / grid_m) + 0.5f) * grid_m; };
        out.position_m = {middle(position_m.x), middle(position_m.y), middle(position_m.z)};
    }
    return out;
}

}  // namespace hilcam
