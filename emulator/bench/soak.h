#pragma once
// `hilcam bench --soak`: a scenario at its own frame rate for a long time, to see what changes with time.
//
// The camera flies around the first object in real time, a whole number of rounds in each slice (a round of
// about a minute, or of a slice that is shorter): all slices show the same views and can be compared. The
// first round is for warming up and is not counted; whatever grows to the largest view has grown by then. The
// mode is free-run, whatever the scenario's. Of several cameras the first is measured.
//
// The measurement takes no memory with time: percentiles come from histograms of fixed size (latency.h, right
// within 2.2 %), and the slices are there from the start.

#include <cstdint>
#include <vector>

#include "emulator/bench/trend.h"
#include "emulator/scenario/app_config.h"

namespace hilcam {

struct SoakOptions {
    static constexpr double kMaxSlices = 1440;

    double seconds = 0;    // without warming up
    double slice_s = 0;    // 0: a sixtieth of the seconds, at least 10 s; no more than kMaxSlices
    bool outputs = false;  // also the scenario's outputs and command ports
};

struct SoakPercentiles {
    double p50_ms = 0, p99_ms = 0, p999_ms = 0, max_ms = 0;
};

struct SoakSlice {
    double start_s = 0, length_s = 0;  // after the warm-up
    std::uint64_t frames = 0, deadline_misses = 0;
    double memory_mb = 0;  // resident at its end (/proc/self/statm; 10^6 bytes)
    // A frame's rendering, sensing and publishing; from one frame to the next; from a pose's arrival to the
    // first frame that shows it, handed over.
    SoakPercentiles work, interval, latency;
};

struct Soak {
    double slice_s = 0, round_s = 0;
    std::size_t triangles = 0;
    std::vector<SoakSlice> slices;  // those that were finished, should a signal have ended the run
    SoakSlice whole;                // all of them as one
};

// Throws what Emulator throws.
Soak soak(const ScenarioConfig& scenario, const SoakOptions& options);

// How a figure went over the slices.
struct SoakCourse {
    double first = 0, last = 0;
    double per_hour = 0;  // trend.h
    double growth = 0;    // by that, from the first slice to the last
    double sigma = 0;
};

// Memory is flat when its trend and its last slice are less than kFlat_mb above the first. A leak of glibc's
// smallest block (32 bytes) per frame is above that after 31,250 frames, 9 minutes at 60 Hz.
// Latency is steady when neither its median nor its 99th percentile has a significant trend of more than
// kSteady_fraction of the first slice's.
struct SoakVerdict {
    static constexpr double kFlat_mb = 1;
    static constexpr double kSteady_fraction = 0.05;

    bool enough = false;  // slices to tell a trend: kMinForTrend
    bool memory_flat = false, latency_steady = false;
    SoakCourse memory_mb, latency_p50_ms, latency_p99_ms;
};
SoakVerdict judge(const Soak& soak);

}  // namespace hilcam
