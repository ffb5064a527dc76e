#pragma once
// `hilcam tradeoff`: what each choice of a scenario costs in time and gives in accuracy, measured.
//
// First the scenario as it is, then one knob at a time from there (tradeoff_knobs.h), then combinations
// (tradeoff_combinations.h), those that promise most first.
//
// A frame is the scenario's first one: rendered, exposed, digitised, nothing in parallel but what these do
// inside. Its time is the median of `runs` frames after one to warm up, its errors are means over them; each
// frame has light paths of its own. Errors are the same on every machine and run; which combinations there is
// time for is not. Noise, which all settings share, is left out of the errors.

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "emulator/tradeoff/picture_judge.h"
#include "emulator/tradeoff/tradeoff_knobs.h"

namespace hilcam {

struct TradeoffOptions {
    double budget_s = 600;  // of the sweep; the reference is made before it
    int runs = 5;
    std::size_t combinations = 256;  // at most
    ReferenceLimits reference;
    std::vector<std::string> reference_set;  // KEY=VALUE, in place of reference_overrides()
    std::optional<double> frame_ms;          // asked for; none: the camera's frame period
    double error_sigma = 0.5;                // asked for, of 99 % of the lit pixels
};

struct FrameTimes {
    double frame_ms = 0, render_ms = 0;  // medians
    double min_ms = 0, max_ms = 0;       // of the whole frame
};

struct MeasuredSetting {
    enum class Kind { kOwn, kSingle, kCombination } kind = Kind::kOwn;
    std::vector<std::size_t> choices;  // by knob: 0 its own, else one of the others
    FrameTimes times;
    PictureErrors errors;
    bool on_front = false;  // of frame_ms against errors.noise.p99

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
    std::vector<MeasuredSetting> settings;  // the scenario's own first
    std::vector<std::string> remarks;       // what was left out and why
    double frame_ms = 0, error_sigma = 0;   // asked for
    // Answers to that, as indices of settings; none: no measured one is fast or accurate enough.
    std::optional<std::size_t> within_time, within_error;

    std::vector<std::string> overrides_of(const std::vector<std::size_t>& choices) const;
};

// Throws InputError, DeviceError. Owner thread.
Tradeoff measure_tradeoff(const ScenarioSource& source, const TradeoffOptions& options,
                          const std::function<void(const std::string&)>& log);

}  // namespace hilcam
