#include "emulator/tradeoff/picture_judge.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

#include "emulator/characterise/characterise_setup.h"
#include "emulator/progress/progress.h"
#include "emulator/progress/progress_line.h"
#include "emulator/tradeoff/structural_similarity.h"
#include "render/visibility/screen_bounds.h"
#include "render/vocabulary/stopwatch.h"

namespace hilcam {
namespace {

constexpr int kTargetMargin_px = 8;
// No measured frame uses these light paths (tradeoff.cpp counts from 0).
constexpr std::uint64_t kFirstReferenceFrame = std::uint64_t{1} << 32;

// Returns the gain of a frame by StillCamera.
double gain_db_of(const CameraModel& camera) {
    return camera.sequence.empty() ? camera.gain_db : camera.sequence[0].gain_db;
}

// A sum of pictures in double precision.
class PictureSum {
  public:
    explicit PictureSum(const ElectronImage& like) : width_(like.width()), height_(like.height()) {
        sum_.resize(like.pixels());
    }
    void add(const ElectronImage& picture) {
        for (std::size_t i = 0; i < sum_.size(); ++i) sum_[i] += static_cast<double>(picture.data()[i]);
        ++count_;
    }
    void add(const PictureSum& other) {
        for (std::size_t i = 0; i < sum_.size(); ++i) sum_[i] += other.sum_[i];
        count_ += other.count_;
    }
    ElectronImage mean() const {
        ElectronImage out(width_, height_);
        for (std::size_t i = 0; i < sum_.size(); ++i) out.data()[i] = static_cast<float>(sum_[i] / count_);
        return out;
    }

