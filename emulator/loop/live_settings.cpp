#include "emulator/loop/live_settings.h"

#include <algorithm>
#include <cmath>

#include "io/system/wire_format.h"

namespace hilcam {

namespace {

constexpr std::int64_t kMaxBinning = 8;

// Returns a clock that runs like the machine's own, so that all three times are the same.
const SimulatedClock& machine_clock() {
    static const SimulatedClock clock({0}, 0);
    return clock;
}

CameraLimits limits_of(const CameraModel& c, const LiveSettings::Mode& mode) {
    const auto [width, height] = array_size(c);
    CameraLimits limits;
    limits.width = width, limits.height = height;
    limits.bits = c.frame_bits();
    limits.color_pattern = bayer_pattern_of(c);
    limits.min_exposure_s = c.exposure_range_s[0], limits.max_exposure_s = c.exposure_range_s[1];
    limits.min_gain_db = c.gain_range_db[0], limits.max_gain_db = c.gain_range_db[1];
    limits.min_frame_rate_hz = c.frame_rate_range_hz[0];
    limits.max_frame_rate_hz = c.frame_rate_range_hz[1];
    limits.max_black_level_dn = std::exp2(static_cast<double>(c.bits)) / 4;
    limits.temperature_c = c.temperature_c;
    limits.lockstep = mode.lockstep;
    // A mirrored or binned colour filter array would have another pattern.
    limits.reversible = c.color_filter.pattern.empty();
    if (c.color_filter.pattern.empty() && !mode.fixed_size)
        while (limits.max_binning < kMaxBinning &&
               2 * limits.max_binning * 4 <= std::min(limits.width, limits.height))
            limits.max_binning *= 2;
    const ShutterTiming timing(c);
    limits.exposure_is_own = timing.is_fixed() || !c.sequence.empty();
    limits.gain_is_own = !c.sequence.empty();
    limits.frame_rate_is_own = timing.is_fixed();
    limits.has_automatic_exposure = !limits.exposure_is_own;
    limits.has_sequencer = !limits.exposure_is_own && !limits.gain_is_own;
    if (timing.is_fixed()) {
        limits.min_exposure_s = limits.max_exposure_s = timing.exposure_s(c.exposure_s);
        limits.min_frame_rate_hz = limits.max_frame_rate_hz = 1 / timing.period_s(0, 0);
    }
    return limits;
}

CameraSettings at_power_up(const CameraModel& c, const LiveSettings::Mode& mode) {
    const ShutterTiming timing(c);
    CameraSettings s;
    s.exposure_s = timing.exposure_s(c.exposure_s);
    s.gain_db = c.gain_db;
    s.black_level_dn = c.offset_dn;
    s.frame_rate_hz = timing.is_fixed() ? 1 / timing.period_s(0, 0) : c.frame_rate_hz;
    s.automatic_exposure = c.auto_exposure.on;
    s.triggered = mode.triggered || mode.lockstep;
    if (s.triggered) s.trigger_source = TriggerSource::kLine0;
    s.binning_x = c.binning_x, s.binning_y = c.binning_y;
    return s;
}

bool inside(double value, double least, double most) { return value >= least && value <= most; }

}  // namespace

LiveSettings::LiveSettings(const CameraModel& c, const Mode& mode)
    : limits_(limits_of(c, mode)),
      timing_(c),
      clock_(&machine_clock()),
      settings_(at_power_up(c, mode)),
      history_(settings_),
      latest_(history_),
      own_exposure_s_(settings_.exposure_s),
      own_gain_db_(settings_.gain_db) {}

CameraSettings LiveSettings::settings() const {
    const std::lock_guard lock(mutex_);
    CameraSettings now = settings_;
    now.exposure_s = exposure_now_s();
    if (limits_.gain_is_own) now.gain_db = own_gain_db_.load(std::memory_order_relaxed);
    return now;
}

double LiveSettings::resulting_frame_rate_hz() const {
    const CameraSettings now = settings();
    return 1 / timing_.period_s(now.frame_rate_hz, std::max(now.exposure_s, sequencer_.longest_exposure_s()));
}

// Called under the lock.
double LiveSettings::exposure_now_s() const {
    const bool own = limits_.exposure_is_own || settings_.automatic_exposure;
    return own ? own_exposure_s_.load(std::memory_order_relaxed) : settings_.exposure_s;
}

// Returns the longest exposure that the next frame may have: the loop chooses its set when it begins. Called
// under the lock.
double LiveSettings::longest_exposure_s() const {
    const double of_sets_s = sequencer_.longest_exposure_s();
    return of_sets_s > 0 ? of_sets_s : exposure_now_s();
}

bool LiveSettings::fits(const CameraSettings& w, const SettingsChange& c) const {
    const CameraLimits& l = limits_;
    if (c.exposure_s && (l.exposure_is_own || w.automatic_exposure)) return false;
    if (c.gain_db && l.gain_is_own) return false;
    if (c.frame_rate_hz && l.frame_rate_is_own) return false;
    if (w.automatic_exposure && (!l.has_automatic_exposure || sequencer_.on())) return false;
    if ((w.reverse_x || w.reverse_y) && !l.reversible) return false;
    if (l.lockstep && !w.triggered) return false;
    if (w.exposure_mode == ExposureMode::kTriggerWidth &&
        (!l.has_trigger_width() || w.automatic_exposure ||
         w.trigger_activation == TriggerActivation::kAnyEdge || is_level(w.trigger_activation)))
        return false;
    if (is_level(w.trigger_activation) && !l.has_trigger_levels()) return false;
    if (w.trigger_overlap == TriggerOverlap::kOff && !l.can_wait_for_readout()) return false;
    if (w.trigger_divider < 1 || w.trigger_divider > l.max_trigger_divider) return false;
    const auto binning_fits = [&](const std::optional<std::int64_t>& b) {
        return !b || (*b >= 1 && *b <= l.max_binning && (*b & (*b - 1)) == 0);
    };
    return inside(w.exposure_s, l.min_exposure_s, l.max_exposure_s) &&
           inside(w.gain_db, l.min_gain_db, l.max_gain_db) &&
           (!c.black_level_dn || inside(w.black_level_dn, 0, l.max_black_level_dn)) &&
           inside(w.frame_rate_hz, l.min_frame_rate_hz, l.max_frame_rate_hz) &&
           inside(w.trigger_delay_s, 0, l.max_trigger_delay_s) && w.burst_frames >= 1 &&
           w.burst_frames <= l.max_burst_frames && binning_fits(c.binning_x) && binning_fits(c.binning_y);
}

bool LiveSettings::takes(const SettingsChange& c) const {
    const std::lock_guard lock(mutex_);
    CameraSettings wanted = settings_;
    apply(c, wanted);
    return fits(wanted, c);
}

bool LiveSettings::change(const SettingsChange& c) { return change(c, clock_->camera_at(monotonic_ns())); }

bool LiveSettings::change(const SettingsChange& c, std::int64_t from_camera_ns) {
    const std::lock_guard lock(mutex_);
    CameraSettings wanted = settings_;
    apply(c, wanted);
    if (!fits(wanted, c)) return false;
    // When automatic exposure is switched off, the camera keeps the exposure that it found.
    if (settings_.automatic_exposure && !wanted.automatic_exposure && !c.exposure_s)
        wanted.exposure_s = own_exposure_s_.load(std::memory_order_relaxed);
    settings_ = wanted;
    if (!limits_.lockstep && (!wanted.running || !wanted.triggered)) {
        dropped_below_.store(triggers_in_.load(std::memory_order_relaxed), std::memory_order_release);
        if (exposes_) exposes_(0, 0);
    }
    history_.add(settings_, from_camera_ns);
    latest_.write(history_);
    if (changed_) changed_(c);
    wake();
    return true;
}

TriggerResult LiveSettings::trigger(const TriggerOrder& asked) {
    const std::lock_guard lock(mutex_);
    const TriggerResult result = take_order(asked);
    if (triggered_) triggered_(asked, result);
    return result;
}

// Called under the lock.
TriggerResult LiveSettings::take_order(const TriggerOrder& asked) {
    if (closed_.load() || !settings_.running || !settings_.triggered) return TriggerResult::kNotArmed;
    if (asked.source != (limits_.lockstep ? TriggerSource::kLine0 : settings_.trigger_source))
        return TriggerResult::kNotArmed;
    if (poses_ && poses_->stops(clock_->now())) return TriggerResult::kNotArmed;
    WaitingOrder order{asked};
    if (order.frames == 0) order.frames = settings_.burst_frames;
    const std::uint64_t in = triggers_in_.load(std::memory_order_relaxed);
    if (limits_.lockstep && order.at_simulated.ns != 0) {
        const std::int64_t newest_ns = newest_middle_ns_.load(std::memory_order_relaxed);
        if (!order.at_any_time && newest_ns != 0 && order.at_simulated.ns <= newest_ns)
            return TriggerResult::kTooEarly;
    }
    bool missed = in - triggers_out_.load(std::memory_order_acquire) == kMaxWaiting;
    if (!limits_.lockstep) {
        const std::int64_t now_ns = monotonic_ns();
        if (order.at_monotonic_ns == 0) order.at_monotonic_ns = now_ns;
        order.delay_ns = static_cast<std::int64_t>(settings_.trigger_delay_s * 1e9);
        if (order.until_monotonic_ns != 0 && order.frames == 1) order.exposure_s = exposure_of(order);
        const std::int64_t due_ns = camera_time_of(order, now_ns) + order.delay_ns;
        missed = missed || due_ns < ready_ns(in, now_ns);
        if (missed && missed_) missed_(now_ns);
    }
    if (missed) return TriggerResult::kMissed;
    order.number = in;
    newest_order_ = order;
    triggers_[in % kMaxWaiting] = order;
    triggers_in_.store(in + 1, std::memory_order_release);
    wake();
    if (exposes_) tell_exposure(order, monotonic_ns());
    return TriggerResult::kTaken;
}

// The exposure of a pulse is over, that of a trigger in simulated time depends on the clock, and a
// sequencer's on the set that is active then.
void LiveSettings::tell_exposure(const WaitingOrder& order, std::int64_t now_ns) const {
    if (limits_.lockstep || order.frames != 1 || order.exposure_s > 0 || order.at_simulated.ns != 0) return;
    if (sequencer_.on()) return;
    const std::int64_t begin_ns = camera_time_of(order, now_ns) + order.delay_ns;
    const std::int64_t end_ns = begin_ns + to_ns(timing_.end_s(exposure_now_s()));
    exposes_(clock_->monotonic_of_camera(begin_ns), clock_->monotonic_of_camera(end_ns));
}

// Returns the exposure for a pulse's width.
double LiveSettings::exposure_of(const TriggerOrder& order) const {
    const std::int64_t width_ns =
        clock_->camera_at(order.until_monotonic_ns) - clock_->camera_at(order.at_monotonic_ns);
    return std::clamp(static_cast<double>(width_ns) * 1e-9, limits_.min_exposure_s, limits_.max_exposure_s);
}

std::int64_t LiveSettings::trigger_ready_ns() const {
    const std::lock_guard lock(mutex_);
    if (closed_.load() || limits_.lockstep || !settings_.running || !settings_.triggered)
        return kNeverReady_ns;
    if (poses_ && poses_->stops(clock_->now())) return kNeverReady_ns;
    const std::uint64_t in = triggers_in_.load(std::memory_order_relaxed);
    const std::int64_t ready_camera_ns = ready_ns(in, monotonic_ns());
    if (ready_camera_ns == std::numeric_limits<std::int64_t>::min()) return 0;
    return clock_->monotonic_of_camera(ready_camera_ns - to_ns(settings_.trigger_delay_s));
}

TriggerResult LiveSettings::order_in_lockstep(const TriggerOrder& order) {
    done_.take_all();  // orders that clients have given up
    const TriggerResult result = trigger(order);
    ordered_ = result == TriggerResult::kTaken;
    return result;
}

bool LiveSettings::wait_for_order(double patience_s) {
    if (!ordered_) return true;
    ordered_ = false;
    // An order may arrive just after the loop has looked for the last time; then nothing answers it.
    const std::int64_t until_ns = monotonic_ns() + static_cast<std::int64_t>(patience_s * 1e9);
    while (!done_.try_acquire_for(kLongestWait_ns)) {
        if (closed_.load()) return true;
        if (monotonic_ns() >= until_ns) return false;
    }
    return true;
}

// Returns the order's time in the camera's time if time goes on as it does now.
std::int64_t LiveSettings::camera_time_of(const TriggerOrder& order, std::int64_t now_ns) const {
    if (order.at_simulated.ns == 0) return clock_->camera_at(order.at_monotonic_ns);
    return clock_->camera_at(now_ns) + (order.at_simulated - clock_->at(now_ns));
}

// Returns when the camera will have finished all accepted orders, in the camera's time. Called under the
// lock, so that none is added meanwhile.
std::int64_t LiveSettings::ready_ns(std::uint64_t orders, std::int64_t now_ns) const {
    const bool none_waits = orders_begun_.load(std::memory_order_acquire) == orders;
    if (dropped_below_.load(std::memory_order_relaxed) == orders)
        return frame_ready_ns_.load(std::memory_order_relaxed);
    if (none_waits) return order_ready_ns_.load(std::memory_order_relaxed);
    const double exposure_s = newest_order_.exposure_s > 0 ? newest_order_.exposure_s : longest_exposure_s();
    const std::int64_t period_ns = to_ns(timing_.period_s(settings_.frame_rate_hz, exposure_s));
    return camera_time_of(newest_order_, now_ns) + newest_order_.delay_ns +
           (newest_order_.frames - 1) * period_ns + shortest_period_ns(settings_.trigger_overlap, exposure_s);
}

bool LiveSettings::take_trigger(WaitingOrder& order) {
    const std::uint64_t out = triggers_out_.load(std::memory_order_relaxed);
    if (out == triggers_in_.load(std::memory_order_acquire)) return false;
    order = triggers_[out % kMaxWaiting];
    triggers_out_.store(out + 1, std::memory_order_release);
    return true;
}

bool LiveSettings::take_dropped() {
    const std::uint64_t out = triggers_out_.load(std::memory_order_relaxed);
    if (out >= dropped_below_.load(std::memory_order_acquire)) return false;
    triggers_out_.store(out + 1, std::memory_order_release);
    return true;
}

bool LiveSettings::wait_for_news_until(std::int64_t until_ns) {
    const std::int64_t now_ns = monotonic_ns();
    if (now_ns >= until_ns) return false;
    static_cast<void>(news_.try_acquire_until(std::min(until_ns, now_ns + kLongestWait_ns)));
    news_.take_all();
    return monotonic_ns() < until_ns;
}

}  // namespace hilcam
