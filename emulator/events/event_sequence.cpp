#include "emulator/events/event_sequence.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "render/vocabulary/check.h"
#include "render/vocabulary/quoted.h"
#include "render/vocabulary/time.h"

namespace hilcam {
namespace {

[[noreturn]] void fail(std::size_t index, const EventConfig& config, const std::string& what) {
    throw KeyError("events." + std::to_string(index),
                   (config.name.empty() ? "" : in_quotes(config.name) + ": ") + what);
}

}  // namespace

EventSequence::EventSequence(std::span<const EventConfig> events, const EventWorld& world, TimeTai start)
    : start_(start) {
    const auto named = [&](const std::string& name) {
        return std::find_if(events.begin(), events.end(),
                            [&](const EventConfig& e) { return e.name == name; });
    };
    for (std::size_t i = 0; i < events.size(); ++i) {
        const EventConfig& config = events[i];
        Event event;
        event.config = config;
        const auto first = static_cast<std::size_t>(named(config.name) - events.begin());
        if (!config.name.empty() && first != i) fail(i, config, "another event has that name");
        try {
            event.actions = actions_of(config);
            if (config.has_when) event.condition.emplace(config.when, world);
        } catch (const InputError& error) {
            fail(i, config, error.what());
        }
        if (config.has_after) {
            const auto other = named(config.after);
            if (config.after.empty() || other == events.end())
                fail(i, config, "after: there is no event " + in_quotes(config.after));
            event.after = static_cast<std::size_t>(other - events.begin());
            if (*event.after == i) fail(i, config, "after: itself, so it would never happen");
        }
        if (config.has_at_s) event.due = {start + to_ns(config.at_s)};
        if (config.has_at_utc) event.due = {parse_utc(config.at_utc)};
        events_.push_back(std::move(event));
    }
}

void EventSequence::saw(const SeenFrame& frame, const WorldSnapshot& world) {
    seen_ = frame;
    if (frame.dark) return;
    for (Event& e : events_) {
        if (!e.condition) continue;
        const bool holds = e.condition->holds(world);
        const bool became = holds && !e.held;
        e.held = holds;
        const bool too_soon = e.done > 0 && frame.middle - e.last < to_ns(e.config.again_after_s);
        if (became && !e.spent() && !too_soon) e.due = {frame.middle};
    }
}

std::optional<EventSequence::Due> EventSequence::take(TimeTai until) {
    for (Event& e : events_) {
        const bool before = static_cast<std::int64_t>(seen_.id) + 1 >= e.config.at_frame;
        if (e.config.has_at_frame && e.done == 0 && before) e.due = {seen_.id == 0 ? start_ : seen_.middle};
    }
    std::optional<Due> first;
    for (std::size_t i = 0; i < events_.size(); ++i) {
        const Event& e = events_[i];
        // An event caused by a frame does not wait for the middle of that frame.
        if (e.due.empty() || (e.by_clock() && until < e.due.front())) continue;
        if (!first || e.due.front() < first->time) first = Due{i, e.due.front(), e.by_clock()};
    }
    if (first) finish(first->event, first->time, until);
    return first;
}

// Carries out the consequences of an event that has happened.
void EventSequence::finish(std::size_t index, TimeTai time, TimeTai until) {
    Event& event = events_[index];
    event.due.erase(event.due.begin());
    event.done += 1;
    event.last = time;
    if (const std::int64_t period_ns = to_ns(event.config.every_s); period_ns > 0 && !event.spent()) {
        const std::int64_t passed = std::max<std::int64_t>(0, until - time) / period_ns;
        event.due = {time + (passed + 1) * period_ns};
    }
    for (Event& other : events_) {
        if (other.after != index || other.spent()) continue;
        const TimeTai due = time + to_ns(other.config.delay_s);
        other.due.insert(std::upper_bound(other.due.begin(), other.due.end(), due), due);
    }
}

std::optional<TimeTai> EventSequence::next_time(bool pictures_only) const {
    std::optional<TimeTai> first;
    for (const Event& e : events_) {
        if (e.due.empty() || !e.by_clock() || (pictures_only && !e.actions.takes_picture())) continue;
        if (!first || e.due.front() < *first) first = e.due.front();
    }
    return first;
}

std::optional<TimeTai> EventSequence::next_switch_time() const {
    const std::optional<TimeTai> next = next_time();
    const auto does_more = [&](const Event& e) {
        return e.by_clock() && !e.due.empty() && e.due.front() == *next && !e.actions.only_switches_lamps();
    };
    return next && std::none_of(events_.begin(), events_.end(), does_more) ? next : std::nullopt;
}

bool EventSequence::comes_to_something() const {
    return std::any_of(events_.begin(), events_.end(), [](const Event& e) {
        const bool repeats = e.endless() && e.done > 0;
        return !e.due.empty() && e.by_clock() &&
               (!repeats || e.actions.takes_picture() || e.actions.ends_run);
    });
}

}  // namespace hilcam
