#pragma once
// Carries out a scenario's events during a run. Their commands take the same path as commands from outside,
// so a recording contains them.
//
// An event acts on the first frame that begins its exposure at the event's time or later; an event that
// depends on frames acts on the frame after the one for which it came true. Frames are the first camera's.
//
//   lockstep    The command dispatch asks before every frame that it orders, so the same frames give the same
//               events on any machine. A picture that an event takes comes before a frame that is ordered for
//               a later time. If no commands can come in, the director orders the events' pictures one after
//               the other and ends the run after the last. After `end` no frame is taken.
//   free-run,   The director's own thread wakes for every frame and at the events' times. It carries out what
//   triggered   is due at a frame's begin 0.9 ms earlier. If the machine delays the thread, the event is a
//               frame late, and its log line says before which frame it was done. Settings apply to exposures
//               that begin at the event's time or later, even if the event or the frame is late
//               (settings_history.h).
//
// Joints, lamps and poses change at the event's time. A fault without `--from-frame` strikes from the next
// frame on.

#include <atomic>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "emulator/events/event_sequence.h"
#include "emulator/loop/live_settings.h"
#include "emulator/loop/shutter_timing.h"
#include "emulator/world/clock.h"
#include "emulator/world/frame_watcher.h"
#include "io/contract/command.h"
#include "io/system/timed_semaphore.h"
#include "render/vocabulary/latest.h"

namespace hilcam {

class EventDirector : public FrameWatcher {
  public:
    // Parts that the director works on. All must outlive it. placed_objects: number of objects in the world
    // (WorldState).
    struct Bench {
        CommandHandler& commands;
        const LiveSettings& settings;  // the first camera's
        const SimulatedClock& clock;
        ShutterTiming timing;
        std::size_t placed_objects = 0;
        bool self_driven = false;  // lockstep, and no commands can come in
    };
    EventDirector(EventSequence sequence, const Bench& bench);
    ~EventDirector() override { stop(); }

    // Call before the loops start. Events that are due at once have happened when it returns.
    void start();
    // Prevents further events. Call before the loops stop, because they answer what waits for a frame.
    void ask_to_stop() noexcept { stopping_.store(true); }
    void stop() noexcept;
    // True when an event has ended the run, or a run that consists of events has no more.
    bool asks_to_end() const { return asks_to_end_.load(); }

    void seen(const SeenFrame& frame, const WorldSnapshot& world) noexcept override;
    // Lockstep: carries out what is due before this order's frame, and switches lamps that change while its
    // shutter is open, because switches act at their own time. Called by the dispatch, one call at a time
    // except for calls that it causes itself.
    void before_frame(const TriggerOrder& order);

  private:
    struct Seen {
        SeenFrame frame;
        WorldSnapshot world;
    };
    static Seen nothing_seen(std::size_t placed_objects);
    void run();
    void drive();
    void look();
    TimeTai begin_of(const TriggerOrder& order) const;
    struct NextBegin {
        std::int64_t monotonic_ns = 0;
        TimeTai simulated;
    };
    NextBegin next_begin() const;
    std::int64_t wait_until_ns() const;
    TimeTai horizon() const;
    bool happen_until(TimeTai until);
    void switch_lamps_until(TimeTai until);
    void happen(const EventSequence::Due& due);
    Command stamped(Command command, const EventSequence::Due& due) const;

    EventSequence sequence_;
    Bench bench_;
    Seen seen_;  // used by the loop
    Latest<Seen> newest_;
    SeenFrame frame_;  // newest frame that the sequence has been given
    TimedSemaphore news_;
    bool picture_refused_ = false;  // used by the driving thread
    std::atomic<bool> stopping_{false}, asks_to_end_{false};
    std::thread thread_;
};

}  // namespace hilcam
