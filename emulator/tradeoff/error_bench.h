#pragma once
// `hilcam bench --error`: how far a scenario's frames are from the truth, in views all around its target.
//
// Views are spaced evenly over the flight of `hilcam bench` (bench/pilot.h), the camera at rest against the
// target; time is the scenario's start, so that nothing but the camera moves. A scenario without objects has
// one view, its own. In each view two frames with light paths of their own are compared with a reference
// (picture_judge.h), which is kept in the cache folder (reference_cache.h).

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "emulator/tradeoff/picture_judge.h"
#include "emulator/tradeoff/tradeoff_knobs.h"
#include "io/cache/cache.h"

namespace hilcam {

struct ErrorBenchOptions {
    int views = 6;
    ReferenceLimits reference{.max_frames = 4};
    std::vector<std::string> reference_set;  // KEY=VALUE, in place of reference_overrides()
};

// The errors of pictures. For a view they are means over its frames, and those in sensor noise over all lit
// pixels of its frames together. Over all views, those in sensor noise are over all lit pixels of all views
// together, false lights are summed up, and the others are the mean over the views that have them.
struct ErrorFigures {
    PictureErrors picture;  // errors except its noise
    NoiseError error, scatter;
};

struct ErrorView : ErrorFigures {
    double angle_deg = 0;
    Vec3d position_m;  // place of the camera in the world
    int reference_frames = 0;
    double reference_seconds = 0;
    NoiseError reference_standard_error;
};

struct ErrorBench {
    std::string scenario;
    std::int64_t width_px = 0, height_px = 0;
    std::vector<ErrorView> views;
    ErrorFigures all_views;
    std::uint64_t frames_per_view = 0;
    std::vector<std::string> reference_set;  // KEY=VALUE, what the references have in place of the scenario's
};

// Throws InputError, DeviceError. Owner thread.
ErrorBench error_bench(const ScenarioSource& source, const ErrorBenchOptions& options, const Cache& cache,
                       const std::function<void(const std::string&)>& log);
// Null in it: there is no such thing in the picture.
nlohmann::json error_bench_json(const ErrorBench& result);
std::string error_bench_text(const ErrorBench& result);

}  // namespace hilcam
