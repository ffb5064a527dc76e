#include "render/renderer.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <chrono>

#include "render/background.h"
#include "render/embree_scene.h"
#include "render/object_probe.h"
#include "render/point_field.h"
#include "render/primary_rays.h"
#include "render/screen_bounds.h"
#include "render/screen_mask.h"
#include "render/shown_object.h"
#include "render/shown_terrain.h"

namespace hilcam {
namespace {

using Clock = std::chrono::steady_clock;

double ms_since(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

bool any_material(const std::vector<ShownObject>& objects, const auto& says) {
    return std::any_of(objects.begin(), objects.end(), [&](const ShownObject& object) {
        return std::any_of(object.materials().begin(), object.materials().end(), says);
    });
}

void fill_zero(RadianceImage& radiance, const PixelBox& box) {
    for (int p = 0; p < radiance.planes(); ++p)
        for (int y = box.y0; y < box.y1; ++y)
            std::fill(radiance.row(y, p).begin() + box.x0, radiance.row(y, p).begin() + box.x1, 0.0f);
}

}  // namespace

Fields fields(RenderQuality& q) {
    return {
        integer("samples_per_axis", q.samples_per_axis, {1, 16}, "n: each pixel is an n x n grid of rays"),
        text("path_model", q.path_model, "direct | hemisphere | path, or a plug-in's"),
        integer("max_depth", q.max_depth, {1, 64},
                "surfaces that a light path may meet; 1: direct sunlight only"),
        number(
            "contribution_threshold", q.contribution_threshold, 1, {0, 1},
            "a path whose largest weight falls below this ends (hemisphere), or lives on by chance (path)"),
        flag("sun_disk", q.sun_disk, "sunlight from the whole disk: soft shadows, exact highlights"),
        number("facets_behind_diffuse", q.facets_behind_diffuse, 1, {0, 1},
               "path: least GGX alpha of surfaces seen by way of a diffuse one, against sparkle; 0: as they "
               "are"),
        flag("watertight", q.watertight,
             "no ray slips through the edge that two triangles share; costs a sixth"),
        number("lod_error_px", q.lod_error_px, 1, {0, 16},
               "a mesh may be this far off, in pixels, where it is drawn from a coarser level; 0: never"),
        integer(
            "rays_across", q.rays_across, {0, 4096},
            "an object of some pixels gets more rays per pixel, up to 16 x 16, until so many go across it"),
        integer("point_samples", q.point_samples, {16, 512},
                "an object of a few pixels or less is measured by a grid of so many rays in each direction"),
    };
}

struct Renderer::Implementation {
    std::size_t triangle_count;
    EmbreeScene embree;
    std::vector<ShownObject> objects;          // the last one is the terrain, if there is any
    std::vector<std::size_t> levels;           // of detail that each is shown at
    std::vector<const ObjectSurfaces*> shown;  // at that level
    std::vector<double> radii_m;
    double lod_error_px;
    std::vector<ObjectPlan> plans;
    std::vector<PixelBox> object_boxes;  // pixels that can meet an object
    std::vector<Star> stars;
    std::array<SceneBody, kBodyCount> bodies;
    std::unique_ptr<Atmosphere> air;
    ColorBands bands;
    Background background;
    ScreenMask object_mask, full_mask;
    std::unique_ptr<RayGenerator> rays;
    std::unique_ptr<RadianceModel> radiance_model;
    std::string path_model_name;
    FrameView frame;
    WorldSnapshot world;  // of the frame, with the terrain among its objects
    std::unique_ptr<ShownTerrain> terrain;
    std::unique_ptr<ObjectProbe> probe;  // for objects of a few pixels
    int samples_per_axis;
    int rays_across;
    int tile_px;
    int tiles_across;
    int tiles_down;
    // One per slot of the thread pool.
    std::vector<std::unique_ptr<PathModel>> tracers;
    std::vector<std::vector<Vertex>> bare_vertices;
    std::vector<std::vector<Spectrum>> tile_pixels;
    std::vector<TileStats> tile_stats;

