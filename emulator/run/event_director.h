#pragma once
// Lets a scenario's events happen while it runs: their commands go the same way as those from outside, so a
// recording has them like any other.
//
// An event takes effect from the first frame on whose exposure begins at its time or later; one that depends
// on frames, from the next frame on after the one that it was true of. Frames are the first camera's.
//
//   lockstep            the command dispatch asks before every frame that it orders: the same frames, the
//                       same events, on any machine. A picture that an event takes at a time comes before a
//                       frame that is ordered for a later time. Without a way for commands to come in, the
//                       director itself lets the events' pictures be taken, one after the other, and ends
//                       the run when there are no more. After `end` no frame is taken.
//   free-run,           a thread of the director's own is woken by every frame and at the events' times; what
//   triggered           is due when a frame begins is done 0.9 ms before that. When the machine does not let
//                       it run in time, the event is a frame late: its log line says before which frame it
//                       was done. Settings hold for what begins at its time or later, however late it or
//                       a frame is (settings_history.h).
//
// Joints turn, lamps are switched and poses hold from the event's time on; a fault without `--from-frame`
// strikes from the next frame on.

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
    // Everything it works on; all of it outlives it. placed_objects: those of the world (WorldState).
    struct Bench {
        CommandHandler& commands;
        const LiveSettings& settings;  // settings of the first camera
        const SimulatedClock& clock;
        ShutterTiming timing;
        std::size_t placed_objects = 0;
        bool self_driven = false;  // lockstep: no commands can come in
    };
    EventDirector(EventSequence sequence, const Bench& bench);
    ~EventDirector() override { stop(); }

    // Is called before the loops start: what is due at once has then happened.
    void start();
    // No further event; to be called before the loops stop, which answer what waits for a frame.
    void ask_to_stop() noexcept { stopping_.store(true); }
    void stop() noexcept;
    // An event has ended the run, or it was made of events and there are no more.
    bool asks_to_end() const { return asks_to_end_.load(); }

    void seen(const SeenFrame& frame, const WorldSnapshot& world) noexcept override;
    // Lockstep: what is due before the frame of this order happens, and lamps are switched that are to be while the shutter is
    // open, as switches hold from their own time. By the dispatch, one call at a time but
    // for those that it makes itself.
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
    Seen seen_;  // the loop's
    Latest<Seen> newest_;
    SeenFrame frame_;  // that the sequence knows
    TimedSemaphore news_;
    bool picture_refused_ = false;  // the driver's
    std::atomic<bool> stopping_{false}, asks_to_end_{false};
    std::thread thread_;
};

}  // namespace hilcam
