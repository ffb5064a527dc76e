#pragma once
// Simulated time against the machine's monotonic clock. Times are int64 ns.

#include <time.h>

#include <atomic>
#include <cstdint>

#include "io/monotonic.h"
#include "render/time.h"

namespace hilcam {

inline void sleep_until_monotonic_ns(std::int64_t ns) {
    const timespec t{static_cast<time_t>(ns / 1'000'000'000), static_cast<long>(ns % 1'000'000'000)};
    while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &t, nullptr) != 0) {
    }
}

// Simulated = start + (monotonic - monotonic at the start). It runs at real time, or, in lockstep, stands
// until it is told to step: `now` is then the time of the last frame.
class SimulatedClock {
  public:
    SimulatedClock(TimeTai start, std::int64_t monotonic_start_ns, bool lockstep = false)
        : start_(start),
          monotonic_start_ns_(monotonic_start_ns),
          lockstep_(lockstep),
          stepped_ns_(start.ns) {}
    SimulatedClock(const SimulatedClock& other)
        : SimulatedClock(other.start_, other.monotonic_start_ns_, other.lockstep_) {
        stepped_ns_.store(other.stepped_ns_.load());
    }
    SimulatedClock& operator=(const SimulatedClock& other) {
        start_ = other.start_, monotonic_start_ns_ = other.monotonic_start_ns_, lockstep_ = other.lockstep_;
        stepped_ns_.store(other.stepped_ns_.load());
        return *this;
    }

    TimeTai start() const { return start_; }
    // The two axes, whatever the mode.
    TimeTai at(std::int64_t now_ns) const { return start_ + (now_ns - monotonic_start_ns_); }
    std::int64_t monotonic_at(TimeTai simulated) const {
        return monotonic_start_ns_ + (simulated.ns - start_.ns);
    }
    // What a message of that arrival means by "now".
    TimeTai of_arrival(std::int64_t arrival_ns) const {
        return lockstep_ ? TimeTai{stepped_ns_.load()} : at(arrival_ns);
    }
    TimeTai now() const { return of_arrival(monotonic_ns()); }
    bool lockstep() const { return lockstep_; }
    void step_to(TimeTai time) { stepped_ns_.store(time.ns); }

  private:
    TimeTai start_;
    std::int64_t monotonic_start_ns_;
    bool lockstep_;
    std::atomic<std::int64_t> stepped_ns_;
};

// When frames are exposed in free-run: an absolute raster that never drifts and never catches up.
//     next = last + period; when `now` has passed the start after next, whole periods are skipped and
//     counted.
class FrameSchedule {
  public:
    explicit FrameSchedule(std::int64_t first_ns) : last_ns_(first_ns) {}

    struct Slot {
        std::int64_t start_ns = 0;
        std::uint64_t skipped = 0;
    };
    // The next exposure, if the period is that.
    std::int64_t next_ns(std::int64_t period_ns) const { return begun_ ? last_ns_ + period_ns : last_ns_; }
    // The exposure to compute now. A start up to one period in the past still counts: that frame is late, not
    // lost.
    Slot take(std::int64_t now_ns, std::int64_t period_ns) {
        Slot slot{next_ns(period_ns), 0};
        if (now_ns > slot.start_ns + period_ns) {
            slot.skipped = static_cast<std::uint64_t>((now_ns - slot.start_ns) / period_ns);
            slot.start_ns += static_cast<std::int64_t>(slot.skipped) * period_ns;
        }
        last_ns_ = slot.start_ns;
        begun_ = true;
        return slot;
    }
    // After a pause: the raster begins anew.
    void restart(std::int64_t first_ns) { last_ns_ = first_ns, begun_ = false; }

  private:
    std::int64_t last_ns_;
    bool begun_ = false;
};

}  // namespace hilcam
