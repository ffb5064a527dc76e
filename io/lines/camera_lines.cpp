#include "io/lines/camera_lines.h"

#include <algorithm>

#include "io/lines/sequencer.h"
#include "io/system/monotonic.h"

namespace hilcam {

CameraLines::CameraLines(CameraControl& camera, const LinePlan& plan)
    : camera_(camera),
      sequencer_(camera.sequencer()),
      plan_(plan),
      trigger_(camera, [this](const TriggerInput::Exposure& exposure) {
          const Span span{exposure.begin_ns, exposure.end_ns == 0 ? kNever_ns : exposure.end_ns};
          if (!know_end(span)) expect_exposure(span);
          if (exposure.lost) frame_active_ = false;
      }) {
    settings_.source = plan.source;
    settings_.inverted = plan.inverted;
    to_come_.reserve(kMaxEdgesToCome);
    out_.reserve(kMaxOut);
    exposures_to_come_.reserve(kMaxEdgesToCome);
    for (std::size_t i = 0; i < kLines; ++i) wire_[i] = level_[i] = plan.is_output[i] && plan.inverted[i];
    for (std::size_t i = 0; i < kLines; ++i)
        if (plan.is_there[i] && !plan.is_output[i]) level_[i] = plan.inverted[i];
    know_listening();
}

// --- inputs

bool CameraLines::edge(const LineEdge& edge, std::int64_t now_ns) {
    if (edge.line >= kLines || !plan_.is_there[edge.line] || plan_.is_output[edge.line]) return false;
    {
        const std::lock_guard lock(mutex_);
        if (edge.monotonic_ns > now_ns) {
            if (to_come_.size() == kMaxEdgesToCome) return false;
            const auto later = [](const LineEdge& a, const LineEdge& b) {
                return a.monotonic_ns < b.monotonic_ns;
            };
            to_come_.insert(std::upper_bound(to_come_.begin(), to_come_.end(), edge, later), edge);
        } else {
            step_until(edge.monotonic_ns);
            take_edge(edge);
            step_until(edge.monotonic_ns);
            settle(edge.monotonic_ns);
        }
    }
    if (wake_) wake_();
    return true;
}

void CameraLines::take_edge(const LineEdge& edge) {
    if (wire_[edge.line] == edge.level) return;
    wire_[edge.line] = edge.level;
    LineEdge own = edge;
    own.level = edge.level != settings_.inverted[edge.line];
    level_[edge.line] = own.level;
    trigger_.edge(own);
    fire(event_of_line(own.line), own.level, own.monotonic_ns);
    if (tell_) tell_(own);
}

TriggerResult CameraLines::pulse(const TriggerOrder& order) {
    const std::lock_guard lock(mutex_);
    const TriggerResult result = trigger_.pulse(order);
    for (const bool level : {!settings_.inverted[0], settings_.inverted[0]}) {
        fire(event_of_line(0), level, order.at_monotonic_ns);
        if (tell_) tell_({0, level, order.at_monotonic_ns, order.sequence});
    }
    settle(order.at_monotonic_ns);
    if (wake_) wake_();
    return result;
}

// --- events of the camera

void CameraLines::post(const Happening& happening) noexcept {
    if (!listening_.load(std::memory_order_relaxed)) return;
    if (!posts_.push(happening)) lost_.fetch_add(1, std::memory_order_relaxed);
    if (wake_) wake_();
}

// The exposures of pulses are known from their edges, before the loop has them, and those of triggers mostly
// as well.
void CameraLines::take(const Happening& h) {
    if (h.event == LineEvent::kOff) return exposures_to_come_.clear();
    if (h.event == LineEvent::kFrameEnd) frame_active_ = false;
    if (h.event != LineEvent::kExposureStart) return fire(h.event, true, h.at_ns);
    if (exposes_by_width(camera_.settings())) return;
    const Span exposure{h.at_ns, h.end_ns};
    // The trigger's post and the loop's of one exposure come in any order.
    if (std::find(known_.begin(), known_.end(), h.at_ns) != known_.end())
        return static_cast<void>(know_end(exposure));
    known_[known_count_++ % known_.size()] = h.at_ns;
    expect_exposure(exposure);
}

void CameraLines::expect_exposure(const Span& exposure) {
    const auto later = [](const Span& a, const Span& b) { return a.begin_ns < b.begin_ns; };
    exposures_to_come_.insert(
        std::upper_bound(exposures_to_come_.begin(), exposures_to_come_.end(), exposure, later), exposure);
}

// Sets the end of the exposure with that begin, if it has not ended; false when there is none.
bool CameraLines::know_end(const Span& exposure) {
    if (exposing_ && exposure_.begin_ns == exposure.begin_ns) return exposure_.end_ns = exposure.end_ns, true;
    for (Span& span : exposures_to_come_)
        if (span.begin_ns == exposure.begin_ns) return span.end_ns = exposure.end_ns, true;
    return false;
}

// A counter counts one event, so that ends of counters cannot follow each other in a circle.
void CameraLines::fire(LineEvent event, bool rises, std::int64_t at_ns) {
    if (event == LineEvent::kOff) return;
    if (sequencer_) sequencer_->post(event, rises, at_ns);
    for (std::size_t i = 0; i < kTimers; ++i) timers_[i].take(settings_.timers[i], event, rises, at_ns);
    for (std::size_t i = 0; i < kCounters; ++i)
        if (counters_[i].take(settings_.counters[i], event, rises)) fire(end_of_counter(i), true, at_ns);
}

// --- time

std::int64_t CameraLines::next_ns() const {
    std::int64_t next_ns =
        std::min({trigger_.wake_ns(), exposing_ ? exposure_.end_ns : kNever_ns,
                  exposures_to_come_.empty() ? kNever_ns : exposures_to_come_.front().begin_ns,
                  to_come_.empty() ? kNever_ns : to_come_.front().monotonic_ns});
    for (const LineTimer& timer : timers_) next_ns = std::min(next_ns, timer.next_ns());
    return next_ns;
}

// Makes the earliest change that is due; false when none is.
bool CameraLines::step(std::int64_t now_ns) {
    const std::int64_t at_ns = next_ns();
    if (at_ns == kNever_ns || at_ns > now_ns) return false;
    // An edge comes first: it may end the level that a frame is due for.
    if (!to_come_.empty() && at_ns == to_come_.front().monotonic_ns) {
        const LineEdge edge = to_come_.front();
        to_come_.erase(to_come_.begin());
        take_edge(edge);
    } else if (at_ns == trigger_.wake_ns()) {
        trigger_.tick(at_ns);
    } else if (exposing_ && at_ns == exposure_.end_ns) {
        exposing_ = false;
        fire(LineEvent::kExposureEnd, true, at_ns);
    } else if (!exposures_to_come_.empty() && at_ns == exposures_to_come_.front().begin_ns) {
        const Span next = exposures_to_come_.front();
        exposures_to_come_.erase(exposures_to_come_.begin());
        // A rolling shutter's next exposure may begin before the end of the one before.
        exposure_ = {next.begin_ns, exposing_ ? std::max(exposure_.end_ns, next.end_ns) : next.end_ns};
        exposing_ = frame_active_ = true;
        fire(LineEvent::kFrameStart, true, at_ns);
        fire(LineEvent::kExposureStart, true, at_ns);
    } else {
        for (std::size_t i = 0; i < kTimers; ++i)
            if (timers_[i].next_ns() == at_ns && timers_[i].step()) fire(end_of_timer(i), true, at_ns);
    }
    settle(at_ns);
    return true;
}

void CameraLines::step_until(std::int64_t now_ns) {
    while (step(now_ns)) {
    }
}

void CameraLines::tick(std::int64_t now_ns) {
    const std::lock_guard lock(mutex_);
    ticked_ns_ = now_ns;
    for (Happening happening; posts_.pop(happening);) {
        step_until(std::min(now_ns, happening.at_ns));
        take(happening);
        settle(happening.at_ns);
    }
    trigger_.follow(level_, now_ns);
    step_until(now_ns);
    settle(now_ns);
}

std::int64_t CameraLines::wake_ns() const {
    const std::lock_guard lock(mutex_);
    // The camera does not say when it begins or ceases to listen to triggers.
    const bool polls = uses(LineSignal::kFrameTriggerWait) || trigger_.watches_level();
    return polls ? std::min(next_ns(), ticked_ns_ + kPoll_ns) : next_ns();
}

// --- outputs

bool CameraLines::level_of(LineSignal signal, std::int64_t at_ns) const {
    switch (signal) {
        case LineSignal::kOff:
            break;
        case LineSignal::kExposureActive:
            return exposing_;
        case LineSignal::kFrameTriggerWait:
            return !trigger_.exposes() && camera_.trigger_ready_ns() <= at_ns;
        case LineSignal::kFrameActive:
            return frame_active_;
        case LineSignal::kCounter0Active:
        case LineSignal::kCounter1Active: {
            const auto i =
                static_cast<std::size_t>(signal) - static_cast<std::size_t>(LineSignal::kCounter0Active);
            return counters_[i].status(settings_.counters[i]) == LineCounter::Status::kActive;
        }
        case LineSignal::kTimer0Active:
        case LineSignal::kTimer1Active:
            return timers_[static_cast<std::size_t>(signal) -
                           static_cast<std::size_t>(LineSignal::kTimer0Active)]
                .active();
        case LineSignal::kUserOutput0:
        case LineSignal::kUserOutput1:
        case LineSignal::kUserOutput2:
        case LineSignal::kUserOutput3:
            return settings_.user_outputs >>
                       (static_cast<unsigned>(signal) - static_cast<unsigned>(LineSignal::kUserOutput0)) &
                   1u;
    }
    return false;
}

// Lets the outputs follow what has just changed.
void CameraLines::settle(std::int64_t at_ns) {
    for (std::size_t i = 0; i < kLines; ++i) {
        if (!plan_.is_output[i]) continue;
        const bool level = level_of(settings_.source[i], at_ns) != settings_.inverted[i];
        if (level == level_[i]) continue;
        level_[i] = wire_[i] = level;
        if (out_.size() < kMaxOut) out_.push_back({static_cast<std::uint8_t>(i), level, at_ns, 0});
    }
}

bool CameraLines::take_output(LineEdge& edge) {
    const std::lock_guard lock(mutex_);
    if (out_.empty()) return false;
    edge = out_.front();
    out_.erase(out_.begin());
    return true;
}

bool CameraLines::uses(LineSignal signal) const {
    for (std::size_t i = 0; i < kLines; ++i)
        if (plan_.is_output[i] && settings_.source[i] == signal) return true;
    return false;
}

// Finds out whether the loop's events matter to anything.
void CameraLines::know_listening() {
    bool listens = uses(LineSignal::kExposureActive) || uses(LineSignal::kFrameActive) ||
                   uses(LineSignal::kFrameTriggerWait);
    for (const LineCounter::Settings& s : settings_.counters)
        listens = listens || s.event != LineEvent::kOff || s.reset != LineEvent::kOff;
    for (const LineTimer::Settings& s : settings_.timers) listens = listens || s.trigger != LineEvent::kOff;
    listening_.store(listens, std::memory_order_relaxed);
}

// --- registers

LineSettings CameraLines::settings() const {
    const std::lock_guard lock(mutex_);
    return settings_;
}

void CameraLines::change(const LineSettings& settings, std::int64_t now_ns) {
    {
        const std::lock_guard lock(mutex_);
        settings_ = settings;
        for (std::size_t i = 0; i < kLines; ++i)
            if (plan_.is_there[i] && !plan_.is_output[i]) level_[i] = wire_[i] != settings_.inverted[i];
        know_listening();
        settle(now_ns);
    }
    if (wake_) wake_();
}

std::uint32_t CameraLines::levels() const {
    const std::lock_guard lock(mutex_);
    std::uint32_t bits = 0;
    for (std::size_t i = 0; i < kLines; ++i)
        if (plan_.is_there[i] && level_[i]) bits |= 1u << i;
    return bits;
}

LineCounter CameraLines::counter(std::size_t i) const {
    const std::lock_guard lock(mutex_);
    return counters_[i];
}

LineTimer CameraLines::timer(std::size_t i) const {
    const std::lock_guard lock(mutex_);
    return timers_[i];
}

void CameraLines::reset_counter(std::size_t i, std::int64_t now_ns) {
    const std::lock_guard lock(mutex_);
    counters_[i].reset();
    settle(now_ns);
    if (wake_) wake_();
}

void CameraLines::set_counter(std::size_t i, std::uint32_t value) {
    const std::lock_guard lock(mutex_);
    counters_[i].set_value(value);
}

void CameraLines::start_timer(std::size_t i, std::int64_t now_ns) {
    const std::lock_guard lock(mutex_);
    timers_[i].start(settings_.timers[i], now_ns);
    if (wake_) wake_();
}

// --- the loop's events

void LineWatch::publish(const DnImage&, const FrameRecord&) noexcept {
    lines_.post({LineEvent::kFrameEnd, monotonic_ns(), 0});
}

void LineWatch::on_event(const CameraEvent& event) noexcept {
    switch (event.kind) {
        case CameraEvent::Kind::kExposureStart:
            return lines_.post({LineEvent::kExposureStart, event.monotonic_ns, event.end_ns});
        case CameraEvent::Kind::kTriggerMissed:
            return lines_.post({LineEvent::kFrameTriggerMissed, event.monotonic_ns, 0});
        default:
            return;  // the end is known from the begin
    }
}

}  // namespace hilcam
