#include "io/lines/trigger_input.h"

#include <algorithm>

namespace hilcam {

// Counts an edge to that level; true when it is a trigger.
bool TriggerInput::is_trigger(const CameraSettings& s, bool level) {
    const bool as_before = s.trigger_source == of_.trigger_source && s.triggered == of_.triggered &&
                           s.trigger_activation == of_.trigger_activation &&
                           s.trigger_divider == of_.trigger_divider && s.running == of_.running;
    if (!as_before) seen_ = 0;
    of_ = s;
    if (!is_active_edge(s.trigger_activation, level)) return false;
    if (++seen_ < s.trigger_divider) return false;
    seen_ = 0;
    return true;
}

void TriggerInput::edge(const LineEdge& edge) {
    if (open_ && edge.line == begin_.line && edge.level != begin_.level) end_exposure(edge.monotonic_ns);
    const CameraSettings s = camera_.settings();
    if (!s.triggered || line_of(s.trigger_source) != edge.line) return;
    if (is_level(s.trigger_activation))
        return is_active_edge(s.trigger_activation, edge.level) ? begin_level(edge) : end_level();
    if (!is_trigger(s, edge.level)) return;
    if (exposes_by_width(s)) return begin_exposure(edge, s);
    TriggerOrder order;
    order.source = s.trigger_source;
    order.at_monotonic_ns = edge.monotonic_ns;
    order.sequence = edge.sequence;
    camera_.trigger(order);
}

TriggerResult TriggerInput::pulse(const TriggerOrder& asked) {
    const CameraSettings s = camera_.settings();
    if (!s.triggered || s.trigger_source != TriggerSource::kLine0) return camera_.trigger(asked);
    // A pulse without length is a high level for one frame, and no low level.
    if (s.trigger_activation == TriggerActivation::kLevelLow) return TriggerResult::kTaken;
    if (s.trigger_activation == TriggerActivation::kLevelHigh) return camera_.trigger(asked);
    TriggerOrder order = asked;
    const bool by_width = exposes_by_width(s) && order.frames <= 1;
    if (by_width) order.until_monotonic_ns = order.at_monotonic_ns;
    TriggerResult result = TriggerResult::kTaken;
    for (const bool level : {true, false})
        if (is_trigger(s, level)) result = camera_.trigger(order);
    if (by_width && result == TriggerResult::kTaken) {
        const std::int64_t begin_ns = camera_.monotonic_after(order.at_monotonic_ns, s.trigger_delay_s);
        exposes_({begin_ns, camera_.monotonic_after(begin_ns, camera_.limits().min_exposure_s), false});
    }
    return result;
}

// An exposure that begins too early is ordered as well, at its end: the camera then says that it was missed.
void TriggerInput::begin_exposure(const LineEdge& edge, const CameraSettings& s) {
    if (open_) return;
    open_ = true;
    begin_ = edge;
    shows_ = camera_.trigger_ready_ns() <= edge.monotonic_ns;
    longest_ns_ = camera_.monotonic_after(edge.monotonic_ns, camera_.limits().max_exposure_s);
    exposure_ns_ = camera_.monotonic_after(edge.monotonic_ns, s.trigger_delay_s);
    if (shows_) exposes_({exposure_ns_, 0, false});
}

void TriggerInput::end_exposure(std::int64_t at_ns) {
    open_ = false;
    TriggerOrder order;
    order.source = source_of_line(begin_.line);
    order.at_monotonic_ns = begin_.monotonic_ns;
    order.until_monotonic_ns = std::max(at_ns, begin_.monotonic_ns + 1);
    order.sequence = begin_.sequence;
    const TriggerResult result = camera_.trigger(order);
    if (!shows_) return;
    const std::int64_t shortest_ns =
        camera_.monotonic_after(begin_.monotonic_ns, camera_.limits().min_exposure_s);
    const bool taken = result == TriggerResult::kTaken;
    const std::int64_t end_ns = taken ? std::max(order.until_monotonic_ns, shortest_ns) : at_ns;
    exposes_({exposure_ns_, camera_.monotonic_after(end_ns, of_.trigger_delay_s), !taken});
}

void TriggerInput::tick(std::int64_t now_ns) {
    if (open_ && now_ns >= longest_ns_) end_exposure(longest_ns_);
    if (now_ns >= next_ns_) take_by_level();
}

// --- levels

void TriggerInput::begin_level(const LineEdge& edge) {
    level_ = edge;
    next_ns_ = edge.monotonic_ns;
}

void TriggerInput::follow(const std::array<bool, kLines>& levels, std::int64_t now_ns) {
    const CameraSettings s = camera_.settings();
    const std::size_t line = line_of(s.trigger_source);
    watches_level_ = is_level(s.trigger_activation) && s.triggered && line < kLines;
    const bool wanted = watches_level_ && s.running &&
                        levels[line] == (s.trigger_activation == TriggerActivation::kLevelHigh);
    if (holds() && (!wanted || level_.line != line)) end_level();
    if (wanted && !holds()) begin_level({static_cast<std::uint8_t>(line), levels[line], now_ns, 0});
}

// Takes the frame that is due, or waits until the camera is ready: a level misses no trigger.
void TriggerInput::take_by_level() {
    const std::int64_t ready_ns = camera_.trigger_ready_ns();
    if (ready_ns == CameraControl::kNeverReady_ns) return end_level();  // follow() begins it again
    if (ready_ns > next_ns_) {
        next_ns_ = ready_ns;
        return;
    }
    const CameraSettings s = camera_.settings();
    TriggerOrder order;
    order.source = s.trigger_source;
    order.at_monotonic_ns = next_ns_;
    order.sequence = level_.sequence;
    camera_.trigger(order);
    next_ns_ = camera_.monotonic_after(next_ns_, static_cast<double>(s.burst_frames) / s.frame_rate_hz);
}

}  // namespace hilcam
