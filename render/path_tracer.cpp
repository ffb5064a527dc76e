#include "render/path_tracer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "render/brdf.h"
#include "render/path_vertex.h"

namespace hilcam {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr auto kMost = static_cast<std::size_t>(TileTracer::kMostSamples);

// A ray that continues a path.
struct NextRay {
    std::uint32_t from;  // vertex it leaves
    Vec3f origin_m;
    Vec3f dir;
    bool sees_earth;    // specular: meets the Earth itself; diffuse ones have a sample of their own for it
    float alpha_least;  // of the next vertex's lobe; 0 only along mirrors, which then see the Sun's disk
    Spectrum weight;
};

// Random words of a path's vertex; `use` tells apart what they are for.
std::array<std::uint32_t, 4> random_of(const FrameView& frame, const PixelBox& tile, const Vertex& at,
                                       int depth, std::uint32_t use) {
    const int width = tile.x1 - tile.x0;
    const int px = tile.x0 + static_cast<int>(at.pixel) % width;
    const int py = tile.y0 + static_cast<int>(at.pixel) / width;
    return random_words(frame.key, RandomPurpose::kPathSample,
                        static_cast<std::uint32_t>(py * frame.geometry.padded_width() + px),
                        (at.sample * 64 + static_cast<std::uint32_t>(depth)) * 2 + use);
}
// Schlick's Fresnel reflectance per bin (CGF 13(3), 1994); the bins past the grid's size are not zero.
Spectrum fresnel(const Spectrum& normal_reflectance, float schlick) {
    Spectrum out;
    for (int b = 0; b < kMaxBins; ++b) out[b] = normal_reflectance[b] + (1 - normal_reflectance[b]) * schlick;
    return out;
}

// The Sun's disk widens a highlight: its angular radius 4.65 mrad turns facets by half of that (Karis,
// SIGGRAPH 2013 course notes, "representative point" widening).
float sun_widened(float alpha) { return std::min(1.0f, alpha + 0.00233f); }
// Behind a diffuse bounce a narrow lobe is met by luck alone; its lobe is widened to this so that the mean
// stays and the sparkle goes (path space regularisation: Kaplanyan & Dachsbacher, CGF 32(2), 2013).
constexpr float kAlphaBehindDiffuse = 0.4f;

}  // namespace

struct TileTracer::Implementation {
    std::array<Vertex, kMost> vertices_a, vertices_b;
    std::array<NextRay, kMost> next;
    std::array<Spectrum, kMost> pixels;
    TileStats stats;

    Vertex* current = vertices_a.data();
    Vertex* following = vertices_b.data();
    std::size_t count = 0;

    void add_background(const FrameView& frame, Vec3f origin_m, Vec3f dir, bool sun_disk,
                        const Spectrum& weight, Spectrum& pixel) const;
    std::size_t primary_rays(const FrameView& frame, const PixelBox& tile, bool shade);
    void light_from_sun(const FrameView& frame);
    void light_from_sun_bare(const FrameView& frame);
    std::size_t choose_earth(const FrameView& frame, const PixelBox& tile, int depth);
    void light_from_earth(const FrameView& frame, std::size_t ray_count);
    std::size_t choose_next(const FrameView& frame, const PixelBox& tile, int depth);
    void follow(const FrameView& frame, std::size_t ray_count);
};

int tile_edge_px(int n) {
    for (const int edge : {32, 16, 8, 4, 2, 1})
        if (edge * edge * n * n <= TileTracer::kMostSamples) return edge;
    HILCAM_CHECK(!"samples_per_axis is at most 32");
    return 1;
}

TileTracer::TileTracer() : implementation_(std::make_unique<Implementation>()) {}
TileTracer::~TileTracer() = default;
TileTracer::TileTracer(TileTracer&&) noexcept = default;

void TileTracer::Implementation::add_background(const FrameView& frame, Vec3f origin_m, Vec3f dir,
                                                bool sun_disk, const Spectrum& weight,
                                                Spectrum& pixel) const {
    if (frame.background->add_earth(origin_m, to_double(dir), weight, pixel)) return;
    if (sun_disk) frame.background->add_sun_disk(dir, weight, pixel);
}

// --- wave 1: from the camera
// -------------------------------------------------------------------------------------

