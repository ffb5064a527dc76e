#include "render/glossy/glossy_reuse.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "render/brdf/microfacet.h"
#include "render/visibility/place_sequence.h"
#include "render/vocabulary/clones.h"

namespace hilcam {
namespace {

constexpr float kLeastPixel =
    0.08f;  // weight of pixels that are left out: a third of them, with 5 % of the weight
constexpr std::size_t kMaxTaken =
    2048;  // rays that one lobe takes: of all pixels in reach, some with two surfaces
// Limits the weight of a neighbour's ray in a direction that the neighbour's lobe hardly draws; a lobe's own
// rays have a weight of at most one. Without this limit p99 of Hubble by the Earth's light is 25.5 instead of
// 24.3 sensor noises.
constexpr float kMaxWeight = 4;
// Cosine between normals beyond which a surface has turned a corner. Without this limit light between two
// walls of one surface is 10 % low instead of 4 %.
constexpr float kFacing = 0.5f;

// The rays that a lobe uses, by column.
struct Taken {
    using Column = std::array<float, kMaxTaken>;
    std::size_t count = 0;
    alignas(64) Column x, y, z;       // from the lobe's point to the place that is met, or direction
    alignas(64) Column weight;        // weight of the pixel times per_density_sr; later that of the lobe
    alignas(64) Column pixel;         // weight of the pixel
    alignas(64) Column way_m;         // from the lobe's point to where the ray began
    alignas(64) Column per_distance;  // 1 if something is met, else 0; later divided by its distance
    std::array<const GlossyRay*, kMaxTaken> ray;

    void add(const GlossyRay& of, Vec3f to, float way, float pixel_weight) {
        const std::size_t i = count++;
        x[i] = to.x, y[i] = to.y, z[i] = to.z;
        weight[i] = pixel_weight * of.per_density_sr, pixel[i] = pixel_weight;
        way_m[i] = way, per_distance[i] = of.free ? 0.0f : 1.0f;
        ray[i] = &of;
    }
};

// Collects the rays of pixels around a lobe, in `within`, that belong to its surface and start near it.
void take(const GlossyBuffer& buffer, const GlossyPoint& at, int x, int y, const PixelBox& within,
          Taken& taken) {
    // Neighbours are a pixel's width apart, or farther on an oblique surface.
    const float apart_m =
        static_cast<float>(at.reach_px) * at.footprint_m / std::max(dot(at.normal, at.view_dir), 0.1f);
    // Weights fall to zero at the end of the reach (a tent). So a thing that one ray has met causes no edge
    // in the picture, and every place of the pattern has the same weight.
    const float per_px = 1 / static_cast<float>(at.reach_px);
    const auto tent = [&](int off) { return 1 - per_px * static_cast<float>(std::abs(off)); };
    const int reach = at.reach_px - 1;
    for (int row = std::max(within.y0, y - reach); row <= std::min(within.y1 - 1, y + reach); ++row)
        for (int column = std::max(within.x0, x - reach); column <= std::min(within.x1 - 1, x + reach);
             ++column) {
            const float pixel = tent(row - y) * tent(column - x);
            if (pixel < kLeastPixel) continue;
            buffer.for_each_ray(column, row, [&](const GlossyStart& start, const GlossyRay& ray) {
                const Vec3f way = start.point_m - at.point_m;
                const float squared_m2 = dot(way, way);
                if (taken.count == kMaxTaken || !start.on_surface_of(at) ||
                    squared_m2 > 2 * apart_m * apart_m || dot(start.normal, at.normal) < kFacing)
                    return;
                taken.add(ray, ray.free ? ray.met_m : ray.met_m - at.point_m, std::sqrt(squared_m2), pixel);
            });
        }
}

// Weights each ray by the lobe's reflection from its direction over the density of that direction.
HILCAM_CLONES
void weigh(const GgxLobe& lobe, Vec3f normal, Vec3f view, Taken& taken) {
    const GgxLobe law = lobe;
    const Vec3f n = normal, v = view;
    for (std::size_t i = 0; i < taken.count; ++i) {
        const float x = taken.x[i], y = taken.y[i], z = taken.z[i];
        const float per_length = 1 / std::sqrt(std::max(x * x + y * y + z * z, 1e-30f));
        const float ni = (n.x * x + n.y * y + n.z * z) * per_length;
        const float io = (v.x * x + v.y * y + v.z * z) * per_length;
        const float weight = taken.weight[i] * (ni > 0 ? ni : 0.0f) * law.at(std::max(ni, 1e-3f), io);
        taken.weight[i] = std::min(weight, kMaxWeight * taken.pixel[i]);
        taken.per_distance[i] *= per_length;
    }
}

// Returns the mean of one over the distance at which a lobe's rays have met something [1/m].
float mean_per_distance(const Taken& taken) {
    float all = 0, per_distance = 0;
    for (std::size_t i = 0; i < taken.count; ++i)
        all += taken.weight[i], per_distance += taken.weight[i] * taken.per_distance[i];
    return all > 0 ? per_distance / all : 0.0f;
}

// Removes rays that start too far away: a near thing hides different places for neighbouring pixels. A ray
// that starts a quarter as far away as the things that rays meet, on average, has no weight. Without this,
// light leaks past edges: Kepler's p99 is 21 instead of 16 sensor noises. With a half its rms is 3.5, with a
// quarter 3.05, and Hubble's grows beyond.
void leave_out_far(float per_distance, Taken& taken) {
    constexpr float kOfDistance = 4;
    for (std::size_t i = 0; i < taken.count; ++i)
        taken.weight[i] *= std::max(0.0f, 1 - kOfDistance * per_distance * taken.way_m[i]);
}

// Weights the rays for a lobe. Returns the mean of one over the distance at which they have met something
// [1/m].
float weigh_all(const GlossyPoint& at, Taken& taken) {
    weigh({at.alpha, std::max(dot(at.normal, at.view_dir), 1e-2f)}, at.normal, at.view_dir, taken);
    const float per_distance = mean_per_distance(taken);
    leave_out_far(per_distance, taken);
    return per_distance;
}

// Returns how many rays the cache's directions are worth. The directions start at a probe, so they say little
// about things that are nearer than the distance between probes. Without this, narrow strips between Hubble's
// tube and ring have half their light.
float rays_of_cache(const GlossyPoint& at, float per_distance) {
    // With 16 instead of 2, rms of Hubble by the Earth's light is 10.4 instead of 9.9 sensor noises.
    constexpr float kPerDirection = 2;
    constexpr float kWholeFrom = 2;  // full worth from here on [distances between probes]
    const float near = 1 / std::max(kWholeFrom * at.probes_apart_m * per_distance, 1.0f);
    return kPerDirection * near * near * at.directions;
}

// The sums over what a lobe takes.
struct Sums {
    float all = 0, squares = 0;  // weights
    Spectrum light;
    std::array<float, Planetshine::kMaxBodies> towards{},
        free{};  // by body: its radiance along rays, and where they meet nothing

