#pragma once
// Finds which of a scenario's events is due next: logic alone, without threads, clocks or commands.
//
// Fed with frames as they are seen, asked for what is due until an instant. The answer depends on nothing
// else, so the same frames give the same events.
//
//   at_s, at_utc   due at that time, then every `every_s`; what was passed over meanwhile is left out
//   at_frame N     due once the frame before N has been seen: it is there for N, or for the first after it
//   after          due delay_s after each time of the other event, also while it still waits for one before
//   when           due when its condition has become true from one seen frame to the next, or is true of the
//                  first; not within again_after_s of its time before: a change that comes sooner is passed
//                  over
//
// Each may happen `times` times. The time of an event is when it was due: of at_frame and when, the middle of
// the frame that was seen last.

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
    // start: of the simulation. Throws InputError when an event names what does not exist.
    EventSequence(std::span<const EventConfig> events, const EventWorld& world, TimeTai start);

    // A frame of the first camera was seen; the newest, if some were not told.
    void saw(const SeenFrame& frame, const WorldSnapshot& world);

    struct Due {
        std::size_t event = 0;
        TimeTai time;
        bool by_clock = false;  // its time was known before: at and after
    };
    // The earliest event that is due, which is then done: of those that wait for their time, only until
    // `until`. None: nothing is left. Of several at the same time, the first of the list.
    std::optional<Due> take(TimeTai until);
    // Returns when the earliest event is due that waits for its time; of those that take pictures only, if
    // wanted.
    std::optional<TimeTai> next_time(bool pictures_only = false) const;
    // The same, where no event does anything then but switch lamps.
    std::optional<TimeTai> next_switch_time() const;
    // True when, among the events that wait for their time, one takes a picture, ends the run, has never
    // happened or has an end of its own: not all of them repeat for ever and change no picture.
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
        std::optional<std::size_t> after;  // that event
        std::vector<TimeTai> due;          // earliest first; several only of `after`
        std::uint64_t done = 0;
        TimeTai last;  // time it was done; when done > 0
        bool held = false;

        bool by_clock() const { return config.has_at_s || config.has_at_utc || config.has_after; }
        // An event that is due already counts.
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
