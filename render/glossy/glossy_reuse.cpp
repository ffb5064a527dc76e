#include "render/glossy/glossy_reuse.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "render/brdf/microfacet.h"
#include "render/visibility/place_sequence.h"
#include "render/vocabulary/clones.h"

namespace hilcam {
namespace {

// Weights fall to zero a pattern's size away (a tent), so that nothing that one ray has met has an edge, and every place of the
// pattern counts alike.
constexpr int kReach_px = kGlossyPattern_px - 1;
constexpr float kLeastPixel = 0.08f;  // weight of pixels that are left out
// Rays that one lobe takes at most.
constexpr std::size_t kMaxTaken = 2048;
// A neighbour's direction that its own lobe hardly draws would count for many rays.
constexpr float kMaxWeight = 4;

// What a lobe takes of the rays about it.
struct Taken {
    std::size_t count = 0;
    alignas(64) std::array<float, kMaxTaken> x, y, z;  // place that is met, from the lobe's point; or the direction
    alignas(64) std::array<float, kMaxTaken> weight;   // before: of the pixel, times per_density; after: of the lobe
    alignas(64) std::array<float, kMaxTaken> pixel;    // weight of the pixel
    alignas(64) std::array<float, kMaxTaken> way_m;    // from the lobe's point to where the ray began
    alignas(64) std::array<float, kMaxTaken> met;      // 1: it has met something; 0: it has not
    std::array<const GlossyRay*, kMaxTaken> ray;
};

HILCAM_CLONES
void weigh(const GgxLobe& lobe, Vec3f normal, Vec3f view, Taken& taken) {
    const GgxLobe law = lobe;
    const Vec3f n = normal, v = view;
    for (std::size_t i = 0; i < taken.count; ++i) {
        const float x = taken.x[i], y = taken.y[i], z = taken.z[i];
        const float per_length = 1 / std::sqrt(std::max(x * x + y * y + z * z, 1e-30f));
        const float ni = (n.x * x + n.y * y + n.z * z) * per_length;
        const float io = (v.x * x + v.y * y + v.z * z) * per_length;
        taken.x[i] = x * per_length, taken.y[i] = y * per_length, taken.z[i] = z * per_length;
        const float weight = taken.weight[i] * (ni > 0 ? ni : 0.0f) * law.at(std::max(ni, 1e-3f), io);
        taken.weight[i] = std::min(weight, kMaxWeight * taken.pixel[i]);
        taken.met[i] *= per_length;
    }
}

// What stands near is in the way of one pixel, and not of the next: rays from so far away as it stands tell nothing.
void leave_out_far(Taken& taken) {
    static const float kOfDistance = getenv("OFD") ? static_cast<float>(atof(getenv("OFD"))) : 2;
    float all = 0, per_distance = 0;
    for (std::size_t i = 0; i < taken.count; ++i)
        all += taken.weight[i], per_distance += taken.weight[i] * taken.met[i];
    if (!(all > 0)) return;
    const float per_m = kOfDistance * per_distance / all;
    for (std::size_t i = 0; i < taken.count; ++i) taken.weight[i] *= std::max(0.0f, 1 - per_m * taken.way_m[i]);
}

// The rays of the pixels about a lobe, which are of its surface and lie beside it.
void take(const GlossyBuffer& buffer, const GlossyPoint& at, int x, int y, Taken& taken) {
    // Facing the viewer, neighbours stand a pixel's width apart; aslant, further.
    const float apart = 2 * kReach_px * at.footprint_m / std::max(dot(at.normal, at.view_dir), 0.1f);
    constexpr float kFacing = 0.5f;  // cosine of normals that are one surface's
    const float most = apart * apart;
    for (int row = std::max(0, y - kReach_px); row <= std::min(buffer.height() - 1, y + kReach_px); ++row)
        for (int column = std::max(0, x - kReach_px); column <= std::min(buffer.width() - 1, x + kReach_px);
             ++column) {
            const auto tent = [](int off) { return 1 - static_cast<float>(std::abs(off)) / kGlossyPattern_px; };
            const float pixel = tent(row - y) * tent(column - x);
            if (pixel < kLeastPixel) continue;
            buffer.for_each_ray(column, row, [&](const GlossyRay& ray, const GlossyPoint& of) {
                const Vec3f way = of.point_m - at.point_m;
                if (taken.count == kMaxTaken || !of.same_surface(at) || dot(way, way) > most ||
                    dot(of.normal, at.normal) < kFacing)
                    return;
                const Vec3f to = ray.free ? ray.met_m : ray.met_m - at.point_m;
                const std::size_t i = taken.count++;
                taken.x[i] = to.x, taken.y[i] = to.y, taken.z[i] = to.z;
                taken.weight[i] = pixel * ray.per_density_sr, taken.pixel[i] = pixel;
                taken.ray[i] = &ray, taken.way_m[i] = std::sqrt(dot(way, way)), taken.met[i] = ray.free ? 0.0f : 1.0f;
            });
        }
}

}  // namespace

GlossyPlace glossy_place(int x, int y, int ray) {
    constexpr int kSize = kGlossyPattern_px;
    constexpr std::array<int, kSize> kReversed = {0, 4, 2, 6, 1, 5, 3, 7};  // bits, from the last
    const auto a = static_cast<float>(kReversed[static_cast<std::size_t>(x % kSize)]),
               b = static_cast<float>(kReversed[static_cast<std::size_t>(y % kSize)]);
    const auto n = static_cast<float>(ray);
    return {std::fmod((a + (b + 0.5f) / kSize) / kSize + kPlasticAlong * n, 1.0f),
            std::fmod((b + (a + 0.5f) / kSize) / kSize + kPlasticAbout * n, 1.0f)};
}

GlossyLight reused_light(const GlossyBuffer& buffer, const Planetshine& planetshine, const GlossyPoint& at, int x,
                         int y) {
    Taken taken;
    take(buffer, at, x, y, taken);
    weigh({at.alpha, std::max(dot(at.normal, at.view_dir), 1e-2f)}, at.normal, at.view_dir, taken);
    leave_out_far(taken);
    float all = 0, squares = 0;
    Spectrum light;
    std::array<float, Planetshine::kMaxBodies> towards{}, free{};
    const std::size_t body_count = planetshine.bodies().size();
    for (std::size_t i = 0; i < taken.count; ++i) {
        const GlossyRay& ray = *taken.ray[i];
        const float weight = taken.weight[i];
        all += weight, squares += weight * weight;
        if (!ray.free) light += (weight * ray.per_scale) * ray.light;
        for (std::size_t b = 0; b < body_count; ++b)
            towards[b] += weight * ray.towards[b], free[b] += ray.free ? weight * ray.towards[b] : 0.0f;
    }
    // As many rays of equal weight would tell as much (Kish, Survey Sampling, 1965, section 8.2).
    const float rays = squares > 0 ? all * all / squares : 0.0f;
    static const float kPrior = getenv("PRIOR") ? static_cast<float>(atof(getenv("PRIOR"))) : 16;
    constexpr float kOfCache = 1;  // rays for which the cache's directions count, where these are enough
    const float trust = rays > 0 ? at.share * rays * rays / (rays * rays + kPrior * at.directions) : 0.0f;
    GlossyLight out;
    if (all > 0) out.surfaces = (trust / all) * (at.weight * light);
    out.surfaces += (1 - trust) * at.cached;
    for (std::size_t b = 0; b < body_count; ++b) {
        const float own = kOfCache / std::max(rays, 1.0f) * towards[b];
        const float seen = towards[b] > 0 ? (free[b] + own * at.free[b]) / (towards[b] + own) : at.free[b];
        out.bodies += (at.share * seen + (1 - at.share) * at.free[b]) * at.bodies[b];
    }
    return out;
}

}  // namespace hilcam
