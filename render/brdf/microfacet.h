#pragma once
// The parts of microfacet reflection: GGX normals, Smith shadowing, Fresnel. Unit vectors; `no`, `ni`, `nh`
// are the cosines between the shading normal and the viewer, the light, and their half vector. Inline,
// because it is called per ray.

#include <algorithm>
#include <cmath>

#include "render/vocabulary/units.h"
#include "render/vocabulary/vec.h"

namespace hilcam {

// (1 - cosine)^5 of Schlick's Fresnel term: F = F0 + (1 - F0) * this (Computer Graphics Forum 13(3), 1994).
inline float schlick_weight(float cosine) {
    const float x = std::clamp(1.0f - cosine, 0.0f, 1.0f);
    return x * x * x * x * x;
}

// Returns the unpolarised Fresnel reflectance of a smooth dielectric for light from vacuum: Born & Wolf,
// Principles of Optics, chapter 1.5. refractive_index >= 1.
inline float fresnel_dielectric(float refractive_index, float cosine) {
    const float c = std::clamp(cosine, 0.0f, 1.0f);
    const float n2 = refractive_index * refractive_index;
    const float g = std::sqrt(n2 - 1 + c * c);
    const float perpendicular = (c - g) / (c + g);
    const float parallel = (n2 * c - g) / (n2 * c + g);
    return 0.5f * (perpendicular * perpendicular + parallel * parallel);
}

// GGX distribution of normals [sr^-1]: Walter et al., EGSR 2007, eq. 33.
inline float ggx_distribution(float alpha, float nh) {
    const float a2 = alpha * alpha;
    const float t = nh * nh * (a2 - 1) + 1;
    return a2 / (kPiF * t * t);
}

// G2 / (4 no ni), Smith height-correlated: Heitz, JCGT 3(2), 2014, eq. 99.
inline float ggx_visibility(float alpha, float no, float ni) {
    const float a2 = alpha * alpha;
    return 0.5f / (ni * std::sqrt(no * no * (1 - a2) + a2) + no * std::sqrt(ni * ni * (1 - a2) + a2));
}

// A facet lobe for one viewer and many light directions: ggx_distribution() times ggx_visibility() with one
// division and no branches, for vectorised loops.
struct GgxLobe {
    float alpha_squared, no, masked_o;

    GgxLobe(float alpha, float cosine)
        : alpha_squared(alpha * alpha),
          no(cosine),
          masked_o(std::sqrt(cosine * cosine * (1 - alpha_squared) + alpha_squared)) {}
    // ni: cosine of the light's direction, above zero; io: cosine between light and viewer.
    float at(float ni, float io) const {
        // Squared length of the half vector before normalisation.
        const float half = std::max(2 + 2 * io, 1e-6f);
        const float nh = std::min((no + ni) * (no + ni), half);
        const float t = nh * (alpha_squared - 1) + half;
        const float masked_i = std::sqrt(ni * ni * (1 - alpha_squared) + alpha_squared);
        return 0.5f * alpha_squared * half * half / (kPiF * t * t * (ni * masked_o + no * masked_i));
    }
};

// G2 / G1 of a facet that the viewer sees: the weight of a sample from visible normals (Heitz, JCGT 7(4),
// 2018, eq. 19).
inline float ggx_sample_weight(float alpha, float no, float ni) {
    const float a2 = alpha * alpha;
    const float lambda_o = std::sqrt(no * no * (1 - a2) + a2);
    const float lambda_i = std::sqrt(ni * ni * (1 - a2) + a2);
    return ni * (no + lambda_o) / (ni * lambda_o + no * lambda_i);
}

// Density of directions from sample_visible_normal() and a reflection [sr^-1]: G1 D / (4 no) (Heitz 2018, eq.
// 17).
inline float ggx_density(float alpha, float no, float nh) {
    const float a2 = alpha * alpha;
    return ggx_distribution(alpha, nh) / (2 * (no + std::sqrt(no * no * (1 - a2) + a2)));
}

// A right-handed frame of the unit vector n and two others: Duff et al., JCGT 6(1), 2017.
struct Frame {
    Vec3f t, b, n;
    explicit Frame(Vec3f normal) : n(normal) {
        const float sign = std::copysign(1.0f, n.z);
        const float a = -1.0f / (sign + n.z);
        const float c = n.x * n.y * a;
        t = {1.0f + sign * n.x * n.x * a, sign * c, -sign * n.x};
        b = {c, sign + n.y * n.y * a, -n.y};
    }
    Vec3f to_world(Vec3f v) const { return v.x * t + v.y * b + v.z * n; }
    Vec3f to_local(Vec3f v) const { return {dot(v, t), dot(v, b), dot(v, n)}; }
};

// A place in the unit disk, chosen uniformly by two numbers in [0, 1).
struct DiskPlace {
    float radius, cosine, sine;

    static DiskPlace of(float u1, float u2) {
        const float phi = 2 * kPiF * u2;
        return {std::sqrt(u1), std::cos(phi), std::sin(phi)};
    }
};

// Draws a facet normal from the GGX normals that are visible from `view` (local frame, z = normal): Heitz
// 2018.
inline Vec3f sample_visible_normal(float alpha, Vec3f view, DiskPlace at) {
    const Vec3f v = normalized(Vec3f{alpha * view.x, alpha * view.y, view.z});
    const float across = v.x * v.x + v.y * v.y;
    const Vec3f t1 = across > 0 ? Vec3f{-v.y, v.x, 0} / std::sqrt(across) : Vec3f{1, 0, 0};
    const Vec3f t2 = cross(v, t1);
    const float p1 = at.radius * at.cosine;
    const float s = 0.5f * (1 + v.z);
    const float p2 = (1 - s) * std::sqrt(std::max(0.0f, 1 - p1 * p1)) + s * at.radius * at.sine;
    const Vec3f n = p1 * t1 + p2 * t2 + std::sqrt(std::max(0.0f, 1 - p1 * p1 - p2 * p2)) * v;
    return normalized(Vec3f{alpha * n.x, alpha * n.y, std::max(1e-6f, n.z)});
}
inline Vec3f sample_visible_normal(float alpha, Vec3f view, float u1, float u2) {
    return sample_visible_normal(alpha, view, DiskPlace::of(u1, u2));
}

// Draws a direction above the local plane with density cos/pi (Malley's method, pbrt 3rd ed., 13.6.3).
inline Vec3f sample_cosine(float u1, float u2) {
    const float r = std::sqrt(u1);
    const float phi = 2 * kPiF * u2;
    return {r * std::cos(phi), r * std::sin(phi), std::sqrt(std::max(0.0f, 1 - u1))};
}

inline Vec3f reflect(Vec3f view, Vec3f normal) { return 2 * dot(view, normal) * normal - view; }

// Draws a direction towards the light (world) by reflection at a facet of the lobe, with density
// ggx_density(). local: frame about the normal.
inline Vec3f sample_facets(float alpha, const Frame& local, Vec3f view_dir, DiskPlace at) {
    const Vec3f facet = local.to_world(sample_visible_normal(alpha, local.to_local(view_dir), at));
    return normalized(reflect(view_dir, facet));
}
inline Vec3f sample_facets(float alpha, const Frame& local, Vec3f view_dir, float u1, float u2) {
    return sample_facets(alpha, local, view_dir, DiskPlace::of(u1, u2));
}

}  // namespace hilcam