    Implementation(Scene scene, const SpectralGrid& grid, const ImageGeometry& geometry,
                   const RenderQuality& quality, const RenderModels& models, const Modules& modules)
        : triangle_count(0),
          embree(ordered_meshes(with_terrain_object(scene)), quality.watertight),
          lod_error_px(quality.lod_error_px),
          stars(std::move(scene.stars)),
          bodies(std::move(scene.bodies)),
          air(std::move(scene.air)),
          bands(grid),
          background(bodies, air.get(), scene.sun_irradiance_1au_w_m2_um, scene.limb_darkening, grid),
          object_mask(geometry),
          full_mask(geometry),
          rays(modules.rays.make(models.rays.model, models.rays)),
          radiance_model(modules.radiance.make(models.radiance)),
          path_model_name(quality.path_model),
          samples_per_axis(static_cast<int>(quality.samples_per_axis)),
          rays_across(static_cast<int>(quality.rays_across)),
          tile_px(tile_edge_px(samples_per_axis)),
          tiles_across((geometry.padded_width() + tile_px - 1) / tile_px),
          tiles_down((geometry.padded_height() + tile_px - 1) / tile_px),
          tile_stats(static_cast<std::size_t>(tiles_across * tiles_down)) {
        objects = shown_objects(scene);
        if (scene.terrain)
            terrain = std::make_unique<ShownTerrain>(embree, std::move(scene.terrain), objects.size() - 1);
        world.objects.reserve(objects.size());
        levels.resize(objects.size());
        plans.resize(objects.size());
        object_boxes.resize(objects.size());
        for (const ShownObject& object : objects) {
            triangle_count += object.levels.front().triangles.size();
            radii_m.push_back(object.radius_m());
            shown.push_back(&object.levels.front());
        }
        full_mask.fill();
        const auto slots = static_cast<std::size_t>(tbb::this_task_arena::max_concurrency());
        for (std::size_t i = 0; i < slots; ++i) tracers.push_back(modules.paths.make(quality.path_model));
        tile_pixels.resize(slots, std::vector<Spectrum>(PathModel::kMostSamples));
        bare_vertices.resize(slots);

        frame.scene = &embree;
        frame.objects = &shown;
        frame.world_from_body.resize(objects.size());
        frame.is_point.resize(objects.size());
        frame.background = &background;
        frame.radiance = radiance_model.get();
        frame.bands = &bands;
        frame.rays = rays.get();
        frame.geometry = geometry;
        frame.bins = grid.size();
        frame.max_depth = static_cast<int>(quality.max_depth);
        frame.contribution_threshold = static_cast<float>(quality.contribution_threshold);
        frame.sun_is_disk = quality.sun_disk;
        frame.alpha_behind_diffuse = static_cast<float>(quality.facets_behind_diffuse);
        frame.paths_sample_lobes = tracers.front()->samples_lobes();
        frame.has_glass =
            any_material(objects, [](const Material& m) { return m.model == ReflectionModel::kGlass; });
        frame.has_emission = radiance_model->emits() &&
                             any_material(objects, [](const Material& m) { return largest(m.emission) > 0; });
        probe = std::make_unique<ObjectProbe>(frame, static_cast<int>(quality.point_samples));
    }

    // The coarsest level whose error stays below the quality's share of a pixel where the object is nearest.
    void choose_levels() {
        for (std::size_t i = 0; i < objects.size(); ++i) {
            const double nearest_m =
                length(world.objects[i].position_world_m - world.camera.position_world_m) - radii_m[i];
            const double error_m = lod_error_px * std::max(0.0, nearest_m) / frame.geometry.focal_length_px;
            std::size_t level = 0;
            while (level + 1 < objects[i].levels.size() && objects[i].error_m[level + 1] <= error_m) ++level;
            levels[i] = level;
            shown[i] = &objects[i].levels[level];
        }
    }

    // Of the sphere that holds it.
    PixelBox box_of(std::size_t i) const {
        const Vec3d to_object_m = world.objects[i].position_world_m - world.camera.position_world_m;
        const double sine = std::min(1.0, radii_m[i] / plans[i].distance_m);
        return screen_bounds_of_cone(frame.geometry, world.camera, to_object_m / plans[i].distance_m,
                                     std::sqrt(1 - sine * sine));
    }

