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

namespace hilcam {

struct ErrorBenchOptions {
    int views = 6;
    ReferenceLimits reference{.most_frames = 4};
    std::vector<std::string> reference_set;  // KEY=VALUE, in place of reference_overrides()
};

// A view's figures are means over its frames, those in sensor noise over all lit pixels of its frames
// together. Over all views: in sensor noise over all lit pixels of all views together; false lights, the sum;
// the others, the mean over the views that have them. Null: there is no such thing in the picture. Throws
// InputError, DeviceError. Owner thread.
nlohmann::json error_bench(const ScenarioSource& source, const ErrorBenchOptions& options,
                           const std::filesystem::path& cache_folder,
                           const std::function<void(const std::string&)>& log);
// The same as a table.
std::string error_bench_text(const nlohmann::json& report);

}  // namespace hilcam
