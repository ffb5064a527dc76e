#include "emulator/zoo/zoo_bench.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>

#include "emulator/characterise/characterise_setup.h"
#include "emulator/progress/progress.h"
#include "emulator/tradeoff/reference_cache.h"
#include "emulator/zoo/zoo_camera.h"
#include "emulator/zoo/zoo_errors.h"
#include "io/system/monotonic.h"
#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

using Log = std::function<void(const std::string&)>;

// Removes the scenario's own quality, so that all qualities are compared with the same reference.
std::vector<std::string> without_quality(std::vector<std::string> overrides) {
    std::erase_if(overrides, [](const std::string& text) {
        return text.starts_with("quality.") || text.starts_with("quality=");
    });
    return overrides;
}

ScenarioConfig reference_of(const ScenarioSource& source, const std::vector<std::string>& more) {
    ScenarioSource plain{source.file,
                         joined_overrides(without_quality(source.overrides), {"quality=reference"})};
    std::vector<std::string> overrides = reference_overrides(plain.load());
    overrides = joined_overrides(overrides, zoo_reference_overrides());
    return plain.load(joined_overrides(overrides, more));
}

// Returns the same camera with a shifted lens, so that the whole picture moves to the right.
ScenarioConfig panned(const ScenarioConfig& scenario, double pan_px) {
    ScenarioConfig out = scenario;
    CameraModel& camera = out.camera;
    if (camera.principal_point_px.empty())
        camera.principal_point_px = {0.5 * static_cast<double>(camera.width_px),
                                     0.5 * static_cast<double>(camera.height_px)};
    camera.principal_point_px[0] += pan_px;
    return out;
}

// The references of a member, from disk where they exist. The camera is loaded for the first one that does
// not.
class ZooReferences {
  public:
    ZooReferences(const ScenarioConfig& scenario, const ReferenceLimits& limits, const Cache& cache,
                  const Log& log)
        : scenario_(scenario), limits_(limits), cache_(cache), log_(log) {}

    ZooReference of(const ZooShot& shot, const Pose& camera_world) {
        const ScenarioConfig shown = scenario_of_shot(scenario_, shot);
        const std::string key = reference_key(shown, shot.camera_body.value_or(camera_world), limits_);
        if (std::optional<ZooReference> kept = kept_zoo_reference(cache_, key)) return std::move(*kept);
        if (!camera_) camera_.emplace(scenario_);
        camera_->take(shot);
        ZooReference made = render_zoo_reference(camera_->camera(), shown, limits_, log_);
        keep_zoo_reference(cache_, key, made);
        return made;
    }

  private:
    const ScenarioConfig& scenario_;
    ReferenceLimits limits_;
    const Cache& cache_;
    const Log& log_;
    std::optional<ZooCamera> camera_;
};

struct Pictures {
    ElectronImage still, panned;
    double core_ms = 0;
};

ElectronImage picture_of(StillCamera& camera, std::uint64_t frame) {
    const ScenarioConfig& s = camera.scenario();
    camera.render({static_cast<std::uint64_t>(s.seed), frame});
    ElectronImage picture = clone(camera.expose());
    saturate(picture, configured_saturation_e(s.camera, s.camera.gain_db));
    return picture;
}

// The first frame of a view prepares what the next ones need; the second is timed.
Pictures take_pictures(ZooCamera& still, ZooCamera& panned, const ZooShot& shot) {
    Pictures out;
    picture_of(still.camera(), 1);
    const std::int64_t start_ns = processor_ns();
    out.still = picture_of(still.camera(), 2);
    out.core_ms = static_cast<double>(processor_ns() - start_ns) * 1e-6;
    panned.take(shot);
    out.panned = picture_of(panned.camera(), 2);
    return out;
}

// In a view of things smaller than a pixel, or with pixels that cannot be assigned, all pixels count and none
// is smooth surface.
SurfacePixels surface_of(StillCamera& camera, const ElectronImage& like) {
    std::optional<SurfacePixels> seen = seen_surface(camera);
    if (seen && seen->smooth.size() == like.pixels() &&
        std::find(seen->near_object.begin(), seen->near_object.end(), 1) != seen->near_object.end())
        return std::move(*seen);
    SurfacePixels all;
    all.width = like.width(), all.height = like.height();
    all.smooth.assign(like.pixels(), 0), all.near_object.assign(like.pixels(), 1);
    return all;
}