    void place(const WorldSnapshot& given, RandomKey key) {
        HILCAM_CHECK(given.objects.size() + (terrain ? 1 : 0) == objects.size());
        world = given;
        if (terrain) {
            world.objects.push_back(terrain->update(world, frame.geometry.focal_length_px, objects.back()));
            radii_m.back() = objects.back().radius_m();
        }
        const RaySpace space = choose_ray_space(world, radii_m, rays->is_still());
        const double pixel_rad = 1 / frame.geometry.focal_length_px;
        background.place(world, space.origin_world_m, pixel_rad);
        frame.key = key;
        frame.rays_world_m = space.origin_world_m;
        frame.camera_m = world.camera.position_world_m - space.origin_world_m;
        frame.start_before_m = space.start_before_m;
        choose_levels();
        embree.place(world.objects, levels, space.origin_world_m);
        rays->place(frame.geometry,
                    {world.time, world.camera, world.camera_velocity_m_s, world.camera_rate_rad_s});

        // Rows with poses of their own meet objects anywhere: no mask, no boxes.
        const bool still = rays->is_still();
        object_mask.clear();
        double farthest_m = 0;
        for (std::size_t i = 0; i < objects.size(); ++i) {
            const Mat3d m = to_matrix(world.objects[i].world_from_body);
            frame.world_from_body[i] = {to_float(m.x), to_float(m.y), to_float(m.z)};
            const std::size_t level = levels[i];
            plans[i] = plan_object(frame.geometry, world, world.objects[i], radii_m[i],
                                   {samples_per_axis, rays_across});
            plans[i].level = level;
            frame.is_point[i] = plans[i].use == ObjectUse::kPoints;
            if (!frame.is_point[i] && still &&
                !object_mask.add(world.camera, world.objects[i], shown[i]->cluster_bounds_m))
                plans[i].use = ObjectUse::kHidden;
            if (!frame.is_point[i] && plans[i].samples_per_axis > samples_per_axis)
                object_boxes[i] = box_of(i);
            farthest_m = std::max(farthest_m, plans[i].distance_m + radii_m[i]);
        }
        frame.object_mask = still ? &object_mask : &full_mask;
        const PixelBox everything{0, 0, frame.geometry.padded_width(), frame.geometry.padded_height()};
        frame.body_box_count = background.disks().size();
        for (std::size_t i = 0; i < frame.body_box_count; ++i) {
            const PlacedBody& body = background.disks()[i];
            frame.body_boxes[i] =
                still ? screen_bounds_of_cone(frame.geometry, world.camera, body.world_dir, body.cone_cosine)
                      : everything;
        }
        frame.bodies_may_hide = farthest_m > background.nearest_m();
        frame.sun_box = still
                            ? screen_bounds_of_cone(frame.geometry, world.camera, background.sun_camera_dir(),
                                                    background.sun_disk_cosine())
                            : everything;
    }

    MovingFrame moving() const {
        return {frame,
                plans,
                radii_m,
                terrain ? terrain->body() : std::optional<BodyId>(),
                terrain != nullptr,
                !stars.empty() || !background.points().empty()};
    }

    PixelBox tile(int index) const {
        const int x = index % tiles_across * tile_px;
        const int y = index / tiles_across * tile_px;
        return {x, y, std::min(x + tile_px, frame.geometry.padded_width()),
                std::min(y + tile_px, frame.geometry.padded_height())};
    }
    bool can_see_anything(const PixelBox& box) const {
        return frame.object_mask->any(box) || frame.may_see_body(box) || box.overlaps(frame.sun_box);
    }

    // Runs work(tile index, tile, slot of the thread) over all tiles on the thread pool.
    template <class Work>
    void for_each_tile(const Work& work) {
        tbb::parallel_for(
            tbb::blocked_range<int>(0, tiles_across * tiles_down), [&](const tbb::blocked_range<int>& range) {
                const auto slot = static_cast<std::size_t>(tbb::this_task_arena::current_thread_index());
                for (int i = range.begin(); i < range.end(); ++i) work(i, tile(i), slot);
            });
    }

    // What the smallest thing in the box asks for.
    int samples_in(const PixelBox& box) const {
        int n = samples_per_axis;
        for (std::size_t i = 0; i < objects.size(); ++i)
            if (plans[i].use == ObjectUse::kMesh && plans[i].samples_per_axis > n &&
                box.overlaps(object_boxes[i]))
                n = plans[i].samples_per_axis;
        return n;
    }

