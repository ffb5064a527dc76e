#pragma once
// `hilcam bench`: how fast a scenario runs on this machine, and how far that is from the time that cannot be
// avoided.

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
    std::uint64_t frames = 120;  // frames of a run, after 20 frames of warm-up
    int runs = 5;                // number of runs; results are medians over them
    // True: times a frame with each path model, too, against bare Embree on the same rays.
    bool path_models = false;
};

// The time that cannot be avoided: bare Embree on the frame's primary and shadow rays, one FFT pair, and one
// copy of the frame. Embree's time is the median over nine places of the flight; without an object to fly
// around, it is measured where the scenario puts the camera.
struct BenchFloor {
    double embree_ms = 0, fft_pair_ms = 0, copy_ms = 0;

    double sum_ms() const { return embree_ms + fft_pair_ms + copy_ms; }
};

// Times are medians over the runs; counts are those of the last run.
struct Bench {
    std::string scenario;
    std::int64_t width_px = 0, height_px = 0;
    BenchOptions options;
    std::size_t triangles = 0;
    RenderStats rendered;  // figures of the last frame
    double frame_rate_hz = 0, p50_ms = 0, p99_ms = 0;
    std::vector<double> runs_p50_ms;
    // Processor time of all threads of the process over the timed frames, including the pilot's (pilot.h).
    // Loading, warm-up and the measurement of the floor are not included, nor are threads that work ahead:
    // their time grows with the simulated time of a run, not with its frames.
    double core_ms_per_frame = 0;
    double ahead_core_ms_per_frame = 0;  // time of those threads
    StageTimes stages;
    Percentiles latency;  // from a pose's arrival until the first frame that shows it has been handed over
    BenchFloor floor;
    std::vector<PathModelSpeed> path_models;  // filled when the options ask for them

    double ratio_to_floor() const { return p50_ms / floor.sum_ms(); }
    // Returns by how much the slowest run's median exceeds the fastest's; 0 for one run.
    double spread_of_runs() const;
    // Above this the machine was busy, and differences between programs mean little.
    static constexpr double kBusy = 0.2;
};

// The camera flies once around the first object while the pipeline computes frames as fast as it can, without
// outputs. Throws InputError, DeviceError. Owner thread.
Bench bench(const ScenarioConfig& scenario, const BenchOptions& options);

// The figures of a scenario or one of its variants. Their runs take turns within one process, so each run has
// a run of the first close to it, on a machine in much the same state.
struct BenchVariant {
    std::string name;
    Bench bench;
    // Processor time per frame over that of the first variant, run by run: median, least, most.
    double ratio = 1, least_ratio = 1, most_ratio = 1;
};
struct NamedScenario {
    std::string name;
    ScenarioConfig scenario;
};
// scenarios: at least one. Otherwise as bench().
std::vector<BenchVariant> bench_variants(const std::vector<NamedScenario>& scenarios,
                                         const BenchOptions& options);

}  // namespace hilcam