std::optional<double> larger(const std::optional<double>& a, const std::optional<double>& b) {
    return a && b ? std::optional(std::max(*a, *b)) : (a ? a : b);
}

// Adds a view to the figures of all views; errors in sensor noise are computed from pixels.
void add(const ZooFigures& view, ZooFigures& all) {
    all.blocks += view.blocks, all.grid += view.grid, all.pan += view.pan;
    all.false_lights += view.false_lights, all.lost_lights += view.lost_lights;
    all.centroid_px = larger(all.centroid_px, view.centroid_px);
    all.photometric_fraction = larger(all.photometric_fraction, view.photometric_fraction);
    all.core_ms += view.core_ms;
}

ReferencePicture judged_by(const ZooReference& r) {
    return {clone(r.mean), clone(r.dark), r.standard_error, r.frames, r.seconds};
}

// Measures one member of the zoo, view by view.
class MemberBench {
  public:
    MemberBench(const ZooEntry& entry, const ZooOptions& options, const Cache& cache, const Log& log)
        : scenario_(entry.source.load()),
          best_(reference_of(entry.source, options.reference_set)),
          references_(best_, options.reference, cache, log),
          camera_(scenario_),
          panned_(panned(scenario_, pan_px_of(best_))),
          shots_(zoo_shots(scenario_, camera_.camera(), options.all_views)) {
        member_.name = entry.name;
        member_.scenario = entry.source.file.string(), member_.overrides = entry.source.overrides;
        member_.width_px = scenario_.camera.width_px, member_.height_px = scenario_.camera.height_px;
    }

    ZooMember measure() {
        for (const ZooShot& shot : shots_) member_.views.push_back(measure(shot));
        set_errors(pixels_, member_.all);
        member_.all.core_ms /= static_cast<double>(shots_.size());
        return std::move(member_);
    }

  private:
    ZooViewFigures measure(const ZooShot& shot) {
        camera_.take(shot);
        StillCamera& camera = camera_.camera();
        const ZooReference reference = references_.of(shot, camera.world().camera);
        const Pictures pictures = take_pictures(camera_, panned_, shot);
        const SurfacePixels surface = surface_of(camera, reference.mean);
        const SensorNoise noise(scenario_.camera, scenario_.camera.gain_db);
        ZooViewFigures out;
        static_cast<ZooFigures&>(out) =
            zoo_errors({pictures.still, pictures.panned}, reference, surface, noise, pixels_);
        const PictureErrors errors =
            PictureJudge(camera_.shown(), camera, judged_by(reference)).errors(pictures.still);
        out.centroid_px = errors.centroid_px, out.photometric_fraction = errors.photometric_fraction;
        out.core_ms = pictures.core_ms;
        out.name = shot.name;
        out.overrides = overrides_of_shot(scenario_, shot);
        out.reference_frames = reference.frames, out.reference_seconds = reference.seconds;
        add(out, member_.all);
        return out;
    }

    ScenarioConfig scenario_, best_;
    ZooReferences references_;
    ZooCamera camera_, panned_;
    std::vector<ZooShot> shots_;
    ZooPixels pixels_;
    ZooMember member_;
};

}  // namespace

ZooBench zoo_bench(const ZooOptions& options, const Cache& cache, const Log& log) {
    const std::vector<ZooEntry> entries = zoo_entries(options.folder, options.entries);
    ZooBench out;
    out.all_views = options.all_views;
    out.picture_px = options.entries.picture_px;
    out.overrides = options.entries.overrides;
    Progress progress("zoo", static_cast<double>(entries.size()));
    for (const ZooEntry& entry : entries) {
        progress.done(static_cast<double>(out.members.size()));
        log(fmt::format("{}: member {} of {}", entry.name, out.members.size() + 1, entries.size()));
        out.members.push_back(MemberBench(entry, options, cache, log).measure());
    }
    return out;
}

}  // namespace hilcam