    explicit Sums(const Taken& taken) {
        for (std::size_t i = 0; i < taken.count; ++i) {
            const GlossyRay& ray = *taken.ray[i];
            const float weight = taken.weight[i];
            all += weight, squares += weight * weight;
            if (!ray.free) light += weight * ray.light;
            for (std::size_t b = 0; b < towards.size(); ++b)
                towards[b] += weight * ray.towards[b], free[b] += ray.free ? weight * ray.towards[b] : 0.0f;
        }
    }
    // The number of rays of equal weight with the same variance (Kish, Survey Sampling, 1965, section 8.2).
    float rays() const { return squares > 0 ? all * all / squares : 0.0f; }
};

}  // namespace

GlossyPlace glossy_place(int x, int y, int ray, int reach_px) {
    // The pixel's number in the window: 2 x 2 pixels have four successive ones, and so on.
    std::uint32_t number = 0;
    for (int bit = reach_px / 2; bit > 0; bit /= 2)
        number = 4 * number + (((x ^ y) & bit) != 0 ? 2u : 0u) + ((y & bit) != 0 ? 1u : 0u);
    constexpr std::uint32_t kMiddle = 1u << 25;  // half of a 64th
    const auto index = static_cast<std::uint32_t>(ray * reach_px * reach_px) + number;
    const auto [u1, u2] = place_in_sequence(index, kMiddle, kMiddle);
    return {u1, u2};
}

float glossy_error(const GlossyBuffer& buffer, const GlossyPoint& at, int x, int y, const PixelBox& within) {
    Taken taken;
    take(buffer, at, x, y, within, taken);
    weigh_all(at, taken);
    const Sums sums(taken);
    if (!(sums.all > 0)) return at.share * max_component(at.cached);
    // Light of all bodies for a ray that meets nothing, per unit of what it would see of them.
    float bodies = 0, towards = 0;
    for (std::size_t b = 0; b < at.bodies.size(); ++b)
        bodies += max_component(at.bodies[b]), towards += sums.towards[b];
    const float per_towards = towards > 0 ? bodies * sums.all / towards : 0.0f;
    const float to_pixel = max_component(at.weight);
    float of_light = 0, squares = 0, crossed = 0;  // sums of w l, (w l)^2, w^2 l
    for (std::size_t i = 0; i < taken.count; ++i) {
        const GlossyRay& ray = *taken.ray[i];
        float light = 0;
        if (ray.free)
            for (const float body : ray.towards) light += per_towards * body;
        else
            light = to_pixel * max_component(ray.light);
        const float weight = taken.weight[i];
        of_light += weight * light;
        squares += weight * weight * light * light, crossed += weight * weight * light;
    }
    // The variance of a ratio estimator (Cochran, Sampling Techniques, 1977, section 6.4). The cache's value
    // counts as one more ray, because a few rays that agree prove little.
    const float mean = of_light / sums.all;
    const float off = max_component(at.cached) - mean;
    const float variance =
        squares - 2 * mean * crossed + mean * mean * sums.squares + sums.squares / sums.rays() * off * off;
    return at.share * std::sqrt(std::max(variance, 0.0f)) / sums.all;
}

GlossyLight reused_light(const GlossyBuffer& buffer, const GlossyPoint& at, int x, int y) {
    Taken taken;
    take(buffer, at, x, y, {0, 0, buffer.width(), buffer.height()}, taken);
    const float per_distance = weigh_all(at, taken);
    const Sums sums(taken);
    const float rays = sums.rays();
    // The fewer rays count, the more the cache's directions replace them.
    const float trust =
        rays > 0 ? at.share * rays * rays / (rays * rays + rays_of_cache(at, per_distance)) : 0.0f;
    GlossyLight out;
    if (sums.all > 0) out.surfaces = (trust / sums.all) * (at.weight * sums.light);
    out.surfaces += (1 - trust) * at.cached;
    for (std::size_t b = 0; b < at.bodies.size(); ++b) {
        // The cache's value counts as one ray.
        const float towards = sums.towards[b], one = towards / std::max(rays, 1.0f);
        const float free = towards > 0 ? (sums.free[b] + one * at.free[b]) / (towards + one) : at.free[b];
        out.bodies += (at.share * free + (1 - at.share) * at.free[b]) * at.bodies[b];
    }
    return out;
}

}  // namespace hilcam
