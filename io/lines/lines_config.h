#pragma once
// The section `lines`: where edges come from and go to (docs/lines.md).

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "io/contract/camera_control.h"
#include "io/lines/camera_lines.h"
#include "render/vocabulary/config_field.h"

namespace hilcam {

struct LineUdpConfig {
    enum class Clock : std::uint8_t { kMonotonic, kTai };
    std::string address = "127.0.0.1";
    std::int64_t port = 5014;
    std::vector<std::string> allow{};
    std::vector<std::string> send_to{};
    Clock clock = Clock::kMonotonic;
};
Fields fields(LineUdpConfig& config);
void validate(const LineUdpConfig& config);

// A pin of a GPIO chip; no chip: none.
struct PinConfig {
    enum class Bias : std::uint8_t { kAsIs, kPullUp, kPullDown, kDisabled };
    std::string gpio{};
    std::int64_t pin = 0;
    Bias bias = Bias::kAsIs;
    double debounce_s = 0;
};

struct LineInputConfig {
    std::int64_t line = 0, camera = 0;
    PinConfig pin{};
    std::string pps{};
};
Fields fields(LineInputConfig& config);
void validate(const LineInputConfig& config);

struct LineOutputConfig {
    std::int64_t line = 1, camera = 1;
    LineSignal source = LineSignal::kExposureActive;
    bool inverted = false;
    PinConfig pin{};
};
Fields fields(LineOutputConfig& config);

// The trigger of all cameras at the start.
struct LineTriggerConfig {
    std::int64_t line = 0;
    TriggerActivation activation = TriggerActivation::kRisingEdge;
    std::int64_t divider = 1;
    TriggerOverlap overlap = TriggerOverlap::kReadOut;
    ExposureMode exposure = ExposureMode::kTimed;
};
Fields fields(LineTriggerConfig& config);

struct LinesConfig {
    std::optional<LineUdpConfig> udp;
    std::vector<LineInputConfig> inputs;
    std::vector<LineOutputConfig> outputs;
    std::optional<LineTriggerConfig> trigger;

    bool any() const { return udp || !inputs.empty() || !outputs.empty() || trigger; }
};
Fields fields(LinesConfig& config);
void validate(const LinesConfig& config);

// Returns the lines of one camera. camera: from 1.
LinePlan plan_of(const LinesConfig& config, std::size_t camera);
SettingsChange change_of(const LineTriggerConfig& config);

}  // namespace hilcam
