#pragma once
// `hilcam bench --soak`: runs a scenario at its own frame rate for a long time and shows what changes.
//
// The camera flies around the first object in real time. A round takes about a minute (less when slices are
// shorter), and each slice holds a whole number of rounds, so that all slices show the same views and can be
// compared. The first round is a warm-up that is not counted: by its end, all that grows with the size of the
// view has grown. The mode is free-run, whatever the scenario says. Only the first camera of several is
// measured.
//
// The measurement itself uses constant memory: percentiles come from histograms of fixed size (latency.h,
// right within 2.2 %), and all slices are allocated at the start.

#include <cstdint>
#include <vector>

#include "emulator/bench/trend.h"
#include "emulator/run/broken_bounds.h"
#include "emulator/scenario/app_config.h"

namespace hilcam {

struct SoakOptions {
    static constexpr double kMaxSlices = 1440;

    double seconds = 0;    // length of the measurement, without warm-up
    double slice_s = 0;    // 0: a sixtieth of `seconds`, at least 10 s; at most kMaxSlices slices
    bool outputs = false;  // true: the scenario's outputs and command ports run as well
};

struct SoakPercentiles {
    double p50_ms = 0, p99_ms = 0, p999_ms = 0, max_ms = 0;
};

struct SoakSlice {
    double start_s = 0, length_s = 0;  // counted from the end of the warm-up
    std::uint64_t frames = 0, deadline_misses = 0;
    double memory_mb = 0;  // resident memory at the slice's end (/proc/self/statm; 10^6 bytes)
    // work: rendering, sensing and publishing a frame. interval: from one frame to the next. latency: from a
    // pose's arrival until the first frame that shows it has been handed over.
    SoakPercentiles work, interval, latency;
};

struct Soak {
    double slice_s = 0, round_s = 0;
    std::size_t triangles = 0;
    std::vector<SoakSlice> slices;    // finished slices; fewer than asked for if a signal ended the run
    SoakSlice whole;                  // all slices together
    std::vector<BrokenBound> broken;  // bounds of loop.fail_on that the whole run broke, its warm-up included
};

// Throws what Emulator throws, and InputError for bounds on latency without outputs.
Soak soak(const ScenarioConfig& scenario, const SoakOptions& options);

// The course of a figure over the slices.
struct SoakCourse {
    double first = 0, last = 0;
    double per_hour = 0;  // slope (trend.h)
    double growth = 0;    // from the first slice to the last, by that slope
    double sigma = 0;
};

// Memory is flat when neither its trend nor its last slice is kFlat_mb above the first slice. A leak of
// glibc's smallest block (32 bytes) per frame exceeds that after 31,250 frames, 9 minutes at 60 Hz.
//
// Latency is steady when neither its median nor its 99th percentile has a significant trend of more than
// kSteady_fraction of the first slice's value.
struct SoakVerdict {
    static constexpr double kFlat_mb = 1;
    static constexpr double kSteady_fraction = 0.05;

    bool enough = false;  // at least kMinForTrend slices
    bool memory_flat = false, latency_steady = false;
    SoakCourse memory_mb, latency_p50_ms, latency_p99_ms;
};
SoakVerdict judge(const Soak& soak);

}  // namespace hilcam
