#pragma once
// `hilcam bench --error`: measures how far a scenario's frames are from the truth, in views all around its
// target.
//
// Views are spaced evenly over the flight of `hilcam bench` (bench/pilot.h), with the camera at rest relative
// to the target. The time is always the scenario's start, so that only the camera moves. A scenario without
// objects has one view, its own. In each view, two frames with independent light paths are compared with a
// reference (picture_judge.h) from the cache folder (reference_cache.h).

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
    std::vector<std::string> reference_set;  // KEY=VALUE, replaces reference_overrides()
};

// Errors of pictures. A view's figures are means over its frames, except those in sensor noise, which are
// taken over all lit pixels of its frames together. Over all views, errors in sensor noise are taken over all
// lit pixels of all views, false lights are added up, and the others are means over the views that have them.
struct ErrorFigures {
    PictureErrors picture;  // all errors except picture.noise
    NoiseError error, scatter;
};

struct ErrorView : ErrorFigures {
    double angle_deg = 0;
    Vec3d position_m;  // the camera's position in the world
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
    std::vector<std::string> reference_set;  // KEY=VALUE that the references have instead of the scenario's
};

// Throws InputError, DeviceError. Owner thread.
ErrorBench error_bench(const ScenarioSource& source, const ErrorBenchOptions& options, const Cache& cache,
                       const std::function<void(const std::string&)>& log);
// Null means that the picture contains nothing of that kind.
nlohmann::json error_bench_json(const ErrorBench& result);
std::string error_bench_text(const ErrorBench& result);

}  // namespace hilcam
