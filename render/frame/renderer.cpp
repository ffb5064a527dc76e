#include "render/frame/renderer.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <limits>
#include <sstream>

#include "render/frame/body_points.h"
#include "render/frame/find_side_light.h"
#include "render/frame/finite_light.h"
#include "render/frame/frame_setup.h"
#include "render/frame/frame_tracer.h"
#include "render/frame/points_part.h"
#include "render/frame/render_bench.h"
#include "render/frame/truth_probe.h"
#include "render/frame/unresolved_objects.h"
#include "render/shading/point_field.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/stopwatch.h"

namespace hilcam {
namespace {

std::vector<RenderQuality> all_levels(const RenderQuality& quality, std::span<const RenderQuality> lower) {
    std::vector<RenderQuality> levels = {quality};
    levels.insert(levels.end(), lower.begin(), lower.end());
    return levels;
}

}  // namespace

struct Renderer::Implementation {
    FrameSetup setup;
    FrameTracer tracer;
    PartsBuffer* parts = nullptr;              // for the parts of the light; null: not kept
    PixelRecord* record = nullptr;             // for recorded pixels; null: none
    UnresolvedObjects unresolved_objects;      // for objects of a few pixels
    std::atomic<std::uint64_t> not_finite{0};  // pixels and points of all frames whose light was not finite
    std::atomic<std::uint64_t> left_out{0};    // impossible positions and attitudes

    Implementation(Scene scene, const SpectralGrid& grid, const ImageGeometry& geometry,
                   const std::vector<RenderQuality>& levels, const RenderModels& models,
                   const Modules& modules)
        : setup(std::move(scene), grid, geometry, levels, models, modules),
          tracer(geometry, modules, levels),
          unresolved_objects(setup, static_cast<int>(levels.front().point_samples)) {
        use_level(0);
    }

    void use_level(std::size_t level) {
        tracer.use_level(level);
        setup.set_quality(tracer.quality(), tracer.paths(0));
    }

    // Adds stars, bodies, lamps and objects that are drawn as points. Returns the costs of tracing.
    TileStats add_points(std::vector<PointSource>& points) {
        const PointField field(setup.frame(), setup.world());
        field.add_stars(setup.stars(), points);
        add_body_points(setup.frame(), field, points);
        add_lamps_seen(setup.frame(), field, points);
        TileStats stats = unresolved_objects.add_points(setup, tracer, field, points);
        stats.not_finite += std::erase_if(
            points, [](const PointSource& point) { return !is_finite(point.irradiance_w_m2_um); });
        return stats;
    }