    void trace_tile(const PixelBox& box, std::size_t slot, TileStats& stats, RadianceImage& radiance) {
        const int n = samples_in(box);
        const int edge = tile_edge_px(n);
        for (int y = box.y0; y < box.y1; y += edge)
            for (int x = box.x0; x < box.x1; x += edge)
                trace_part({x, y, std::min(x + edge, box.x1), std::min(y + edge, box.y1)}, n, slot, stats,
                           radiance);
    }

    void trace_part(const PixelBox& box, int n, std::size_t slot, TileStats& stats, RadianceImage& radiance) {
        const float share = 1 / static_cast<float>(n * n);
        const int width = box.x1 - box.x0;
        const std::span<Spectrum> pixels(tile_pixels[slot].data(),
                                         static_cast<std::size_t>(width * (box.y1 - box.y0)));
        std::fill(pixels.begin(), pixels.end(), Spectrum{});
        Tile tile{frame, box, n, pixels, stats};
        tracers[slot]->trace(tile);
        for (int b = 0; b < frame.bins; ++b)
            for (int y = box.y0; y < box.y1; ++y) {
                float* out = radiance.row(y, b).data() + box.x0;
                const Spectrum* in = pixels.data() + (y - box.y0) * width;
                for (int x = 0; x < width; ++x) out[x] = share * in[x][b];
            }
    }

    void trace_all(RadianceImage& radiance) {
        for_each_tile([&](int index, const PixelBox& tile, std::size_t slot) {
            TileStats& stats = tile_stats[static_cast<std::size_t>(index)];
            const bool anything = can_see_anything(tile);
            const bool was_dark = radiance.dark(tile.x0, tile.y0);
            // Tiles smaller than the image's blocks share a mark: it stays off.
            if (tile_px == RadianceImage::kBlock_px) radiance.mark_dark(tile.x0, tile.y0, !anything);
            stats = {};
            if (anything)
                trace_tile(tile, slot, stats, radiance);
            else if (!was_dark)
                fill_zero(radiance, tile);
        });
    }

    TileStats total() const {
        TileStats sum;
        for (const TileStats& stats : tile_stats) sum += stats;
        return sum;
    }
};

Renderer::Renderer(Scene scene, const SpectralGrid& grid, const ImageGeometry& geometry,
                   const RenderQuality& quality, const RenderModels& models, const Modules& modules)
    : implementation_(
          std::make_unique<Implementation>(std::move(scene), grid, geometry, quality, models, modules)) {}
Renderer::~Renderer() = default;

std::size_t Renderer::most_points() const {
    const std::size_t cells = ObjectProbe::kMostCells * ObjectProbe::kMostCells;
    return implementation_->stars.size() + implementation_->objects.size() * cells + kBodyCount;
}
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
    my.trace_all(radiance);
    stats.trace_ms = ms_since(traced);

    const auto pointed = Clock::now();
    points.clear();
    TileStats sum = my.total();
    const PointField field(my.frame, my.world);
    field.add_stars(my.stars, points);
    for (const PlacedBody& body : my.background.points())
        field.add(body.world_dir, body.distance_m, my.background.point_irradiance(body), points);
    for (std::size_t i = 0; i < my.objects.size(); ++i)
        if (my.frame.is_point[i])
            sum += my.probe->add_points(my.frame, my.world, i, my.plans[i], my.radii_m[i],
                                        *my.tracers.front(), field, points);
    stats.points_ms = ms_since(pointed);

