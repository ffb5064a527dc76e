#pragma once
// Decides which of a scenario's events is due next. Pure logic without threads, clocks or commands.
//
// It is given each frame that has been seen, and asked for the events that are due until an instant. The
// answer depends on nothing else, so the same frames give the same events.
//
//   at_s, at_utc   due at that time, then every `every_s`; times that passed meanwhile are skipped
//   at_frame N     due once frame N - 1 has been seen, so that it acts on frame N or the first one after it
//   after          due delay_s after each time of the other event, even while an earlier one is still due
//   when           due when its condition becomes true between two seen frames, or is true in the first
//                  frame; a change within again_after_s of its last time is ignored
//
// Each event may happen `times` times. Its time is the instant at which it was due; for at_frame and when,
// that is the middle of the last frame seen.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "emulator/events/event_condition.h"
#include "emulator/events/event_config.h"
#include "emulator/world/frame_watcher.h"

namespace hilcam {

class EventSequence {
  public:
    // start: beginning of the simulation. Throws InputError when an event names something that does not
    // exist.
    EventSequence(std::span<const EventConfig> events, const EventWorld& world, TimeTai start);

    // Records a frame of the first camera. If frames were skipped, this is the newest.
    void saw(const SeenFrame& frame, const WorldSnapshot& world);

    struct Due {
        std::size_t event = 0;
        TimeTai time;
        bool by_clock = false;  // true for at and after, for which the time was known beforehand
    };
    // Returns the earliest due event and marks it as done. Events with a known time are considered until
    // `until`. Among several at the same time, the first of the list comes first. Returns nothing when no
    // event is due.
    std::optional<Due> take(TimeTai until);
    // Returns when the earliest event with a known time is due. pictures_only: considers only events that
    // take pictures.
    std::optional<TimeTai> next_time(bool pictures_only = false) const;
    // Returns the same instant, or nothing if an event does more at it than switch lamps.
    std::optional<TimeTai> next_switch_time() const;
    // True while an event with a known time still matters: it takes a picture, ends the run, has not happened
    // yet, or happens a limited number of times. False when only endless repetitions remain that take no
    // picture.
    bool comes_to_something() const;

    std::size_t size() const { return events_.size(); }
    const EventActions& actions(std::size_t event) const { return events_[event].actions; }
    const EventConfig& config(std::size_t event) const { return events_[event].config; }
    std::uint64_t done(std::size_t event) const { return events_[event].done; }

  private:
    struct Event {
        EventConfig config;
        EventActions actions;
        std::optional<EventCondition> condition;
        std::optional<std::size_t> after;  // the event that it follows
        std::vector<TimeTai> due;          // earliest first; only `after` can have several
        std::uint64_t done = 0;
        TimeTai last;  // time it last happened, if done > 0
        bool held = false;

        bool by_clock() const { return config.has_at_s || config.has_at_utc || config.has_after; }
        // True when the event cannot become due again. An event that is already due counts as one that
        // happened.
        bool spent() const {
            return config.times > 0 && done + due.size() >= static_cast<std::uint64_t>(config.times);
        }
        bool endless() const { return config.times == 0; }
    };
    void finish(std::size_t index, TimeTai time, TimeTai until);

    std::vector<Event> events_;
    TimeTai start_;
    SeenFrame seen_;
};

}  // namespace hilcam
