#include "emulator/tradeoff/error_bench.h"

#include <spdlog/fmt/fmt.h>

#include "emulator/bench/pilot.h"
#include "emulator/progress/progress.h"
#include "emulator/tradeoff/mean_errors.h"
#include "emulator/tradeoff/reference_cache.h"

namespace hilcam {
namespace {

using Log = std::function<void(const std::string&)>;

constexpr std::uint64_t kFrames = 2;  // frames of a view; the second shows how much is chance

struct View {
    double angle_deg = 0;
    std::optional<Pose> body;  // empty: as in the scenario
};

// Uses the bench's flight; where things have their own motions, a circle about the places at the start.
// world: at the start.
std::vector<View> views_of(const ScenarioConfig& scenario, const WorldSnapshot& world, int count) {
    if (scenario.objects.empty()) return {View{}};
    CircleFlight flight = circle_around_target(scenario);
    if (scenario.camera_motion) flight.start_m = world.camera.position_world_m;
    if (scenario.objects.front().motion) flight.center_m = world.objects.front().position_world_m;
    std::vector<View> out;
    for (int i = 0; i < count; ++i) {
        const double share = static_cast<double>(i) / count;
        out.push_back({360 * share, flight.at(flight.period_s * share, parse_utc(scenario.time_utc)).pose});
    }
    return out;
}

struct ViewErrors {
    PictureErrors mean;
    std::vector<double> errors, scatter;  // by lit pixel, in sensor noise
};

// Renders two frames with independent seeds.
ViewErrors measure(StillCamera& camera, const PictureJudge& judge, std::uint64_t seed) {
    ViewErrors out;
    MeanErrors mean;
    ElectronImage first;
    for (std::uint64_t i = 0; i < kFrames; ++i) {
        camera.render({seed + i, 1});
        const ElectronImage& electrons = camera.expose();
        mean.add(judge.errors(electrons));
        const std::vector<double> errors = judge.lit_errors(electrons);
        out.errors.insert(out.errors.end(), errors.begin(), errors.end());
        if (i == 0)
            first = clone(electrons);
        else
            out.scatter = judge.lit_scatter(first, electrons);
    }
    out.mean = mean.mean();
    return out;
}

// The references of the views, from disk where they exist. The camera is loaded for the first one that does
// not.
class References {
  public:
    References(const ScenarioConfig& scenario, const ReferenceLimits& limits, const Cache& cache,
               const Log& log)
        : scenario_(scenario), limits_(limits), cache_(cache), log_(log) {}

    // camera_world: the camera's pose in the view.
    ReferencePicture of(const View& view, const Pose& camera_world) {
        const std::string key = reference_key(scenario_, view.body.value_or(camera_world), limits_);
        const std::filesystem::path file = cache_.folder() / reference_name(key);
        if (std::optional<ReferencePicture> kept = kept_reference(cache_, key)) {
            log_(fmt::format("reference of {} frames from {}", kept->frames, file.string()));
            return std::move(*kept);
        }
        if (!camera_) camera_.emplace(scenario_);
        if (view.body) camera_->look_from(*view.body);
        ReferencePicture made = render_reference(*camera_, scenario_, limits_, log_);
        keep_reference(cache_, key, made);
        log_(fmt::format("took {:.0f} s{}", made.seconds,
                         cache_.writes() ? "; kept as " + file.string() : std::string()));
        return made;
    }

  private:
    const ScenarioConfig& scenario_;
    ReferenceLimits limits_;
    const Cache& cache_;
    const Log& log_;
    std::optional<StillCamera> camera_;
};

ErrorView summary_of(const View& view, const Pose& camera_world, const ViewErrors& v,
                     const ReferencePicture& reference) {
    return {{v.mean, noise_error(v.errors), noise_error(v.scatter)},
            view.angle_deg,
            camera_world.position_world_m,
            reference.frames,
            reference.seconds,
            reference.standard_error};
}

class Mean {
  public:
    void add(const std::optional<double>& value) {
        if (value) sum_ += *value, ++count_;
    }
    std::optional<double> value() const {
        return count_ > 0 ? std::optional<double>(sum_ / count_) : std::nullopt;
    }

  private:
    double sum_ = 0;
    int count_ = 0;
};

class AllViews {
  public:
    void add(const ViewErrors& v) {
        errors_.insert(errors_.end(), v.errors.begin(), v.errors.end());
        scatter_.insert(scatter_.end(), v.scatter.begin(), v.scatter.end());
        false_lights_ += v.mean.false_lights;
        centroid_.add(v.mean.centroid_px);
        photometric_.add(v.mean.photometric_fraction);
        limb_.add(v.mean.limb_px);
        similarity_.add(v.mean.similarity);
    }
    ErrorFigures figures() const {
        PictureErrors e;
        e.false_lights = false_lights_;
        e.centroid_px = centroid_.value(), e.photometric_fraction = photometric_.value();
        e.limb_px = limb_.value(), e.similarity = similarity_.value();
        return {e, noise_error(errors_), noise_error(scatter_)};
    }

  private:
    std::vector<double> errors_, scatter_;
    double false_lights_ = 0;
    Mean centroid_, photometric_, limb_, similarity_;
};

}  // namespace

ErrorBench error_bench(const ScenarioSource& source, const ErrorBenchOptions& options, const Cache& cache,
                       const Log& log) {
    std::vector<std::string> wait;
    if (source.load().terrain) wait.emplace_back("terrain.wait=true");
    const ScenarioConfig scenario = source.load(wait);
    const std::vector<std::string> overrides =
        joined_overrides(reference_overrides(scenario), options.reference_set);
    const ScenarioConfig best = source.load(joined_overrides(overrides, wait));

    References references(best, options.reference, cache, log);
    StillCamera camera(scenario);
    AllViews all;
    ErrorBench out;
    const std::vector<View> all_views = views_of(scenario, camera.world(), options.views);
    if (scenario.objects.empty()) log("no object to look at from all around: one view, the scenario's own");
    Progress progress("views", static_cast<double>(all_views.size()));
    for (const View& view : all_views) {
        progress.done(static_cast<double>(out.views.size()));
        log(fmt::format("view {} of {}", out.views.size() + 1, all_views.size()));
        if (view.body) camera.look_from(*view.body);
        const Pose& camera_world = camera.world().camera;
        const PictureJudge judge(best, camera, references.of(view, camera_world));
        const ViewErrors errors = measure(camera, judge, static_cast<std::uint64_t>(scenario.seed));
        all.add(errors);
        out.views.push_back(summary_of(view, camera_world, errors, judge.reference()));
    }
    out.scenario = scenario.name;
    out.width_px = scenario.camera.width_px, out.height_px = scenario.camera.height_px;
    out.all_views = all.figures();
    out.frames_per_view = kFrames;
    out.reference_set = overrides;
    return out;
}

}  // namespace hilcam
