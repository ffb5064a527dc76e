#include "emulator/loop/exposure_renderer.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "emulator/scenario/quality_ladder.h"
#include "render/vocabulary/random.h"
#include "sensor/optics.h"

namespace hilcam {
namespace {

constexpr double kStill_px = 1e-3;  // over the exposure

// Runs work(row, plane) over all rows of an image on the thread pool.
template <class Work>
void for_each_row(const RadianceImage& image, const Work& work) {
    const int height = image.height();
    tbb::parallel_for(tbb::blocked_range<int>(0, height * image.planes(), 32),
                      [&](const tbb::blocked_range<int>& range) {
                          for (int i = range.begin(); i < range.end(); ++i) work(i % height, i / height);
                      });
}

void add(const RadianceImage& part, RadianceImage& sum) {
    for (int y = 0; y < sum.height(); y += RadianceImage::kBlock_px)
        for (int x = 0; x < sum.width(); x += RadianceImage::kBlock_px)
            if (!part.dark(x, y)) sum.mark_dark(x, y, false);
    for_each_row(sum, [&](int y, int plane) {
        const std::span<const float> in = part.row(y, plane);
        const std::span<float> out = sum.row(y, plane);
        for (std::size_t x = 0; x < in.size(); ++x) out[x] += in[x];
    });
}

void scale(float factor, RadianceImage& image) {
    for_each_row(image, [&](int y, int plane) {
        for (float& value : image.row(y, plane)) value *= factor;
    });
}

void accumulate(const RenderStats& part, float share, RenderStats& sum) {
    sum += part;
    sum.coverage += static_cast<double>(share) * part.coverage;
    sum.setup_ms += part.setup_ms;
    sum.trace_ms += part.trace_ms;
    sum.points_ms += part.points_ms;
}

// Rows of a rolling or scanning camera are exposed one after the other, while the world moves less.
void slow_down(double moving, WorldSnapshot& world) {
    world.rows_velocity_m_s = moving * world.rows_velocity_m_s;
    world.camera_rate_rad_s = moving * world.camera_rate_rad_s;
}

// Returns the mean rate between two attitudes, about the camera's axes.
Vec3d mean_rate(Quat from, Quat to, double seconds) {
    const Quat turn = conjugate(from) * to;
    const Vec3d axis{turn.x, turn.y, turn.z};
    const double sine = length(axis);
    if (!(sine > 0)) return {};
    // Takes the shorter way round.
    const double angle_rad = 2 * std::atan2(turn.w < 0 ? -sine : sine, std::abs(turn.w));
    return (angle_rad / (sine * seconds)) * axis;
}

}  // namespace

ExposureRenderer::ExposureRenderer(Renderer& renderer, const ExposureConfig& config,
                                   const CameraModel& camera, const SpectralGrid& grid,
                                   std::size_t placed_objects)
    : renderer_(renderer),
      motion_(config.motion),
      motion_error_px_(config.motion_error_px),
      shutter_(camera.shutter),
      rows_pass_object_(!config.has_terrain && (camera.shutter.kind == ShutterKind::kRolling ||
                                                camera.shutter.kind == ShutterKind::kLineScan)),
      looks_beside_(camera.outside_light.has_value()),
      focal_length_px_(camera.focal_length_m / camera.pitch_m),
      oversampling_(static_cast<double>(config.sampling.oversampling)),
      jitter_(camera.jitter, config.seed, config.start),
      responses_(channel_responses(camera, grid)),
      for_detector_(config.for_detector),
      has_moments_(is_halved(config.sampling.samples_per_axis)),
      bins_(static_cast<std::size_t>(grid.size())) {
    if (motion_ == MotionQuality::kExact && shutter_.kind == ShutterKind::kLineScan)
        motion_ = MotionQuality::kFast;
    for (WorldSnapshot* world : {&middle_, &before_, &after_, &part_world_})
        world->objects.resize(placed_objects);
    if (motion_ != MotionQuality::kExact) return;
    part_ = make_part();
    part_points_.reserve(renderer.max_points());
}

RadianceImage ExposureRenderer::make_image() const {
    RadianceImage image = make_part();
    if (has_moments_) image.keep_moments(responses_);
    return image;
}

// The sum of several parts has no moments, because its blur is wider than a pixel.
RadianceImage ExposureRenderer::make_part() const {
    const ImageGeometry& g = renderer_.geometry();
    if (for_detector_) return {g.padded_width(), g.padded_height(), responses_};
    return {g.padded_width(), g.padded_height(), static_cast<int>(bins_)};
}

std::size_t ExposureRenderer::max_points() const {
    return renderer_.max_points() * (motion_ == MotionQuality::kExact ? kMaxParts : 1);
}

// Uses the pointing jitter of mid-exposure for the whole exposure; faster jitter is blur.
void ExposureRenderer::sample_again(const WorldState& world, const Span& span, TimeTai time, bool with_bodies,
                                    WorldSnapshot& out) const {
    if (!with_bodies) out.bodies = middle_.bodies;
    world.sample_again(time, with_bodies, out);
    out.camera = jitter_.applied(out.camera, span.middle, span.exposure_s);
    out.rows_velocity_m_s = out.camera_velocity_m_s - seen_velocity_m_s(world, out);
    slow_down(span.moving, out);
}

// Rows that are exposed one after the other move relative to the nearest object, or to the ground, which is
// at rest in the world. Two objects that fly together hardly move, however fast both are.
Vec3d ExposureRenderer::seen_velocity_m_s(const WorldState& world, const WorldSnapshot& now) const {
    return rows_pass_object_ ? world.nearest_velocity_m_s(now) : Vec3d{};
}

void ExposureRenderer::sample_ends(const WorldState& world, const Span& span, bool with_bodies) {
    const std::int64_t half_ns = span.length_ns / 2;
    sample_again(world, span, span.middle + -half_ns, with_bodies, before_);
    sample_again(world, span, span.middle + half_ns, with_bodies, after_);
}

ExposureRenderer::Plan ExposureRenderer::plan_of(const ImageMotion& motion) const {
    Plan plan;
    plan.picture_px = std::hypot(motion.displacement_px.x, motion.displacement_px.y) / oversampling_;
    plan.largest_px = motion.largest_px / oversampling_;
    const double asked = std::ceil(plan.largest_px / motion_error_px_);
    plan.parts = static_cast<int>(std::clamp(asked, 1.0, static_cast<double>(kMaxParts)));
    plan.parts_limited = asked > kMaxParts;
    return plan;
}

void ExposureRenderer::sample_middle(WorldState& world, const Span& span, ShownCommand& shown) {
    const std::int64_t half_ns = span.length_ns / 2;
    world.sample(span.middle, middle_, shown);
    world.average_lamps(span.middle + -half_ns, span.middle + half_ns, middle_);
    middle_.camera = jitter_.applied(middle_.camera, span.middle, span.exposure_s);
    middle_.rows_velocity_m_s = middle_.camera_velocity_m_s - seen_velocity_m_s(world, middle_);
    slow_down(span.moving, middle_);
    reported_moving_ = span.moving;
}

// Velocity and rate are per second of the camera's time.
void ExposureRenderer::report_truth(FrameTruth& truth) {
    renderer_.report_truth(truth);
    truth.camera_velocity_m_s = reported_moving_ * truth.camera_velocity_m_s;
}

void ExposureRenderer::keep_dark(RadianceImage& radiance, std::vector<PointSource>& points,
                                 Exposure& exposure) const {
    for_each_row(radiance, [&](int y, int plane) {
        const std::span<float> row = radiance.row(y, plane);
        std::fill(row.begin(), row.end(), 0.0f);
    });
    for (int y = 0; y < radiance.height(); y += RadianceImage::kBlock_px)
        for (int x = 0; x < radiance.width(); x += RadianceImage::kBlock_px) radiance.mark_dark(x, y, true);
    if (radiance.moments()) radiance.moments()->set_used(false);
    points.clear();
    exposure.image_rate_px_s = {};
    exposure.camera_rate_rad_s = {};
    exposure.ray_grid = ray_grid_of(renderer_.quality());
}

ExposureRenderer::Plan ExposureRenderer::plan(WorldState& world, TimeTai middle, double exposure_s) {
    const Span span{middle, to_ns(exposure_s), exposure_s};
    ShownCommand ignored;
    sample_middle(world, span, ignored);
    sample_ends(world, span, true);
    return plan_of(renderer_.motion(middle_, before_, after_));
}

ExposureRenderer::Result ExposureRenderer::render(WorldState& world, const ShownWorld& shown, RandomKey key,
                                                  RadianceImage& radiance, std::vector<PointSource>& points,
                                                  Exposure& exposure, FrameTruth* truth) {
    const Span span{shown.middle, to_ns(shown.moving * exposure.exposure_s), exposure.exposure_s,
                    shown.moving};
    Result result;
    sample_middle(world, span, result.shown);
    exposure.image_rate_px_s = {};
    exposure.camera_rate_rad_s = {};
    exposure.ray_grid = ray_grid_of(renderer_.quality());
    if (motion_ == MotionQuality::kExact) {
        sample_ends(world, span, true);
        // Computes the motion while the renderer is placed at the middle, which it will not be for the parts.
        const ImageMotion motion = renderer_.motion(middle_, before_, after_);
        if (truth) report_truth(*truth);
        const Plan plan = plan_of(motion);
        result.parts = plan.parts;
        result.parts_limited = plan.parts_limited;
        set_rates(motion, result.parts, exposure);
        if (result.parts > 1) {
            render_parts(world, span, key, radiance, points, result);
            return result;
        }
    }
    renderer_.render(middle_, key, radiance, points, result.stats);
    if (radiance.moments() && radiance.moments()->used())
        exposure.ray_grid = halved(ray_grid_of(renderer_.quality()));
    if (truth && motion_ != MotionQuality::kExact) report_truth(*truth);
    if (motion_ == MotionQuality::kOff) return result;
    if (motion_ == MotionQuality::kFast) {
        sample_ends(world, span, renderer_.last_shows_body());
        set_rates(renderer_.motion_of_last(before_, after_), 1, exposure);
    }
    renderer_.set_drifts(before_, after_, 1 / exposure.exposure_s, points);
    return result;
}

void ExposureRenderer::look_beside(std::vector<SideLight>& lights) const {
    lights.clear();
    if (looks_beside_) renderer_.find_side_light(lights);
}

void ExposureRenderer::render_parts(const WorldState& world, const Span& span, RandomKey key,
                                    RadianceImage& radiance, std::vector<PointSource>& points,
                                    Result& result) {
    const int n = result.parts;
    const float share = 1 / static_cast<float>(n);
    // A point's own motion in one part, as a rate over the whole exposure.
    const double per_s = 1 / span.exposure_s;
    points.clear();
    for (int k = 0; k < n; ++k) {
        const auto edge_ns = [&](int i) { return span.length_ns * i / n - span.length_ns / 2; };
        const TimeTai begin = span.middle + edge_ns(k), end = span.middle + edge_ns(k + 1);
        sample_again(world, span, begin, true, before_);
        sample_again(world, span, end, true, after_);
        sample_again(world, span, begin + (end - begin) / 2, true, part_world_);
        world.average_lamps(begin, end, part_world_);
        RenderStats stats;
        // Each part draws its own samples.
        const RandomKey part_key{seed_of_nth(key.seed, static_cast<std::uint64_t>(k)), key.frame};
        renderer_.render(part_world_, part_key, k == 0 ? radiance : part_, part_points_, stats);
        renderer_.set_drifts(before_, after_, per_s, part_points_);
        if (k > 0) add(part_, radiance);
        for (const PointSource& point : part_points_) {
            points.push_back(point);
            points.back().irradiance_w_m2_um = share * point.irradiance_w_m2_um;
        }
        accumulate(stats, share, result.stats);
    }
    scale(share, radiance);
    if (radiance.moments()) radiance.moments()->set_used(false);
}

// Returns the motion of the picture along its columns beyond what the sensor expects, which is one pixel for
// each line time. With several stages, the charge follows at that rate, and only the difference blurs. A
// single stage is blurred by that pixel, which MTF_sys contains (system_mtf.h), and here by anything more.
double ExposureRenderer::unexpected_px_s(double rate_px_s) const {
    if (shutter_.kind != ShutterKind::kLineScan) return rate_px_s;
    const double expected_px_s = 1 / shutter_.line_time_s;
    const double more_px_s = std::abs(rate_px_s) - expected_px_s;
    return std::copysign(1.0, rate_px_s) * (shutter_.tdi_stages > 1 ? more_px_s : std::max(0.0, more_px_s));
}

void ExposureRenderer::set_rates(const ImageMotion& motion, int parts, Exposure& exposure) const {
    const bool still = motion.largest_px / oversampling_ < kStill_px;
    if (still && shutter_.kind != ShutterKind::kLineScan) return;
    const double per_s = 1 / (exposure.exposure_s * oversampling_);
    const Vec2d rate_px_s{motion.displacement_px.x * per_s,
                          unexpected_px_s(motion.displacement_px.y * per_s)};
    Vec3d camera_rad_s =
        mean_rate(before_.camera.world_from_body, after_.camera.world_from_body, exposure.exposure_s);
    // A rotation about x moves the picture along y, by the focal length per radian.
    camera_rad_s.x = unexpected_px_s(camera_rad_s.x * focal_length_px_) / focal_length_px_;
    exposure.image_rate_px_s = {rate_px_s.x / parts, rate_px_s.y / parts};
    exposure.camera_rate_rad_s = camera_rad_s / static_cast<double>(parts);
}

}  // namespace hilcam
