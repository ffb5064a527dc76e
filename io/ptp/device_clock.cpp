#include "io/ptp/device_clock.h"

#include <algorithm>

#include "render/vocabulary/time.h"

namespace hilcam {

DeviceClock::DeviceClock(const OscillatorConfig& oscillator, const ClockLine& begin)
    : began_monotonic_ns_(begin.monotonic_ns),
      oscillator_(oscillator),
      oscillator_rate_(oscillator_.rate_in(0)),
      line_({begin.monotonic_ns, begin.device_ns, oscillator_rate_}) {}

void DeviceClock::bend(std::int64_t monotonic_ns, std::int64_t step_ns) {
    const ClockLine now = line_.read();
    line_.write({monotonic_ns, now.device_at(monotonic_ns) + step_ns,
                 (1 + oscillator_rate_) * (1 + adjustment_) - 1});
}

void DeviceClock::walk_to(std::int64_t now_monotonic_ns) {
    const std::int64_t second = (now_monotonic_ns - began_monotonic_ns_) / kSecond_ns;
    if (second <= second_) return;
    second_ = second;
    const double rate = oscillator_.rate_in(second);
    if (rate <= oscillator_rate_ && rate >= oscillator_rate_) return;
    oscillator_rate_ = rate;
    bend(now_monotonic_ns, 0);
}

void DeviceClock::advance(std::int64_t now_monotonic_ns) {
    const std::lock_guard lock(writers_);
    walk_to(now_monotonic_ns);
}

void DeviceClock::step(std::int64_t now_monotonic_ns, std::int64_t by_ns) {
    const std::lock_guard lock(writers_);
    walk_to(now_monotonic_ns);
    bend(now_monotonic_ns, by_ns);
}

void DeviceClock::steer(std::int64_t now_monotonic_ns, double adjustment) {
    const std::lock_guard lock(writers_);
    walk_to(now_monotonic_ns);
    adjustment_ = std::clamp(adjustment, -kMaxAdjustment, kMaxAdjustment);
    bend(now_monotonic_ns, 0);
}

void DeviceClock::set(std::int64_t now_monotonic_ns, std::int64_t device_ns) {
    const std::lock_guard lock(writers_);
    walk_to(now_monotonic_ns);
    line_.write({now_monotonic_ns, device_ns, (1 + oscillator_rate_) * (1 + adjustment_) - 1});
}

}  // namespace hilcam
