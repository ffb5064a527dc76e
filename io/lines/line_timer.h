#pragma once
// A timer (SFNC CounterAndTimerControl): a pulse of TimerDuration that begins TimerDelay after an event, for
// a strobe. Events while it runs, its delay included, do not count. Its times are the machine's
// (CLOCK_MONOTONIC). Example: event at 5 ms, delay 1 ms, duration 2 ms: active from 6 ms to 8 ms.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "io/lines/line_words.h"

namespace hilcam {

class LineTimer {
  public:
    static constexpr double kMaxTime_us = 60e6, kMinDuration_us = 1;
    static constexpr std::int64_t kNever_ns = std::numeric_limits<std::int64_t>::max();
    struct Settings {
        LineEvent trigger = LineEvent::kOff;
        TriggerActivation activation = TriggerActivation::kRisingEdge;  // for a line's edges
        double delay_us = 0, duration_us = 1000;
    };
    enum class Status : std::uint8_t { kIdle, kTriggerWait, kActive };  // SFNC

    void take(const Settings& s, LineEvent event, bool rises, std::int64_t at_ns) {
        if (event == LineEvent::kOff || event != s.trigger || runs()) return;
        if (event >= LineEvent::kLine0 && !is_active_edge(s.activation, rises)) return;
        start(s, at_ns);
    }
    void start(const Settings& s, std::int64_t at_ns) {
        begin_ns_ = at_ns + to_ns(s.delay_us);
        end_ns_ = begin_ns_ + to_ns(s.duration_us);
        active_ = false;
    }
    void stop() { begin_ns_ = end_ns_ = kNever_ns, active_ = false; }

    // Returns when it next changes; kNever_ns: it does not.
    std::int64_t next_ns() const { return !runs() ? kNever_ns : active_ ? end_ns_ : begin_ns_; }
    // Makes the change of next_ns(); true at the timer's end.
    bool step() {
        if (!active_) return active_ = true, false;
        stop();
        return true;
    }
    bool active() const { return active_; }
    Status status(const Settings& s) const {
        if (runs()) return Status::kActive;
        return s.trigger == LineEvent::kOff ? Status::kIdle : Status::kTriggerWait;
    }
    // Returns how long its pulse has lasted; 0 before it and after it.
    double value_us(std::int64_t now_ns) const {
        return active_ ? static_cast<double>(std::clamp(now_ns, begin_ns_, end_ns_) - begin_ns_) * 1e-3 : 0;
    }

  private:
    static std::int64_t to_ns(double us) { return std::llround(us * 1e3); }
    bool runs() const { return begin_ns_ != kNever_ns; }

    std::int64_t begin_ns_ = kNever_ns, end_ns_ = kNever_ns;
    bool active_ = false;
};

}  // namespace hilcam
