#pragma once
// The events and signals that lines, counters and timers can follow. Names and meanings are those of SFNC 2.4
// (DigitalIOControl, CounterAndTimerControl).

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "io/contract/camera_control.h"
#include "io/lines/line_edge.h"

namespace hilcam {

inline constexpr std::size_t kCounters = 2, kTimers = 2, kUserOutputs = 4;

// An instant at which counters count and timers begin. kLine0 and those after it are a line's edges.
enum class LineEvent : std::uint8_t {
    kOff,
    kFrameTrigger,  // a trigger that the camera takes
    kFrameTriggerMissed,
    kFrameStart,
    kFrameEnd,  // the frame goes to the outputs
    kExposureStart,
    kExposureEnd,
    kCounter0End,
    kCounter1End,
    kTimer0End,
    kTimer1End,
    kLine0,
};
inline constexpr std::array<std::string_view, 11> kLineEventNames = {
    "Off",         "FrameTrigger", "FrameTriggerMissed", "FrameStart", "FrameEnd", "ExposureStart",
    "ExposureEnd", "Counter0End",  "Counter1End",        "Timer0End",  "Timer1End"};
inline constexpr std::size_t kLineEvents = kLineEventNames.size() + kLines;

constexpr LineEvent event_of_line(std::size_t line) {
    return static_cast<LineEvent>(static_cast<std::size_t>(LineEvent::kLine0) + line);
}
constexpr LineEvent end_of_counter(std::size_t i) {
    return static_cast<LineEvent>(static_cast<std::size_t>(LineEvent::kCounter0End) + i);
}
constexpr LineEvent end_of_timer(std::size_t i) {
    return static_cast<LineEvent>(static_cast<std::size_t>(LineEvent::kTimer0End) + i);
}

// The signal on an output line.
enum class LineSignal : std::uint8_t {
    kOff,
    kExposureActive,    // from the begin of a frame's first row to the end of its last
    kFrameTriggerWait,  // a trigger would begin a frame
    kFrameActive,       // from the exposure's begin until the frame goes to the outputs
    kCounter0Active,
    kCounter1Active,
    kTimer0Active,
    kTimer1Active,
    kUserOutput0,
    kUserOutput1,
    kUserOutput2,
    kUserOutput3,
};
inline constexpr std::array<std::string_view, 12> kLineSignalNames = {
    "Off",          "ExposureActive", "FrameTriggerWait", "FrameActive", "Counter0Active", "Counter1Active",
    "Timer0Active", "Timer1Active",   "UserOutput0",      "UserOutput1", "UserOutput2",    "UserOutput3"};

// True when an edge to that level is one of those that count; for a level, the edge that begins it.
constexpr bool is_active_edge(TriggerActivation activation, bool rises) {
    return activation == TriggerActivation::kAnyEdge ||
           rises ==
               (activation == TriggerActivation::kRisingEdge || activation == TriggerActivation::kLevelHigh);
}

// Returns the line that is a trigger source; kLines: the source is no line.
constexpr std::size_t line_of(TriggerSource source) {
    if (source == TriggerSource::kLine0) return 0;
    if (source < TriggerSource::kLine1) return kLines;
    return static_cast<std::size_t>(source) - static_cast<std::size_t>(TriggerSource::kLine1) + 1;
}
constexpr TriggerSource source_of_line(std::size_t line) {
    return line == 0 ? TriggerSource::kLine0
                     : static_cast<TriggerSource>(static_cast<std::size_t>(TriggerSource::kLine1) + line - 1);
}
static_assert(line_of(TriggerSource::kLine7) == 7 && source_of_line(7) == TriggerSource::kLine7);

}  // namespace hilcam
