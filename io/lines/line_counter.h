#pragma once
// A counter (SFNC CounterAndTimerControl): counts events from a reset on, until it has counted
// CounterDuration of them. It then raises CounterEnd, is no longer active, and keeps its value until the next
// reset. An event that both resets and counts resets first.

#include <cstdint>
#include <limits>

#include "io/lines/line_words.h"

namespace hilcam {

class LineCounter {
  public:
    struct Settings {
        LineEvent event = LineEvent::kOff;
        TriggerActivation activation = TriggerActivation::kRisingEdge;  // for a line's edges
        LineEvent reset = LineEvent::kOff;                              // a line resets with its rising edge
        std::uint32_t duration = std::numeric_limits<std::uint32_t>::max();
    };
    enum class Status : std::uint8_t { kIdle, kTriggerWait, kActive, kCompleted, kOverflow };  // SFNC

    // Takes an event; true when the counter has come to its end with it.
    bool take(const Settings& s, LineEvent event, bool rises) {
        if (event == LineEvent::kOff) return false;
        const bool of_line = event >= LineEvent::kLine0;
        if (event == s.reset && (!of_line || rises)) reset();
        if (event != s.event || (of_line && !is_active_edge(s.activation, rises))) return false;
        if (value_ >= s.duration) return false;
        return ++value_ == s.duration;
    }
    void reset() { value_at_reset_ = value_, value_ = 0; }
    void set_value(std::uint32_t value) { value_ = value; }
    std::uint32_t value() const { return value_; }
    std::uint32_t value_at_reset() const { return value_at_reset_; }
    Status status(const Settings& s) const {
        if (s.event == LineEvent::kOff) return Status::kIdle;
        return value_ < s.duration ? Status::kActive : Status::kCompleted;
    }

  private:
    std::uint32_t value_ = 0, value_at_reset_ = 0;
};

}  // namespace hilcam