    // Says how many stars the placed frame has and how long finding them takes (shortest of three runs);
    // empty without a catalogue.
    std::string stars_line() const {
        if (setup.stars().empty()) return {};
        std::vector<PointSource> points;
        points.reserve(setup.max_stars());
        double min_ms = std::numeric_limits<double>::infinity();
        for (int time = 0; time < 3; ++time) {
            points.clear();
            const Stopwatch watch;
            PointField(setup.frame(), setup.world()).add_stars(setup.stars(), points);
            min_ms = std::min(min_ms, watch.ms());
        }
        std::ostringstream line;
        line << "stars: " << points.size() << " in the picture, found in " << std::round(100 * min_ms) / 100
             << " ms; " << std::round(1e-5 * static_cast<double>(setup.stars().size() * sizeof(Star))) / 10
             << " MB";
        return line.str();
    }
};

Renderer::Renderer(Scene scene, const SpectralGrid& grid, const ImageGeometry& geometry,
                   const RenderQuality& quality, const RenderModels& models, const Modules& modules,
                   std::span<const RenderQuality> lower)
    : implementation_(std::make_unique<Implementation>(std::move(scene), grid, geometry,
                                                       all_levels(quality, lower), models, modules)) {}
Renderer::~Renderer() = default;

void Renderer::keep_parts(PartsBuffer* buffer, PixelRecord* record) {
    implementation_->parts = buffer, implementation_->record = record;
    implementation_->tracer.keep_parts(buffer, record);
}
PartsBuffer Renderer::make_parts_buffer(const RadianceImage& like, std::optional<LightPart> only) const {
    return {like, implementation_->tracer.slots(), only};
}
RecordedSurface Renderer::surface_of(const PixelRecord::Entry& entry) const {
    return recorded_surface(implementation_->setup, entry);
}

void Renderer::use_level(std::size_t level) { implementation_->use_level(level); }
void Renderer::give_tables(std::span<const std::shared_ptr<const TransferTable>> tables) {
    implementation_->setup.give_tables(tables);
}
bool Renderer::take_light() { return implementation_->setup.take_light(); }

void Renderer::stop_looking_ahead() { implementation_->setup.stop_looking_ahead(); }
const RenderQuality& Renderer::quality() const { return implementation_->tracer.quality(); }

std::size_t Renderer::max_points() const {
    const FrameSetup& setup = implementation_->setup;
    return setup.max_stars() + setup.objects() * UnresolvedObjects::max_points(setup) +
           kMaxBodies * kMaxBodyPoints + kMaxRingedPoints + setup.lamps().all().size();
}
std::size_t Renderer::triangles() const { return implementation_->setup.triangles(); }
double Renderer::object_radius_m(std::size_t object) const { return implementation_->setup.radius_m(object); }
const ImageGeometry& Renderer::geometry() const { return implementation_->setup.frame().geometry; }

void Renderer::render(const WorldSnapshot& world, RandomKey key, RadianceImage& radiance,
                      std::vector<PointSource>& points, RenderStats& stats) {
    Implementation& my = *implementation_;
    const ImageGeometry& g = geometry();
    HILCAM_CHECK(radiance.width() == g.padded_width() && radiance.height() == g.padded_height() &&
                 (!radiance.responses().empty() || radiance.planes() == my.setup.frame().bins));
    const Stopwatch set_up;
    my.setup.place(world, key);
    my.setup.place_visibility();
    stats.setup_ms = set_up.ms();

    const Stopwatch trace;
    TileStats sum = my.tracer.trace(my.setup, radiance);
    stats.trace_ms = trace.ms();

    const Stopwatch adding;
    points.clear();
    sum += my.add_points(points);
    if (my.parts && my.parts->parts.has(LightPart::kPoints))
        add_points_part(g, points, my.parts->parts, my.record);
    stats.points_ms = adding.ms();

    static_cast<RayCounts&>(stats) = sum;
    stats.coverage = sum.covered_px / (static_cast<double>(g.padded_width()) * g.padded_height());
    stats.not_finite = sum.not_finite;
    my.left_out.fetch_add(my.setup.left_out(), std::memory_order_relaxed);
    my.not_finite.fetch_add(sum.not_finite, std::memory_order_relaxed);
}

ImageMotion Renderer::motion(const WorldSnapshot& middle, const WorldSnapshot& before,
                             const WorldSnapshot& after) {
    implementation_->setup.place(middle, {});
    return motion_of_last(before, after);
}

ImageMotion Renderer::motion_of_last(const WorldSnapshot& before, const WorldSnapshot& after) {
    const FrameSetup& setup = implementation_->setup;
    return image_motion(setup.moving(), {setup.world(), before, after});
}

void Renderer::set_drifts(const WorldSnapshot& before, const WorldSnapshot& after, double per_s,
                          std::span<PointSource> points) {
    const FrameSetup& setup = implementation_->setup;
    hilcam::set_drifts(setup.moving(), {setup.world(), before, after}, per_s, points);
}

bool Renderer::last_shows_body() const { return implementation_->setup.shows_body(); }

void Renderer::place_for_truth(const WorldSnapshot& world) { implementation_->setup.place_shapes(world, {}); }

void Renderer::make_ground_ahead(const WorldSnapshot& world) {
    implementation_->setup.make_ground_ahead(world);
}

FrameTruth Renderer::make_truth(const TruthRequest& request, int width_px, int height_px) const {
    return hilcam::make_truth(implementation_->setup, request, width_px, height_px);
}

void Renderer::report_truth(FrameTruth& truth) const { TruthProbe(implementation_->setup, truth).report(); }

void Renderer::find_side_light(std::vector<SideLight>& lights) const {
    const FrameSetup& setup = implementation_->setup;
    hilcam::find_side_light(setup.frame(), setup.world(), lights);
}

std::vector<std::string> Renderer::explain_plan(const WorldSnapshot& world) {
    Implementation& my = *implementation_;
    my.setup.place(world, {});
    std::vector<std::string> lines = my.setup.explain(quality());
    if (const std::string stars = my.stars_line(); !stars.empty()) lines.push_back(stars);
    return lines;
}

void Renderer::require_air(const WorldSnapshot& world) {
    FrameSetup& setup = implementation_->setup;
    if (!setup.air()) return;
    setup.place(world, {});
    const ImageGeometry& g = geometry();
    const Mat3d world_from_camera = to_matrix(world.camera.world_from_body);
    constexpr int kSteps = 48;
    for (int y = 0; y <= kSteps; ++y)
        for (int x = 0; x <= kSteps; ++x) {
            const Vec3d dir = world_from_camera *
                              normalized(g.direction_camera(x * g.width_px / static_cast<double>(kSteps),
                                                            y * g.height_px / static_cast<double>(kSteps)));
            const std::string missing = setup.background().air_missing(dir);
            if (!missing.empty()) throw InputError("atmosphere: the camera sees a " + missing);
        }
}

double Renderer::share_traced() const { return implementation_->tracer.share_done(); }

std::uint64_t Renderer::rays_outside_air() const {
    const Atmosphere* air = implementation_->setup.air();
    return air ? air->rays_outside() : 0;
}

std::string Renderer::fault() const {
    const DetailStream* const detail = implementation_->setup.earth_detail();
    std::string fault = detail ? detail->fault() : std::string();
    if (const std::uint64_t count = implementation_->not_finite.load(std::memory_order_relaxed); count > 0)
        fault += (fault.empty() ? "" : "; ") + std::to_string(count) +
                 " pixels or points had light that was no number and were left dark";
    if (const std::uint64_t count = implementation_->left_out.load(std::memory_order_relaxed); count > 0)
        fault += (fault.empty() ? "" : "; ") + std::to_string(count) +
                 " times a place or an attitude could not be and was left out of a frame";
    return fault;
}

double Renderer::floor_ms(const WorldSnapshot& world) {
    Implementation& my = *implementation_;
    my.setup.place(world, {});
    my.setup.place_visibility();
    return bare_rays_ms(my.setup, my.tracer);
}

std::vector<PathModelSpeed> Renderer::path_model_speeds(const WorldSnapshot& world, const Modules& modules,
                                                        int runs) {
    Implementation& my = *implementation_;
    my.setup.place(world, {});
    my.setup.place_visibility();
    return hilcam::path_model_speeds(my.setup, my.tracer, modules, runs);
}

}  // namespace hilcam