  private:
    int width_, height_;
    std::vector<double> sum_;
    int count_ = 0;
};

PixelBox join(const PixelBox& a, const PixelBox& b) {
    if (a.empty()) return b;
    if (b.empty()) return a;
    return {std::min(a.x0, b.x0), std::min(a.y0, b.y0), std::max(a.x1, b.x1), std::max(a.y1, b.y1)};
}

// Returns the first object and its parts on joints, which follow all objects (scene_loader.cpp).
std::vector<std::size_t> target_parts(const ScenarioConfig& s) {
    if (s.objects.empty()) return {};
    std::vector<std::size_t> parts = {0};
    for (std::size_t i = 0; i < s.objects.front().joints.size(); ++i) parts.push_back(s.objects.size() + i);
    return parts;
}

// Returns the box of a sphere, in pixels of the window.
PixelBox box_of(Vec3d middle_world_m, double radius_m, const Pose& camera, const ImageGeometry& geometry) {
    const Vec3d to_middle_m = middle_world_m - camera.position_world_m;
    const double distance_m = length(to_middle_m);
    if (distance_m <= radius_m) return {0, 0, geometry.width_px, geometry.height_px};
    const double sine = radius_m / distance_m;
    return screen_bounds_of_cone(geometry, camera, to_middle_m / distance_m, std::sqrt(1 - sine * sine));
}

SensorNoise noise_of(const CameraModel& camera) { return SensorNoise(camera, gain_db_of(camera)); }
double saturation_of(const CameraModel& camera) {
    return configured_saturation_e(camera, gain_db_of(camera));
}

constexpr double kLongReference_s = 1800;

// Writes tenths of a second for short times.
std::string wait_text(double seconds) {
    return seconds < 10 ? fmt::format("{:.2g} s", seconds) : duration_text(seconds);
}

}  // namespace

ReferencePicture render_reference(StillCamera& camera, const ScenarioConfig& s, const ReferenceLimits& limits,
                                  const std::function<void(const std::string&)>& log) {
    const Stopwatch watch;
    const SensorNoise noise = noise_of(s.camera);
    const auto seed = static_cast<std::uint64_t>(s.seed);
    ReferencePicture out;
    out.dark = camera.dark();
    PictureSum moments[] = {PictureSum(out.dark), PictureSum(out.dark)};
    Progress progress("reference");
    for (int goal = 4; goal <= limits.max_frames; goal *= 2) {
        for (; out.frames < goal; ++out.frames) {
            progress.now(fmt::format(
                "reference, frame {} of {}", out.frames + 1,
                goal == limits.max_frames ? fmt::format("{}", goal) : fmt::format("{} or more", goal)));
            camera.render({seed, kFirstReferenceFrame + static_cast<std::uint64_t>(out.frames)});
            ElectronImage picture = clone(camera.expose());
            saturate(picture, saturation_of(s.camera));
            moments[out.frames % 2].add(picture);
            if (out.frames > 0) continue;
            const double frame_s = watch.seconds();
            log(fmt::format("a frame of the reference takes {}: {} for 4, up to {} for {}",
                            wait_text(frame_s), wait_text(4 * frame_s),
                            wait_text(limits.max_frames * frame_s), limits.max_frames));
            // A wait of half an hour before the sweep is probably not intended.
            if (4 * frame_s > kLongReference_s)
                log("that is long: --set camera.window_px=[LEFT, TOP, WIDTH, HEIGHT] measures a part of the "
                    "picture, "
                    "--set objects.0.mesh=... a simpler one, --reference-set a cheaper reference");
        }
        out.standard_error = noise_error(moments[0].mean(), moments[1].mean(), out.dark, noise);
        out.standard_error.p99 *= 0.5, out.standard_error.rms *= 0.5;
        log(fmt::format(
            "reference of {} frames: standard error {:.4f} of the sensor's noise or less in 99 % of {} "
            "lit pixels, {:.4f} rms",
            out.frames, out.standard_error.p99, out.standard_error.lit_px, out.standard_error.rms));
        if (out.standard_error.p99 <= limits.standard_error_sigma) break;
    }
    moments[0].add(moments[1]);
    out.mean = moments[0].mean();
    out.seconds = watch.seconds();
    return out;
}

PictureJudge first_instant_judge(const ScenarioConfig& s, const ReferenceLimits& limits,
                                 const std::function<void(const std::string&)>& log) {
    StillCamera camera(s);
    ReferencePicture reference = render_reference(camera, s, limits, log);
    if (reference.standard_error.lit_px == 0)
        throw InputError(
            fmt::format("nothing in the picture is brighter than the sensor's noise in the dark, "
                        "{:.3g} e-: there is no error to measure; raise the exposure, or look at "
                        "something",
                        noise_of(s.camera).sigma_e(0, 0)));
    return {s, camera, std::move(reference)};
}

PictureJudge::PictureJudge(const ScenarioConfig& s, const StillCamera& camera, ReferencePicture reference)
    : noise_(noise_of(s.camera)),
      saturation_e_(saturation_of(s.camera)),
      offset_px_{static_cast<double>(s.camera.black_columns), static_cast<double>(s.camera.black_rows)},
      reference_(std::move(reference)) {
    find_target(camera, s);
    find_limbs(camera, s);
}

void PictureJudge::find_target(const StillCamera& camera, const ScenarioConfig& s) {
    const ImageGeometry geometry = geometry_of(s.camera, 0);
    const WorldSnapshot& world = camera.world();
    PixelBox box;
    for (const std::size_t part : target_parts(s))
        box = join(box, box_of(world.objects.at(part).position_world_m,
                               camera.renderer().object_radius_m(part), world.camera, geometry));
    if (box.empty()) return;
    const int left = static_cast<int>(s.camera.black_columns), top = static_cast<int>(s.camera.black_rows);
    target_ = {std::max(left, left + box.x0 - kTargetMargin_px),
               std::max(top, top + box.y0 - kTargetMargin_px),
               std::min(reference_.mean.width(), left + box.x1 + kTargetMargin_px),
               std::min(reference_.mean.height(), top + box.y1 + kTargetMargin_px)};
    target_light_ = window_light(reference_.mean, reference_.dark, target_);
}

void PictureJudge::find_limbs(const StillCamera& camera, const ScenarioConfig& s) {
    // The lines of a line camera have different instants.
    if (s.camera.shutter.kind == ShutterKind::kLineScan) return;
    const ImageGeometry geometry = geometry_of(s.camera, 0);
    const WorldSnapshot& world = camera.world();
    for (std::size_t i = 0; i < kBodyCount; ++i) {
        if (!s.bodies[i].visible) continue;
        // Terrain hides the smooth body's limb.
        if (s.terrain && s.terrain->place && i == index_of(s.terrain->place->body)) continue;
        for (const LimbPlace& place :
             limb_places(world.bodies.body[i], kFigures[i], world.camera, geometry)) {
            const double x = place.position_px.x + offset_px_.x, y = place.position_px.y + offset_px_.y;
            // The target may be in front of it.
            const bool free = x < target_.x0 || x > target_.x1 || y < target_.y0 || y > target_.y1;
            if (free) limbs_.push_back(place);
        }
    }
}

ElectronImage PictureJudge::saturated(const ElectronImage& electrons) const {
    ElectronImage picture = clone(electrons);
    saturate(picture, saturation_e_);
    return picture;
}

PictureErrors PictureJudge::errors(const ElectronImage& electrons) const {
    const ElectronImage picture = saturated(electrons);
    const ElectronImage &truth = reference_.mean, &dark = reference_.dark;
    PictureErrors out;
    out.noise = noise_error(picture, truth, dark, noise_);
    out.false_lights = static_cast<double>(false_lights(picture, truth, dark, noise_));
    if (target_light_)
        if (const auto light = window_light(picture, dark, target_)) {
            out.centroid_px =
                std::hypot(light->x_px - target_light_->x_px, light->y_px - target_light_->y_px);
            out.photometric_fraction = std::abs(light->total_e / target_light_->total_e - 1);
        }
    if (const auto limb = limb_error(picture, truth, limbs_, offset_px_, noise_.sigma_e(0, 0)))
        out.limb_px = limb->rms_px;
    out.similarity = structural_similarity(picture, truth, saturation_e_);
    return out;
}

std::vector<double> PictureJudge::lit_errors(const ElectronImage& electrons) const {
    const ElectronImage &truth = reference_.mean, &dark = reference_.dark;
    return hilcam::lit_errors({saturated(electrons), truth, truth, dark}, noise_);
}

std::vector<double> PictureJudge::lit_scatter(const ElectronImage& electrons,
                                              const ElectronImage& other) const {
    return hilcam::lit_errors({saturated(electrons), saturated(other), reference_.mean, reference_.dark},
                              noise_);
}

}  // namespace hilcam
