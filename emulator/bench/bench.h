#pragma once
// `hilcam bench`: how fast a scenario runs here, and how far that is from what cannot be avoided.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "emulator/run/report.h"
#include "emulator/scenario/app_config.h"
#include "render/frame/render_bench.h"
#include "render/frame/renderer.h"

namespace hilcam {

struct BenchOptions {
    std::uint64_t frames = 120;  // per run, after 20 for warming up
    int runs = 5;                // medians are taken over the runs
    // True: also a frame with each path model, against bare Embree on the same rays.
    bool path_models = false;
};

// The time that cannot be avoided: bare Embree on the primary and shadow rays of such frames (the median of
// nine places of the circle; without an object to fly around, as the scenario has the camera), one FFT pair, one copy of the frame.
struct BenchFloor {
    double embree_ms = 0, fft_pair_ms = 0, copy_ms = 0;

    double sum_ms() const { return embree_ms + fft_pair_ms + copy_ms; }
};

// Times are medians over the runs, counts those of the last.
struct Bench {
    std::string scenario;
    std::int64_t width_px = 0, height_px = 0;
    BenchOptions options;
    std::size_t triangles = 0;
    RenderStats rendered;  // figures of the last frame
    double frame_rate_hz = 0, p50_ms = 0, p99_ms = 0;
    std::vector<double> runs_p50_ms;
    // The processor time of all the process's threads over the timed frames, the pilot's (pilot.h) among
    // them; not in it are loading, warming up and the floor's measurement.
    double core_ms_per_frame = 0;
    StageTimes stages;
    Percentiles latency;  // from a pose's arrival to the first frame that shows it, handed over
    BenchFloor floor;
    std::vector<PathModelSpeed> path_models;  // where the options ask for them

    double ratio_to_floor() const { return p50_ms / floor.sum_ms(); }
};

// The camera flies once around the first object while frames are computed as fast as the pipeline goes,
// without outputs. Throws InputError, DeviceError. Owner thread.
Bench bench(const ScenarioConfig& scenario, const BenchOptions& options);

}  // namespace hilcam
