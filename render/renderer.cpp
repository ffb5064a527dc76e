#include "render/renderer.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <chrono>

#include "render/background.h"
#include "render/embree_scene.h"
#include "render/path_tracer.h"
#include "render/screen_bounds.h"
#include "render/screen_mask.h"
#include "render/star_field.h"
#include "render/triangle_order.h"

namespace hilcam {
namespace {

using Clock = std::chrono::steady_clock;

double ms_since(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

std::vector<const Mesh*> ordered_meshes(Scene& scene) {
    std::vector<const Mesh*> meshes;
    for (SceneObject& object : scene.objects) {
        order_triangles(object.mesh);
        meshes.push_back(&object.mesh);
    }
    return meshes;
}

std::vector<ObjectSurfaces> surfaces_of(Scene& scene) {
    std::vector<ObjectSurfaces> surfaces;
    for (SceneObject& object : scene.objects) surfaces.emplace_back(std::move(object));
    scene.objects.clear();
    return surfaces;
}

}  // namespace

Fields fields(RenderQuality& q) {
    return {
        integer("samples_per_axis", q.samples_per_axis, {1, 16}, "n: each pixel is an n x n grid of rays"),
        integer("max_depth", q.max_depth, {1, 64},
                "surfaces that a light path may meet; 1: direct sunlight only"),
        number("contribution_threshold", q.contribution_threshold, 1, {0, 1},
               "a path whose largest weight falls below this is not followed"),
    };
}

struct Renderer::Implementation {
    std::size_t triangle_count;
    EmbreeScene embree;
    std::vector<ObjectSurfaces> objects;
    std::vector<Star> stars;
    Earth earth;
    ColorBands bands;
    Background background;
    ScreenMask object_mask;
    FrameView frame;
    int tile_px;
    int tiles_across;
    int tiles_down;
    std::vector<TileTracer> tracers;  // one per slot of the thread pool
    std::vector<TileStats> tile_stats;

    Implementation(Scene scene, const SpectralGrid& grid, const ImageGeometry& geometry,
                   const RenderQuality& quality)
        : triangle_count(0),
          embree(ordered_meshes(scene)),
          objects(surfaces_of(scene)),
          stars(std::move(scene.stars)),
          earth(std::move(scene.earth)),
          bands(grid),
          background(earth, scene.sun_irradiance_1au_w_m2_um, grid),
          object_mask(geometry),
          tile_px(tile_edge_px(static_cast<int>(quality.samples_per_axis))),
          tiles_across((geometry.padded_width() + tile_px - 1) / tile_px),
          tiles_down((geometry.padded_height() + tile_px - 1) / tile_px),
          tile_stats(static_cast<std::size_t>(tiles_across * tiles_down)) {
        for (const ObjectSurfaces& object : objects) triangle_count += object.triangles.size();
        tracers.resize(static_cast<std::size_t>(tbb::this_task_arena::max_concurrency()));
        frame.scene = &embree;
        frame.objects = &objects;
        frame.world_from_body.resize(objects.size());
        frame.object_mask = &object_mask;
        frame.background = &background;
        frame.bands = &bands;
        frame.geometry = geometry;
        frame.bins = grid.size();
        frame.samples_per_axis = static_cast<int>(quality.samples_per_axis);
        frame.max_depth = static_cast<int>(quality.max_depth);
        frame.contribution_threshold = static_cast<float>(quality.contribution_threshold);
    }

    // To the farthest point of any object.
    double farthest_m(const WorldSnapshot& world) const {
        double farthest_m = 0;
        for (std::size_t i = 0; i < objects.size(); ++i) {
            const double distance_m =
                length(world.objects[i].position_world_m - world.camera.position_world_m);
            farthest_m = std::max(farthest_m, distance_m + objects[i].radius_m);
        }
        return farthest_m;
    }

    void place(const WorldSnapshot& world, RandomKey key) {
        HILCAM_CHECK(world.objects.size() == objects.size());
        background.place(world);
        embree.place(world.objects, world.camera.position_world_m);
        frame.key = key;
        frame.world_from_camera = to_matrix(world.camera.world_from_body);
        const auto direction = [&](double x, double y) {
            return frame.world_from_camera * frame.geometry.direction_camera(x, y);
        };
        const double corner = -frame.geometry.guard_px;
        frame.corner_world_dir = direction(corner, corner);
        frame.right_world_dir = direction(corner + 1, corner) - frame.corner_world_dir;
        frame.down_world_dir = direction(corner, corner + 1) - frame.corner_world_dir;
        object_mask.clear();
        for (std::size_t i = 0; i < objects.size(); ++i) {
            const Mat3d m = to_matrix(world.objects[i].world_from_body);
            frame.world_from_body[i] = {to_float(m.x), to_float(m.y), to_float(m.z)};
            object_mask.add(world.camera, world.objects[i], objects[i].cluster_bounds_m);
        }
        frame.earth_box = background.earth_visible() ? screen_bounds_of_cone(frame.geometry, world.camera,
                                                                             background.earth_world_dir(),
                                                                             background.earth_cone_cosine())
                                                     : PixelBox{};
        frame.earth_may_hide = background.earth_visible() && farthest_m(world) > background.earth_nearest_m();
        frame.sun_box = screen_bounds_of_cone(frame.geometry, world.camera, background.sun_world_dir(),
                                              background.sun_disk_cosine());
    }

