#pragma once
// `hilcam bench`: how fast a scenario runs here, and how far that is from what cannot be avoided.

#include <cstdint>

#include <nlohmann/json_fwd.hpp>

#include "emulator/scenario/app_config.h"

namespace hilcam {

struct BenchOptions {
    std::uint64_t frames = 120;  // per run, after 20 for warming up
    int runs = 5;                // medians are taken over the runs
    bool path_models = false;    // also a frame with each path model, against bare Embree on the same rays
};

// The camera flies once around the first object while frames are computed as fast as the pipeline goes,
// without outputs. Figures are medians over the runs, counts those of the last. latency_ms: from a pose's
// arrival to the first frame that shows it, handed over. core_ms_per_frame: processor time of all the
// process's threads over the timed frames, the pilot's (pilot.h) among them; not in it are loading, warming
// up and the floor's measurement. floor_ms: bare Embree on the primary and shadow rays
// of such frames (the median of nine places of the circle), plus one FFT pair, plus one copy of the frame.
nlohmann::json bench(const ScenarioConfig& scenario, const BenchOptions& options);

}  // namespace hilcam
