#include "emulator/loop/frame_starter.h"

#include <algorithm>
#include <cmath>

#include "emulator/loop/loop_parts.h"
#include "render/vocabulary/time.h"

namespace hilcam {
namespace {

// During this time before a begin, nothing else is handled.
constexpr std::int64_t kLastStretch_ns = 1'000'000;

// Returns when an exposure with that begin in the camera's time begins on the machine's clock; kNever_ns
// while the camera waits, even at that very instant. News of the world that arrives before time goes on then
// still counts for it.
std::int64_t when_begins(const SimulatedClock& clock, std::int64_t camera_ns) {
    if (camera_ns == SimulatedClock::kNever_ns) return camera_ns;
    const bool passes = clock.when_due(camera_ns + 1) != SimulatedClock::kNever_ns;
    return passes ? clock.when_due(camera_ns) : SimulatedClock::kNever_ns;
}

}  // namespace

FrameStarter::FrameStarter(const CameraModel& camera, LiveSettings& settings, SimulatedClock& clock,
                           const LoopLimits& limits, const PoseWatch* poses)
    : settings_(settings),
      clock_(clock),
      poses_(poses),
      timing_(camera),
      lockstep_(settings.limits().lockstep),
      paced_(limits.paced),
      prefers_newest_(limits.prefer == LoopPreference::kLatency),
      schedule_(0) {
    settings.follow(clock, lockstep_ ? nullptr : poses);
}

bool FrameStarter::next(double own_exposure_s, const std::atomic<bool>& stopping, Start& start) {
    own_exposure_s_ = own_exposure_s;
    while (!stopping.load(std::memory_order_relaxed)) {
        const CameraSettings& now = settings_.read_in_loop();
        const bool waits = waits_for_poses(), takes_none = !now.running || waits;
        if (waits || (lockstep_ && (takes_none || !now.triggered))) forget_orders();
        forget_dropped();
        if (takes_none) {
            idle_ = true;
            settings_.wait_for_news();
            continue;
        }
        start = {};
        start.settings = now;
        const bool begun = now.triggered ? begin_ordered(stopping, start) : begin_free_run(stopping, start);
        if (!begun) continue;
        if (!lockstep_) over_ns_ = start.camera_ns + to_ns(timing_.busy_s(start.exposure_s));
        start.until_end = paced_ && !lockstep_;
        start.begin_ns = clock_.monotonic_of_camera(start.camera_ns);
        if (poses_) start.silence = poses_->at(clock_.simulated_of_camera(start.camera_ns));
        // Poses became stale while the last stretch was slept through.
        if (start.silence.stale && !lockstep_ && poses_->rules().when_stale == WhenStale::kStop) continue;
        report_begun(start);
        return true;
    }
    settings_.close();
    forget_orders();
    return false;
}

double FrameStarter::exposure_of(const CameraSettings& s) const {
    if (const std::optional<double> of_set_s = settings_.sequencer_in_loop().exposure_s()) return *of_set_s;
    return s.automatic_exposure && own_exposure_s_ > 0 ? own_exposure_s_ : s.exposure_s;
}

// Applies the sequencer's set to a frame; the time at which its exposure begins must be known by then.
void FrameStarter::use_sequencer(Start& start) {
    start.sequencer_set =
        settings_.sequencer_in_loop().begin(clock_.monotonic_of_camera(start.camera_ns), start.settings);
}

// In lockstep frames follow one another, so each exposure is over when the next begins.
void FrameStarter::report_begun(const Start& start) {
    const std::int64_t length_ns = lockstep_ ? 0 : to_ns(timing_.end_s(start.exposure_s));
    settings_.sequencer_in_loop().begun(start.begin_ns,
                                        clock_.monotonic_of_camera(start.camera_ns + length_ns));
}

bool FrameStarter::begin_free_run(const std::atomic<bool>& stopping, Start& start) {
    const std::int64_t arrived_ns = camera_now();
    if (idle_) schedule_.restart(arrived_ns);
    idle_ = false;
    if (paced_) {
        const FrameSchedule before = schedule_;
        FrameSchedule::Slot due = take_slot(arrived_ns);
        while (settings_.wait_for_news_until(when_begins(clock_, due.start_ns) - kLastStretch_ns)) {
            const CameraSettings& now = settings_.read_in_loop();
            if (stopping.load(std::memory_order_relaxed) || !now.running || now.triggered ||
                waits_for_poses())
                return false;
            // A new period counts from the last frame, so a waiting exposure begins at another time.
            schedule_ = before;
            due = take_slot(arrived_ns);
        }
        if (!sleep_until(due.start_ns, stopping)) {
            schedule_ = before;
            return false;
        }
        start.camera_ns = due.start_ns;
        start.skipped = due.skipped;
        start.settings = settings_.history_in_loop().at(due.start_ns);
    } else {
        start.camera_ns = arrived_ns;
    }
    use_sequencer(start);
    start.exposure_s = exposure_of(start.settings);
    start.period_ns = to_ns(timing_.period_s(start.settings.frame_rate_hz, start.exposure_s));
    return true;
}

// Takes the next exposure by the settings that hold when it begins. An exposure that was due before a change
// is still taken, and none is due before the change of rate that makes it due.
FrameSchedule::Slot FrameStarter::take_slot(std::int64_t arrived_ns) {
    const SettingsHistory::Held& held =
        settings_.history_in_loop().of_exposure([&](const CameraSettings& settings) {
            FrameSchedule trial = schedule_;
            return take_slot_by(settings, arrived_ns, trial).start_ns;
        });
    const FrameSchedule before = schedule_;
    const FrameSchedule::Slot slot = take_slot_by(held.settings, arrived_ns, schedule_);
    if (slot.start_ns >= held.from_ns) return slot;
    schedule_ = before;
    schedule_.restart(held.from_ns);
    return take_slot_by(held.settings, arrived_ns, schedule_);
}

// With prefers_newest_, a late exposure begins when it can, if it ends before the next one. A new raster
// begins if the detector was still busy when the next exposure was due, because the exposure was longer, or
// belonged to an order.
FrameSchedule::Slot FrameStarter::take_slot_by(const CameraSettings& settings, std::int64_t arrived_ns,
                                               FrameSchedule& schedule) const {
    const double exposure_s = exposure_of(settings);
    const std::int64_t period_ns = to_ns(timing_.period_s(settings.frame_rate_hz, exposure_s));
    const std::int64_t length_ns =
        to_ns(std::max(timing_.end_s(timing_.longest_exposure_s(exposure_s)), timing_.busy_s(exposure_s)));
    const std::int64_t may_move_ns = prefers_newest_ ? std::max(period_ns - length_ns, std::int64_t{0}) : 0;
    const FrameSchedule::Slot slot = schedule.take(arrived_ns, period_ns, may_move_ns);
    if (slot.start_ns >= over_ns_) return slot;
    schedule.restart(over_ns_);
    return schedule.take(arrived_ns, period_ns, may_move_ns);
}

bool FrameStarter::begin_ordered(const std::atomic<bool>& stopping, Start& start) {
    idle_ = true;  // when free-run resumes, it begins a new raster
    if (left_ == 0 && !take_order(start.settings, exposure_of(start.settings))) {
        settings_.wait_for_news();
        return false;
    }
    if (!lockstep_ && !wait_for_order(stopping)) return false;
    const SettingsHistory& history = settings_.history_in_loop();
    start.settings = lockstep_ ? history.newest() : history.at(next_ns_);
    start.camera_ns = next_ns_;
    use_sequencer(start);
    const bool by_width = order_.exposure_s > 0;
    start.exposure_s = by_width ? order_.exposure_s : exposure_of(start.settings);
    const std::int64_t period_ns = to_ns(timing_.period_s(start.settings.frame_rate_hz, start.exposure_s));
    if (lockstep_) {
        last_mid_ = clock_.simulated_of_camera(next_ns_ + to_ns(timing_.middle_s(start.exposure_s)));
        clock_.step_to(last_mid_);
        settings_.report_middle(last_mid_);
    } else {
        // The length of a pulse is known at its end, so its frame cannot be rendered before.
        start.late = camera_now() > next_ns_ + period_ns + (by_width ? to_ns(start.exposure_s) : 0);
        ready_ns_ = start.ready_camera_ns =
            next_ns_ + settings_.shortest_period_ns(start.settings.trigger_overlap, start.exposure_s);
        settings_.report_ready(ready_ns_, ready_ns_ + (left_ - 1) * period_ns);
    }
    next_ns_ += period_ns;
    start.trigger_sequence = order_.sequence;
    start.ends_order = --left_ == 0;
    return true;
}

// Takes an order. In lockstep the camera's time is simulated time.
bool FrameStarter::take_order(const CameraSettings& settings, double exposure_s) {
    if (!settings_.take_trigger(order_)) return false;
    left_ = order_.frames;
    order_begun_ = false;
    if (!lockstep_) return true;
    const std::int64_t to_middle_ns = to_ns(timing_.middle_s(exposure_s));
    if (order_.at_simulated.ns != 0)
        next_ns_ = order_.at_simulated.ns - to_middle_ns;
    else if (last_mid_.ns != 0)
        next_ns_ = last_mid_.ns + to_ns(timing_.period_s(settings.frame_rate_hz, exposure_s)) - to_middle_ns;
    else
        next_ns_ = clock_.start().ns;
    return true;
}

// Returns the order's begin as the clock runs now; it may change while the order waits.
std::int64_t FrameStarter::begin_of_order() const {
    if (order_.at_simulated.ns == 0) return clock_.camera_at(order_.at_monotonic_ns) + order_.delay_ns;
    const std::int64_t due_ns = clock_.camera_of(order_.at_simulated);
    return due_ns == SimulatedClock::kNever_ns ? due_ns : due_ns + order_.delay_ns;
}

// Returns false when something else comes first. The order then continues to wait, unless it is dropped.
bool FrameStarter::wait_for_order(const std::atomic<bool>& stopping) {
    if (!order_begun_) next_ns_ = std::max(begin_of_order(), over_ns_);
    const std::int64_t not_before_ns = order_begun_ ? 0 : order_.at_monotonic_ns;
    const std::int64_t due_ns = std::max(when_begins(clock_, next_ns_), not_before_ns);
    if (settings_.wait_for_news_until(due_ns - kLastStretch_ns)) return false;
    if (!sleep_until(next_ns_, stopping)) return false;
    order_begun_ = true;
    return true;
}

void FrameStarter::forget_orders() {
    if (left_ > 0) settings_.order_done();
    left_ = 0;
    while (settings_.take_trigger(order_)) settings_.order_done();
    if (!lockstep_) settings_.report_ready(ready_ns_, ready_ns_);
}

void FrameStarter::forget_dropped() {
    bool any = left_ > 0 && settings_.is_dropped(order_);
    if (any) settings_.order_done(), left_ = 0;
    for (; settings_.take_dropped(); any = true) settings_.order_done();
    if (any) settings_.report_ready(ready_ns_, ready_ns_);
}

// Returns false when stopping, or when the camera will not reach the time as the clock runs now.
bool FrameStarter::sleep_until(std::int64_t camera_ns, const std::atomic<bool>& stopping) const {
    for (;;) {
        const std::int64_t now_ns = monotonic_ns(), due_ns = when_begins(clock_, camera_ns);
        if (due_ns == SimulatedClock::kNever_ns || stopping.load(std::memory_order_relaxed)) return false;
        if (clock_.camera_at(now_ns) >= camera_ns) return true;
        sleep_until_monotonic_ns(std::min(std::max(due_ns, now_ns + 1'000), now_ns + kLongestSleep_ns));
    }
}

}  // namespace hilcam
