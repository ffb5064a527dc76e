#pragma once
// A camera's own clock: CLOCK_MONOTONIC through an oscillator (oscillator.h) whose rate and reading are
// steered. Reading takes no lock and any thread may do it, the loop too; those who steer it (the control
// thread, the PTP slave) take a mutex.
//
// A new line holds for earlier instants, too: after a step, an exposure before it gets a time stamp of the
// new time. Between steps a stamp of an instant t ago is wrong by t times the change of rate: 0.2 s and 1 ppm
// give 0.2 us.

#include <cstdint>
#include <mutex>

#include "io/ptp/clock_line.h"
#include "io/ptp/oscillator.h"
#include "render/vocabulary/shared_latest.h"

namespace hilcam {

class DeviceClock {
  public:
    static constexpr double kMaxAdjustment = 1e-3;

    // CLOCK_MONOTONIC itself.
    DeviceClock() : DeviceClock(OscillatorConfig{}, {}) {}
    // begin.rate is not used.
    DeviceClock(const OscillatorConfig& oscillator, const ClockLine& begin);

    // --- Any thread, the loop too.
    ClockLine line() const { return line_.read(); }
    std::int64_t device_ns(std::int64_t monotonic_ns) const { return line().device_at(monotonic_ns); }
    std::int64_t monotonic_ns(std::int64_t device_ns) const { return line().monotonic_at(device_ns); }

    // --- Any thread but the loop: these lock.
    // Lets the oscillator's rate walk; to be called about once in a second, or more often.
    void advance(std::int64_t now_monotonic_ns);
    // Adds to the clock's reading.
    void step(std::int64_t now_monotonic_ns, std::int64_t by_ns);
    // Sets the correction of the oscillator's rate: a ratio, at most kMaxAdjustment either way.
    void steer(std::int64_t now_monotonic_ns, double adjustment);
    // Sets the clock's reading.
    void set(std::int64_t now_monotonic_ns, std::int64_t device_ns);

  private:
    // Continues the line from an instant on, by the rates that hold now. Called with the mutex.
    void bend(std::int64_t monotonic_ns, std::int64_t step_ns);
    void walk_to(std::int64_t now_monotonic_ns);

    std::mutex writers_;
    const std::int64_t began_monotonic_ns_;
    Oscillator oscillator_;
    std::int64_t second_ = 0;
    double oscillator_rate_, adjustment_ = 0;
    SharedLatest<ClockLine> line_;
};

}  // namespace hilcam