std::size_t TileTracer::Implementation::primary_rays(const FrameView& frame, const PixelBox& tile,
                                                     bool shade) {
    const int n = frame.samples_per_axis;
    const int width = tile.x1 - tile.x0;
    const bool earth = tile.overlaps(frame.earth_box);
    const bool sun = tile.overlaps(frame.sun_box);
    const bool background = shade && (earth || sun);
    const float share = 1.0f / static_cast<float>(n * n);
    Spectrum weight;
    for (int b = 0; b < frame.bins; ++b) weight[b] = share;

    RayPacket rays;
    HitPacket hits;
    std::array<float, kPacketSize> x_of{}, y_of{};  // of the packet's pixels, from the tile's corner
    std::array<float, kPacketSize> x_at, y_at;      // of their samples
    EarthRays::Floats sun_cosine;
    rays.origin_x.fill(0), rays.origin_y.fill(0), rays.origin_z.fill(0);
    rays.nearest.fill(0), rays.farthest.fill(kInfinity);
    // Single precision is enough from the tile's corner on: 32 px of 2^-24 of a pixel's angle.
    const Vec3d corner =
        frame.corner_world_dir + tile.x0 * frame.right_world_dir + tile.y0 * frame.down_world_dir;
    const Vec3f corner_dir = to_float(corner);
    const Vec3f right = to_float(frame.right_world_dir), down = to_float(frame.down_world_dir);
    // The Earth's limb must not crawl: the eye's own rays meet it in double precision.
    const EarthRays earth_rays =
        frame.background->earth_rays(corner, frame.right_world_dir, frame.down_world_dir);
    const bool plain_earth = earth && !frame.background->earth_has_map();
    count = 0;

    const auto add_backdrop = [&](std::size_t k, Spectrum& pixel) {
        if (plain_earth && sun_cosine[k] > EarthRays::kMiss) {
            frame.background->add_earth_at(sun_cosine[k], weight, pixel);
            return;
        }
        const Vec3d dir = corner + static_cast<double>(x_at[k]) * frame.right_world_dir +
                          static_cast<double>(y_at[k]) * frame.down_world_dir;
        if (earth && !plain_earth && frame.background->add_earth({0, 0, 0}, dir, weight, pixel)) return;
        if (sun) frame.background->add_sun_disk(to_float(normalized(dir)), weight, pixel);
    };
    const auto shade_packet = [&](bool objects, float dx, float dy, std::uint32_t sample) {
        for (std::size_t k = 0; k < kPacketSize; ++k) {
            const float x = x_at[k] = x_of[k] + dx, y = y_at[k] = y_of[k] + dy;
            rays.dir_x[k] = corner_dir.x + x * right.x + y * down.x;
            rays.dir_y[k] = corner_dir.y + x * right.y + y * down.y;
            rays.dir_z[k] = corner_dir.z + x * right.z + y * down.z;
        }
        if (objects) {
            frame.scene->intersect(rays, Coherence::kCoherent, hits);
            stats.primary_rays += static_cast<std::uint64_t>(rays.count);
        } else {
            hits.object.fill(HitPacket::kMiss);
        }
        if (background && plain_earth) earth_rays.sun_cosines(x_at, y_at, sun_cosine);
        for (int i = 0; i < rays.count; ++i) {
            const auto k = static_cast<std::size_t>(i);
            const auto pixel =
                static_cast<std::uint32_t>(static_cast<int>(y_of[k]) * width + static_cast<int>(x_of[k]));
            const Vec3f dir{rays.dir_x[k], rays.dir_y[k], rays.dir_z[k]};
            if (meets_object(frame, hits, i, {0, 0, 0}, dir)) {
                ++stats.object_hits;
                Vertex& vertex = current[count];
                if (!make_vertex(frame, hits, i, {0, 0, 0}, dir, 0, vertex)) continue;
                vertex.pixel = pixel;
                vertex.sample = sample;
                vertex.weight = weight;
                ++count;
            } else if (background) {
                add_backdrop(k, pixels[pixel]);
            }
        }
    };

    // Blocks of 4 x 4 pixels, so that a packet's rays run close together; they are the mask's blocks too.
    static_assert(ScreenMask::kBlock_px == 4);
    const float step = 1.0f / static_cast<float>(n);
    for (int by = tile.y0; by < tile.y1; by += 4)
        for (int bx = tile.x0; bx < tile.x1; bx += 4) {
            const bool objects = frame.object_mask->at(bx, by);
            if (!objects && !background) continue;
            rays.count = 0;
            for (int y = by; y < std::min(by + 4, tile.y1); ++y)
                for (int x = bx; x < std::min(bx + 4, tile.x1); ++x) {
                    x_of[static_cast<std::size_t>(rays.count)] = static_cast<float>(x - tile.x0);
                    y_of[static_cast<std::size_t>(rays.count)] = static_cast<float>(y - tile.y0);
                    ++rays.count;
                }
            for (int s = 0; s < n * n; ++s)
                shade_packet(objects, (static_cast<float>(s % n) + 0.5f) * step,
                             (static_cast<float>(s / n) + 0.5f) * step, static_cast<std::uint32_t>(s));
        }
    return count;
}

