#include "emulator/tradeoff/error_bench.h"

#include <spdlog/fmt/fmt.h>

#include <nlohmann/json.hpp>

#include "emulator/bench/pilot.h"
#include "emulator/progress/progress.h"
#include "emulator/recording/machine_report.h"
#include "emulator/tradeoff/mean_errors.h"
#include "emulator/tradeoff/reference_cache.h"

namespace hilcam {
namespace {

using nlohmann::json;
using Log = std::function<void(const std::string&)>;

constexpr std::uint64_t kFrames = 2;  // of a view: one more than one tells what is chance

struct View {
    double angle_deg = 0;
    std::optional<Pose> body;  // none: where the scenario has it
};

// The flight of the bench; where things have motions of their own, about where those have them. world: at the
// start.
std::vector<View> views_of(const ScenarioConfig& scenario, const WorldSnapshot& world, int count) {
    if (scenario.objects.empty()) return {View{}};
    CircleFlight flight = flight_around_target(scenario);
    if (scenario.has_camera_motion) flight.start_m = world.camera.position_world_m;
    if (scenario.objects.front().has_motion) flight.center_m = world.objects.front().position_world_m;
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

// Two frames, each with a seed of its own.
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

// The references of the views, those that are kept from the disk. The camera is loaded for the first that is
// not.
class References {
  public:
    References(const ScenarioConfig& scenario, const ReferenceLimits& limits, std::filesystem::path folder,
               const Log& log)
        : scenario_(scenario), limits_(limits), folder_(std::move(folder)), log_(log) {}

    // camera_world: where the view has the camera.
    ReferencePicture of(const View& view, const Pose& camera_world) {
        const std::string key = reference_key(scenario_, view.body.value_or(camera_world), limits_);
        const std::filesystem::path file = reference_file(folder_, key);
        if (std::optional<ReferencePicture> kept = kept_reference(file, key)) {
            log_(fmt::format("reference of {} frames from {}", kept->frames, file.string()));
            return std::move(*kept);
        }
        if (!camera_) camera_.emplace(scenario_);
        if (view.body) camera_->look_from(*view.body);
        ReferencePicture made = render_reference(*camera_, scenario_, limits_, log_);
        keep_reference(file, key, made);
        log_(fmt::format("took {:.0f} s; kept as {}", made.seconds, file.string()));
        return made;
    }

  private:
    const ScenarioConfig& scenario_;
    ReferenceLimits limits_;
    std::filesystem::path folder_;
    const Log& log_;
    std::optional<StillCamera> camera_;
};

json or_null(const std::optional<double>& value) { return value ? json(*value) : json(nullptr); }

json figures_json(const PictureErrors& e, const NoiseError& error, const NoiseError& scatter) {
    const auto if_lit = [](const NoiseError& of, double value) {
        return of.lit_px > 0 ? json(value) : json(nullptr);
    };
    return {{"error_sigma_p99", if_lit(error, error.p99)},
            {"error_sigma_rms", if_lit(error, error.rms)},
            {"within_half_sigma_fraction", if_lit(error, error.within_half_fraction)},
            {"lit_px", static_cast<double>(error.lit_px) / kFrames},
            {"false_lights", e.false_lights},
            {"centroid_shift_px", or_null(e.centroid_px)},
            {"photometric_error_fraction", or_null(e.photometric_fraction)},
            {"limb_error_px", or_null(e.limb_px)},
            {"ssim", or_null(e.similarity)},
            {"scatter_sigma_p99", if_lit(scatter, scatter.p99)},
            {"scatter_sigma_rms", if_lit(scatter, scatter.rms)}};
}

json view_json(const View& view, const Pose& camera_world, const ViewErrors& v,
               const ReferencePicture& reference) {
    json out = figures_json(v.mean, noise_error(v.errors), noise_error(v.scatter));
    const Vec3d& p = camera_world.position_world_m;
    out["angle_deg"] = view.angle_deg;
    out["position_m"] = {p.x, p.y, p.z};
    const NoiseError& e = reference.standard_error;
    const bool lit = e.lit_px > 0;
    out["reference"] = {{"frames", reference.frames},
                        {"seconds", reference.seconds},
                        {"standard_error_sigma_p99", lit ? json(e.p99) : json(nullptr)},
                        {"standard_error_sigma_rms", lit ? json(e.rms) : json(nullptr)},
                        {"lit_px", e.lit_px}};
    return out;
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
    json figures() const {
        PictureErrors e;
        e.false_lights = false_lights_;
        e.centroid_px = centroid_.value(), e.photometric_fraction = photometric_.value();
        e.limb_px = limb_.value(), e.similarity = similarity_.value();
        return figures_json(e, noise_error(errors_), noise_error(scatter_));
    }

  private:
    std::vector<double> errors_, scatter_;
    double false_lights_ = 0;
    Mean centroid_, photometric_, limb_, similarity_;
};

std::string cell(const json& value, int digits) {
    return value.is_null() ? std::string("-") : fmt::format("{:.{}f}", value.get<double>(), digits);
}

std::string row(const std::string& name, const json& of, const std::string& standard_error) {
    return fmt::format("{:>6} {:>8} {:>8} {:>7} {:>9} {:>9} {:>9} {:>8} {:>8} {:>9}\n", name,
                       cell(of["error_sigma_p99"], 3), cell(of["error_sigma_rms"], 3),
                       cell(of["false_lights"], 1), cell(of["centroid_shift_px"], 4),
                       cell(of["photometric_error_fraction"], 5), cell(of["limb_error_px"], 4),
                       cell(of["scatter_sigma_p99"], 3), cell(of["scatter_sigma_rms"], 3), standard_error);
}

}  // namespace

json error_bench(const ScenarioSource& source, const ErrorBenchOptions& options,
                 const std::filesystem::path& cache_folder, const Log& log) {
    std::vector<std::string> wait;
    if (source.load().has_terrain) wait.emplace_back("terrain.wait=true");
    const ScenarioConfig scenario = source.load(wait);
    const std::vector<std::string> overrides =
        joined_overrides(reference_overrides(scenario), options.reference_set);
    const ScenarioConfig best = source.load(joined_overrides(overrides, wait));

    References references(best, options.reference, cache_folder, log);
    StillCamera camera(scenario);
    AllViews all;
    json views = json::array();
    const std::vector<View> all_views = views_of(scenario, camera.world(), options.views);
    if (scenario.objects.empty()) log("no object to look at from all around: one view, the scenario's own");
    Progress progress("views", static_cast<double>(all_views.size()));
    for (const View& view : all_views) {
        progress.done(static_cast<double>(views.size()));
        log(fmt::format("view {} of {}", views.size() + 1, all_views.size()));
        if (view.body) camera.look_from(*view.body);
        const Pose& camera_world = camera.world().camera;
        const PictureJudge judge(best, camera, references.of(view, camera_world));
        const ViewErrors errors = measure(camera, judge, static_cast<std::uint64_t>(scenario.seed));
        all.add(errors);
        views.push_back(view_json(view, camera_world, errors, judge.reference()));
    }
    return {{"scenario", scenario.name},           {"width", scenario.camera.width_px},
            {"height", scenario.camera.height_px}, {"views", views},
            {"all_views", all.figures()},          {"frames_per_view", kFrames},
            {"reference_set", overrides},          {"machine", machine_report()}};
}

std::string error_bench_text(const json& report) {
    std::string out = fmt::format(
        "{}: number of views {}, of frames in each {}; in sensor noise: error, scatter, and the standard "
        "error of "
        "the reference\n\n"
        "{:>6} {:>8} {:>8} {:>7} {:>9} {:>9} {:>9} {:>8} {:>8} {:>9}\n"
        "{:>6} {:>8} {:>8} {:>7} {:>9} {:>9} {:>9} {:>8} {:>8} {:>9}\n",
        report["scenario"].get<std::string>(), report["views"].size(),
        report["frames_per_view"].get<std::uint64_t>(), "view", "error", "error", "false", "centroid",
        "photom.", "limb", "scatter", "scatter", "reference", "deg", "p99", "rms", "lights", "px", "fraction",
        "px", "p99", "rms", "p99");
    for (const json& view : report["views"])
        out += row(fmt::format("{:.0f}", view["angle_deg"].get<double>()), view,
                   cell(view["reference"]["standard_error_sigma_p99"], 3));
    return out + row("all", report["all_views"], "");
}

}  // namespace hilcam
