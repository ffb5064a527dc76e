#pragma once
// `hilcam tradeoff`: measures what each choice in a scenario costs in time and gives in accuracy.
//
// It measures the scenario as it is, then changes one knob at a time (tradeoff_knobs.h), then combinations
// (tradeoff_combinations.h), the most promising first.
//
// A frame is the scenario's first one: rendered, exposed and digitised, one step after the other. Its time is
// the median of `runs` frames after one warm-up frame, and its errors are means over them; each frame has
// independent light paths. Errors are the same on every machine and in every run, but the machine decides how
// many combinations fit into the time. Noise, which all settings share, is left out of the errors.

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "emulator/tradeoff/picture_judge.h"
#include "emulator/tradeoff/tradeoff_knobs.h"

namespace hilcam {

struct TradeoffOptions {
    double budget_s = 600;  // time for the sweep; the reference is made before
    int runs = 5;
    std::size_t combinations = 256;  // largest number of combinations
    ReferenceLimits reference;
    std::vector<std::string> reference_set;  // KEY=VALUE, replaces reference_overrides()
    std::optional<double> frame_ms;          // wanted time; empty: the camera's frame period
    double error_sigma = 0.5;                // wanted error of 99 % of the lit pixels
};

struct FrameTimes {
    double frame_ms = 0, render_ms = 0;  // medians
    double min_ms = 0, max_ms = 0;       // range of frame_ms over the runs
};

struct MeasuredSetting {
    enum class Kind { kOwn, kSingle, kCombination } kind = Kind::kOwn;
    std::vector<std::size_t> choices;  // by knob: 0 for its own value, else one of the others
    FrameTimes times;
    PictureErrors errors;
    bool on_front = false;  // true: on the front of frame_ms and errors.noise.p99

    double error() const { return errors.noise.p99; }
};

struct Tradeoff {
    ScenarioSource source;
    ScenarioConfig scenario;
    std::vector<Knob> knobs;
    std::vector<std::string> reference_overrides;
    int reference_frames = 0;
    double reference_s = 0;
    NoiseError reference_standard_error;
    std::vector<MeasuredSetting> settings;  // the scenario's own comes first
    std::vector<std::string> remarks;       // which settings were left out, and why
    double frame_ms = 0, error_sigma = 0;   // wanted values
    // Answers to these, as indices of settings; empty: no measured setting is fast or accurate enough.
    std::optional<std::size_t> within_time, within_error;

    std::vector<std::string> overrides_of(const std::vector<std::size_t>& choices) const;
};

// Throws InputError, DeviceError. Owner thread.
Tradeoff measure_tradeoff(const ScenarioSource& source, const TradeoffOptions& options,
                          const std::function<void(const std::string&)>& log);

}  // namespace hilcam