// --- direct light
// ------------------------------------------------------------------------------------------------

void TileTracer::Implementation::light_from_sun(const FrameView& frame) {
    const Vec3f sun = to_float(frame.background->sun_world_dir());
    const Spectrum& irradiance = frame.background->sun_irradiance_w_m2_um();
    if (largest(irradiance) <= 0) return;

    RayPacket rays;
    std::array<std::size_t, kPacketSize> vertex_of;
    rays.count = 0;
    const auto flush = [&] {
        if (rays.count == 0) return;
        const std::uint32_t blocked = frame.scene->occluded(rays);
        stats.shadow_rays += static_cast<std::uint64_t>(rays.count);
        for (int i = 0; i < rays.count; ++i) {
            if (blocked >> i & 1u) continue;
            const Vertex& at = current[vertex_of[static_cast<std::size_t>(i)]];
            const float ni = dot(at.normal, sun);
            const float no = std::max(dot(at.normal, at.view_dir), 1e-4f);
            float lobe = 0, schlick = 0;
            if (at.specular && !at.mirror) {
                const Vec3f half = normalized(sun + at.view_dir);
                const float alpha = sun_widened(at.alpha);
                schlick = schlick_weight(dot(half, sun));
                lobe = ggx_distribution(alpha, std::clamp(dot(at.normal, half), 0.0f, 1.0f)) *
                       ggx_visibility(alpha, no, ni);
            }
            Spectrum brdf = (1 / kPiF) * at.diffuse_albedo;
            if (lobe > 0) brdf += lobe * fresnel(at.normal_reflectance, schlick);
            pixels[at.pixel] += ni * (at.weight * irradiance) * brdf;
        }
        rays.count = 0;
    };
    for (std::size_t i = 0; i < count; ++i) {
        const Vertex& at = current[i];
        if (at.mirror || dot(at.geometric_normal, sun) <= 0 || dot(at.normal, sun) <= 0) continue;
        vertex_of[static_cast<std::size_t>(rays.count)] = i;
        rays.set(rays.count, at.point_m + at.offset_m * at.geometric_normal, sun, 0, kInfinity);
        if (++rays.count == kPacketSize) flush();
    }
    flush();
}

void TileTracer::Implementation::light_from_earth(const FrameView& frame, std::size_t ray_count) {
    RayPacket rays;
    std::array<std::size_t, kPacketSize> index;
    rays.count = 0;
    const auto flush = [&] {
        if (rays.count == 0) return;
        const std::uint32_t blocked = frame.scene->occluded(rays);
        stats.secondary_rays += static_cast<std::uint64_t>(rays.count);
        for (int i = 0; i < rays.count; ++i) {
            if (blocked >> i & 1u) continue;
            const NextRay& ray = next[index[static_cast<std::size_t>(i)]];
            frame.background->add_earth(ray.origin_m, to_double(ray.dir), ray.weight,
                                        pixels[current[ray.from].pixel]);
        }
        rays.count = 0;
    };
    for (std::size_t i = 0; i < ray_count; ++i) {
        index[static_cast<std::size_t>(rays.count)] = i;
        rays.set(rays.count, next[i].origin_m, next[i].dir, 0, kInfinity);
        if (++rays.count == kPacketSize) flush();
    }
    flush();
}

