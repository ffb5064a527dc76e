#include "emulator/frame_starter.h"

#include <algorithm>
#include <cmath>

namespace hilcam {
namespace {

constexpr std::int64_t kLongestSleep_ns = 50'000'000;  // how long a stop may have to wait
constexpr std::int64_t kLastStretch_ns = 1'000'000;    // before a begin nothing else is listened to

std::int64_t to_ns(double seconds) { return static_cast<std::int64_t>(std::llround(seconds * 1e9)); }

}  // namespace

FrameStarter::FrameStarter(const CameraModel& camera, LiveSettings& settings, SimulatedClock& clock,
                           bool paced)
    : settings_(settings),
      clock_(clock),
      timing_(camera),
      lockstep_(settings.limits().lockstep),
      paced_(paced),
      schedule_(0) {
    for (const SettingsStep& step : camera.sequence)
        longest_step_s_ = std::max(longest_step_s_, step.exposure_s);
}

double FrameStarter::period_s(const CameraSettings& s, double exposure_s) const {
    return timing_.period_s(s.frame_rate_hz, std::max(exposure_s, longest_step_s_));
}

bool FrameStarter::next(double own_exposure_s, const std::atomic<bool>& stopping, Start& start) {
    own_exposure_s_ = own_exposure_s;
    while (!stopping.load(std::memory_order_relaxed)) {
        const CameraSettings& now = settings_.read_in_loop();
        if (!now.running || !now.triggered) forget_orders();
        if (!now.running) {
            idle_ = true;
            settings_.wait_for_news();
            continue;
        }
        start = {};
        start.settings = now;
        const bool begun = now.triggered ? begin_ordered(stopping, start) : begin_free_run(stopping, start);
        if (!begun) continue;
        start.not_before_ns =
            paced_ && !lockstep_ ? start.begin_ns + to_ns(timing_.end_s(start.exposure_s)) : 0;
        return true;
    }
    settings_.close();
    forget_orders();
    return false;
}

double FrameStarter::exposure_of(const CameraSettings& s) const {
    return s.automatic_exposure && own_exposure_s_ > 0 ? own_exposure_s_ : s.exposure_s;
}

bool FrameStarter::begin_free_run(const std::atomic<bool>& stopping, Start& start) {
    const std::int64_t arrived_ns = monotonic_ns();
    if (idle_) schedule_.restart(arrived_ns);
    idle_ = false;
    const auto period_ns = [&] { return to_ns(period_s(start.settings, exposure_of(start.settings))); };
    if (paced_) {
        const FrameSchedule before = schedule_;
        FrameSchedule::Slot due = schedule_.take(arrived_ns, period_ns());
        // A new period counts from the last frame on: what waits for its begin begins at another time.
        while (settings_.wait_for_news_until(due.start_ns - kLastStretch_ns)) {
            start.settings = settings_.read_in_loop();
            if (stopping.load(std::memory_order_relaxed) || !start.settings.running ||
                start.settings.triggered)
                return false;
            schedule_ = before;
            const std::int64_t now_ns = monotonic_ns();
            if (due.skipped == 0 && schedule_.next_ns(period_ns()) < now_ns) schedule_.restart(now_ns);
            due = schedule_.take(arrived_ns, period_ns());
        }
        if (!sleep_until(due.start_ns, stopping)) return false;
        start.begin_ns = due.start_ns;
        start.skipped = due.skipped;
        start.settings = settings_.read_in_loop();
    } else {
        start.begin_ns = arrived_ns;
    }
    start.exposure_s = exposure_of(start.settings);
    return true;
}

bool FrameStarter::begin_ordered(const std::atomic<bool>& stopping, Start& start) {
    idle_ = true;  // free-run, when it comes back, begins a raster anew
    if (left_ == 0 && !take_order(start.settings, exposure_of(start.settings))) {
        settings_.wait_for_news();
        return false;
    }
    if (!lockstep_ && !sleep_until(next_ns_, stopping)) return false;
    start.settings = settings_.read_in_loop();
    start.exposure_s = exposure_of(start.settings);
    start.begin_ns = next_ns_;
    const std::int64_t period_ns = to_ns(period_s(start.settings, start.exposure_s));
    if (lockstep_) {
        last_mid_ = clock_.at(next_ns_ + to_ns(timing_.middle_s(start.exposure_s)));
        clock_.step_to(last_mid_);
    } else {
        start.late = monotonic_ns() > next_ns_ + period_ns;
    }
    next_ns_ += period_ns;
    start.trigger_sequence = order_.sequence;
    start.ends_order = --left_ == 0;
    return true;
}

bool FrameStarter::take_order(const CameraSettings& settings, double exposure_s) {
    if (!settings_.take_trigger(order_)) return false;
    left_ = order_.frames;
    if (!lockstep_) {
        next_ns_ = order_.at_monotonic_ns;
        return true;
    }
    const std::int64_t to_middle_ns = to_ns(timing_.middle_s(exposure_s));
    if (order_.at_simulated.ns != 0)
        next_ns_ = clock_.monotonic_at(order_.at_simulated) - to_middle_ns;
    else if (last_mid_.ns != 0)
        next_ns_ = clock_.monotonic_at(last_mid_) + to_ns(period_s(settings, exposure_s)) - to_middle_ns;
    else
        next_ns_ = clock_.monotonic_at(clock_.start());
    return true;
}

void FrameStarter::forget_orders() {
    if (left_ > 0) settings_.order_done();
    left_ = 0;
    while (settings_.take_trigger(order_)) settings_.order_done();
}

bool FrameStarter::sleep_until(std::int64_t ns, const std::atomic<bool>& stopping) const {
    while (monotonic_ns() < ns) {
        if (stopping.load(std::memory_order_relaxed)) return false;
        sleep_until_monotonic_ns(std::min(ns, monotonic_ns() + kLongestSleep_ns));
    }
    return true;
}

}  // namespace hilcam