    stats.primary_rays = sum.primary_rays;
    stats.shadow_rays = sum.shadow_rays;
    stats.secondary_rays = sum.secondary_rays;
    stats.coverage = sum.covered_px / (static_cast<double>(my.frame.geometry.padded_width()) *
                                       my.frame.geometry.padded_height());
}

ImageMotion Renderer::motion(const WorldSnapshot& middle, const WorldSnapshot& before,
                             const WorldSnapshot& after) {
    implementation_->place(middle, {});
    return motion_of_last(before, after);
}

ImageMotion Renderer::motion_of_last(const WorldSnapshot& before, const WorldSnapshot& after) {
    const Implementation& my = *implementation_;
    return image_motion(my.moving(), {my.world, before, after});
}

void Renderer::set_drifts(const WorldSnapshot& before, const WorldSnapshot& after, double per_s,
                          std::span<PointSource> points) {
    const Implementation& my = *implementation_;
    hilcam::set_drifts(my.moving(), {my.world, before, after}, per_s, points);
}

bool Renderer::last_shows_body() const {
    const Implementation& my = *implementation_;
    const PixelBox everything{0, 0, my.frame.geometry.padded_width(), my.frame.geometry.padded_height()};
    return (my.terrain && my.terrain->body()) || my.frame.may_see_body(everything);
}

std::vector<std::string> Renderer::explain_plan(const WorldSnapshot& world) {
    Implementation& my = *implementation_;
    my.place(world, {});
    std::vector<std::size_t> triangles;
    std::vector<std::string> names;
    for (const ShownObject& object : my.objects) names.push_back(object.name);
    for (const ObjectSurfaces* surfaces : my.shown) triangles.push_back(surfaces->triangles.size());
    return explain(
        {my.frame, my.plans, names, triangles, my.path_model_name, my.stars.size(), my.samples_per_axis},
        my.world);
}

std::vector<PathModelSpeed> Renderer::path_model_speeds(const WorldSnapshot& world, const Modules& modules,
                                                        int runs) {
    Implementation& my = *implementation_;
    RadianceImage radiance(my.frame.geometry.padded_width(), my.frame.geometry.padded_height(),
                           my.frame.bins);
    const auto median = [](std::vector<double> values) {
        std::sort(values.begin(), values.end());
        return values[values.size() / 2];
    };
    std::vector<PathModelSpeed> speeds;
    std::vector<std::unique_ptr<PathModel>> used = std::move(my.tracers);
    const bool samples_lobes = my.frame.paths_sample_lobes;
    for (const std::string& name : modules.paths.list()) {
        my.tracers.clear();
        for (std::size_t i = 0; i < used.size(); ++i) my.tracers.push_back(modules.paths.make(name));
        my.frame.paths_sample_lobes = my.tracers.front()->samples_lobes();
        my.place(world, {});
        std::vector<double> frame_ms;
        // The first round is for the caches, the last one is recorded.
        for (int run = 0; run < runs + 2; ++run) {
            if (run == runs + 1) my.embree.start_recording();
            const auto start = Clock::now();
            my.trace_all(radiance);
            if (run > 0 && run <= runs) frame_ms.push_back(ms_since(start));
        }
        const EmbreeScene::Replay replay = my.embree.replay();
        speeds.push_back({name, replay.rays, median(frame_ms), replay.milliseconds});
    }
    my.tracers = std::move(used);
    my.frame.paths_sample_lobes = samples_lobes;
    return speeds;
}

void Renderer::require_air(const WorldSnapshot& world) {
    Implementation& my = *implementation_;
    if (!my.air) return;
    my.place(world, {});
    const ImageGeometry& g = my.frame.geometry;
    const Mat3d world_from_camera = to_matrix(world.camera.world_from_body);
    constexpr int kSteps = 48;
    for (int y = 0; y <= kSteps; ++y)
        for (int x = 0; x <= kSteps; ++x) {
            const Vec3d dir = world_from_camera *
                              normalized(g.direction_camera(x * g.width_px / static_cast<double>(kSteps),
                                                            y * g.height_px / static_cast<double>(kSteps)));
            const std::string missing = my.background.air_missing(dir);
            if (!missing.empty()) throw InputError("atmosphere: the camera sees a " + missing);
        }
}

std::uint64_t Renderer::rays_outside_air() const {
    return implementation_->air ? implementation_->air->rays_outside() : 0;
}

double Renderer::floor_ms(const WorldSnapshot& world) {
    Implementation& my = *implementation_;
    my.place(world, {});
    for (std::vector<Vertex>& vertices : my.bare_vertices) vertices.resize(PathModel::kMostSamples);
    const auto start = Clock::now();
    my.for_each_tile([&](int, const PixelBox& box, std::size_t slot) {
        if (!my.frame.object_mask->any(box)) return;
        TileStats stats;
        Tile tile{my.frame, box, my.samples_per_axis, my.tile_pixels[slot], stats};
        trace_bare_rays(tile, my.bare_vertices[slot]);
    });
    return ms_since(start);
}

}  // namespace hilcam