// --- the recursion
// -----------------------------------------------------------------------------------------------

// A ray towards a random point of the Earth's bounding cone from every diffuse vertex it can light: density
// 1 / (2 pi (1 - cos)) per solid angle.
std::size_t TileTracer::Implementation::choose_earth(const FrameView& frame, const PixelBox& tile,
                                                     int depth) {
    if (!frame.background->earth_visible()) return 0;
    const Frame earth(to_float(frame.background->earth_world_dir()));
    const auto cosine = static_cast<float>(frame.background->earth_cone_cosine());
    const float sine = std::sqrt(std::max(0.0f, 1 - cosine * cosine));
    const float least = frame.contribution_threshold / frame.samples();
    std::size_t ray_count = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const Vertex& at = current[i];
        // What the whole cone could give at most, against white paint under it.
        const float most = largest(at.diffuse_albedo) * largest(at.weight) * 2 * (1 - cosine);
        if (most < least || dot(at.geometric_normal, earth.n) < -sine) continue;
        const auto random = random_of(frame, tile, at, depth, 1);
        const float u1 = uniform01(random[0]), u2 = uniform01(random[1]);
        const float z = 1 - u1 * (1 - cosine);
        const float r = std::sqrt(std::max(0.0f, 1 - z * z));
        NextRay& ray = next[ray_count];
        ray.dir = earth.to_world({r * std::cos(2 * kPiF * u2), r * std::sin(2 * kPiF * u2), z});
        const float ni = dot(at.normal, ray.dir);
        if (ni <= 0 || dot(at.geometric_normal, ray.dir) <= 0) continue;
        // albedo / pi * cos / density
        ray.weight = 2 * (1 - cosine) * ni * (at.weight * at.diffuse_albedo);
        ray.from = static_cast<std::uint32_t>(i);
        ray.origin_m = at.point_m + at.offset_m * at.geometric_normal;
        ++ray_count;
    }
    return ray_count;
}

// One ray per vertex, by chance specular or diffuse; dividing by the chance keeps the mean right.
std::size_t TileTracer::Implementation::choose_next(const FrameView& frame, const PixelBox& tile, int depth) {
    const int bins = frame.bins;
    std::size_t ray_count = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const Vertex& at = current[i];
        const auto random = random_of(frame, tile, at, depth, 0);
        const float u0 = uniform01(random[0]), u1 = uniform01(random[1]), u2 = uniform01(random[2]);

        const float no = std::max(dot(at.normal, at.view_dir), 1e-4f);
        const float mean_f0 = at.specular ? mean(at.normal_reflectance, bins) : 0.0f;
        const float specular = at.specular ? mean_f0 + (1 - mean_f0) * schlick_weight(no) : 0.0f;
        const float diffuse = mean(at.diffuse_albedo, bins);
        if (!(specular + diffuse > 0)) continue;
        const float specular_chance = specular / (specular + diffuse);

        NextRay ray;
        ray.from = static_cast<std::uint32_t>(i);
        ray.origin_m = at.point_m + at.offset_m * at.geometric_normal;
        if (u0 < specular_chance) {
            Vec3f facet = at.normal;
            if (!at.mirror) {
                const Frame local(at.normal);
                facet = local.to_world(sample_visible_normal(at.alpha, local.to_local(at.view_dir), u1, u2));
            }
            ray.dir = normalized(reflect(at.view_dir, facet));
            const float ni = dot(at.normal, ray.dir);
            if (ni <= 0 || dot(at.geometric_normal, ray.dir) <= 0) continue;
            const float schlick = schlick_weight(dot(facet, at.view_dir));
            const float weight = (at.mirror ? 1.0f : ggx_sample_weight(at.alpha, no, ni)) / specular_chance;
            ray.weight = weight * (at.weight * fresnel(at.normal_reflectance, schlick));
            ray.sees_earth = true;
            // A lobe met through another lobe is at least as wide as that one.
            ray.alpha_least = at.alpha;
        } else {
            ray.dir = Frame(at.normal).to_world(sample_cosine(u1, u2));
            if (dot(at.geometric_normal, ray.dir) <= 0) continue;
            const float weight = 1 / (1 - specular_chance);
            ray.weight = weight * (at.weight * at.diffuse_albedo);
            ray.sees_earth = false;
            ray.alpha_least = kAlphaBehindDiffuse;
        }
        if (largest(ray.weight) < frame.contribution_threshold / frame.samples()) continue;
        next[ray_count++] = ray;
    }
    return ray_count;
}