    PixelBox tile(int index) const {
        const int x = index % tiles_across * tile_px;
        const int y = index / tiles_across * tile_px;
        return {x, y, std::min(x + tile_px, frame.geometry.padded_width()),
                std::min(y + tile_px, frame.geometry.padded_height())};
    }
    bool can_see_anything(const PixelBox& box) const {
        return object_mask.any(box) || box.overlaps(frame.earth_box) || box.overlaps(frame.sun_box);
    }

    // Runs work(tile index, tile, tracer) over all tiles on the thread pool.
    template <class Work>
    void for_each_tile(const Work& work) {
        tbb::parallel_for(
            tbb::blocked_range<int>(0, tiles_across * tiles_down), [&](const tbb::blocked_range<int>& range) {
                TileTracer& tracer =
                    tracers[static_cast<std::size_t>(tbb::this_task_arena::current_thread_index())];
                for (int i = range.begin(); i < range.end(); ++i) work(i, tile(i), tracer);
            });
    }

    TileStats total() const {
        TileStats sum;
        for (const TileStats& stats : tile_stats) sum += stats;
        return sum;
    }
};

namespace {
void fill_zero(RadianceImage& radiance, const PixelBox& box) {
    for (int p = 0; p < radiance.planes(); ++p)
        for (int y = box.y0; y < box.y1; ++y)
            std::fill(radiance.row(y, p).begin() + box.x0, radiance.row(y, p).begin() + box.x1, 0.0f);
}
}  // namespace

Renderer::Renderer(Scene scene, const SpectralGrid& grid, const ImageGeometry& geometry,
                   const RenderQuality& quality)
    : implementation_(std::make_unique<Implementation>(std::move(scene), grid, geometry, quality)) {}
Renderer::~Renderer() = default;

std::size_t Renderer::most_points() const { return implementation_->stars.size(); }
std::size_t Renderer::triangles() const { return implementation_->triangle_count; }
const ImageGeometry& Renderer::geometry() const { return implementation_->frame.geometry; }

void Renderer::render(const WorldSnapshot& world, RandomKey key, RadianceImage& radiance,
                      std::vector<PointSource>& points, RenderStats& stats) {
    Implementation& my = *implementation_;
    HILCAM_CHECK(radiance.width() == my.frame.geometry.padded_width() &&
                 radiance.height() == my.frame.geometry.padded_height() &&
                 radiance.planes() == my.frame.bins);
    const auto start = Clock::now();
    my.place(world, key);
    stats.setup_ms = ms_since(start);

    const auto traced = Clock::now();
    my.for_each_tile([&](int index, const PixelBox& tile, TileTracer& tracer) {
        TileStats& tile_stats = my.tile_stats[static_cast<std::size_t>(index)];
        const bool anything = my.can_see_anything(tile);
        const bool was_dark = radiance.dark(tile.x0, tile.y0);
        // Tiles smaller than the image's blocks share a mark: it stays off.
        if (my.tile_px == RadianceImage::kBlock_px) radiance.mark_dark(tile.x0, tile.y0, !anything);
        tile_stats = {};
        if (anything)
            tile_stats = tracer.trace(my.frame, tile, radiance);
        else if (!was_dark)
            fill_zero(radiance, tile);
    });
    stats.trace_ms = ms_since(traced);

    const auto starred = Clock::now();
    points.clear();
    add_stars(my.stars, my.frame, points);
    stats.points_ms = ms_since(starred);

    const TileStats sum = my.total();
    const int n = my.frame.samples_per_axis;
    stats.primary_rays = sum.primary_rays;
    stats.shadow_rays = sum.shadow_rays;
    stats.secondary_rays = sum.secondary_rays;
    stats.coverage =
        static_cast<double>(sum.object_hits) /
        (static_cast<double>(my.frame.geometry.padded_width()) * my.frame.geometry.padded_height() * n * n);
}

double Renderer::floor_ms(const WorldSnapshot& world) {
    Implementation& my = *implementation_;
    my.place(world, {});
    const auto start = Clock::now();
    my.for_each_tile([&](int, const PixelBox& tile, TileTracer& tracer) {
        if (my.object_mask.any(tile)) tracer.trace_bare(my.frame, tile);
    });
    return ms_since(start);
}

}  // namespace hilcam