// Traces the chosen rays; what they meet becomes the next wave's vertices, the rest sees the background.
void TileTracer::Implementation::follow(const FrameView& frame, std::size_t ray_count) {
    RayPacket rays;
    HitPacket hits;
    std::size_t found = 0;
    std::size_t first = 0;
    while (first < ray_count) {
        rays.count = static_cast<int>(std::min<std::size_t>(kPacketSize, ray_count - first));
        for (int i = 0; i < rays.count; ++i) {
            const NextRay& ray = next[first + static_cast<std::size_t>(i)];
            rays.set(i, ray.origin_m, ray.dir, 0, kInfinity);
        }
        frame.scene->intersect(rays, Coherence::kIncoherent, hits);
        stats.secondary_rays += static_cast<std::uint64_t>(rays.count);
        for (int i = 0; i < rays.count; ++i) {
            const NextRay& ray = next[first + static_cast<std::size_t>(i)];
            const Vertex& from = current[ray.from];
            if (!meets_object(frame, hits, i, ray.origin_m, ray.dir)) {
                if (ray.sees_earth)
                    add_background(frame, ray.origin_m, ray.dir, ray.alpha_least == 0, ray.weight,
                                   pixels[from.pixel]);
                continue;
            }
            Vertex& vertex = following[found];
            if (!make_vertex(frame, hits, i, ray.origin_m, ray.dir, ray.alpha_least, vertex)) continue;
            vertex.pixel = from.pixel;
            vertex.sample = from.sample;
            vertex.weight = ray.weight;
            ++found;
        }
        first += static_cast<std::size_t>(rays.count);
    }
    std::swap(current, following);
    count = found;
}

TileStats TileTracer::trace(const FrameView& frame, const PixelBox& tile, RadianceImage& radiance) {
    Implementation& my = *implementation_;
    my.stats = {};
    const int width = tile.x1 - tile.x0;
    const auto pixel_count = static_cast<std::size_t>(width * (tile.y1 - tile.y0));
    std::fill_n(my.pixels.begin(), pixel_count, Spectrum{});

    my.primary_rays(frame, tile, true);
    for (int depth = 1; my.count > 0; ++depth) {
        my.light_from_sun(frame);
        if (depth == frame.max_depth) break;
        my.light_from_earth(frame, my.choose_earth(frame, tile, depth));
        my.follow(frame, my.choose_next(frame, tile, depth));
    }
    for (int b = 0; b < frame.bins; ++b)
        for (int y = tile.y0; y < tile.y1; ++y) {
            float* out = radiance.row(y, b).data() + tile.x0;
            const Spectrum* in = my.pixels.data() + (y - tile.y0) * width;
            for (int x = 0; x < width; ++x) out[x] = in[x][b];
        }
    return my.stats;
}

void TileTracer::Implementation::light_from_sun_bare(const FrameView& frame) {
    const Vec3f sun = to_float(frame.background->sun_world_dir());
    RayPacket rays;
    rays.count = 0;
    const auto flush = [&] {
        if (rays.count > 0) frame.scene->occluded(rays);
        stats.shadow_rays += static_cast<std::uint64_t>(rays.count);
        rays.count = 0;
    };
    for (std::size_t i = 0; i < count; ++i) {
        if (current[i].mirror || dot(current[i].geometric_normal, sun) <= 0 ||
            dot(current[i].normal, sun) <= 0)
            continue;
        rays.set(rays.count, current[i].point_m + current[i].offset_m * current[i].geometric_normal, sun, 0,
                 kInfinity);
        if (++rays.count == kPacketSize) flush();
    }
    flush();
}

TileStats TileTracer::trace_bare(const FrameView& frame, const PixelBox& tile) {
    Implementation& my = *implementation_;
    my.stats = {};
    my.primary_rays(frame, tile, false);
    my.light_from_sun_bare(frame);
    return my.stats;
}

}  // namespace hilcam
