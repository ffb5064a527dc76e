#pragma once
// Carries out decoded commands: poses go to the world, settings and triggers to the cameras, faults to their
// boards.
//
// Every camera has its own copy of the world, so poses go to all. Settings, triggers and faults go to the
// camera that a command names, or to all. A setting that one of several cameras refuses is refused for that
// camera only, and the status says so. The watch over poses (pose_watch.h) judges time tags.

#include <cstdint>
#include <mutex>
#include <vector>

#include "emulator/loop/live_settings.h"
#include "emulator/world/clock.h"
#include "emulator/world/pose_watch.h"
#include "emulator/world/world_state.h"
#include "io/contract/command.h"

namespace hilcam {

class CameraLines;

// The parts of a camera that commands act on. All must outlive the dispatch.
struct CommandedCamera {
    WorldState* world = nullptr;
    LiveSettings* settings = nullptr;
    FaultBoard* faults = nullptr;
    CameraLines* lines = nullptr;  // null: a pulse on Line0 goes to the camera as it is
};

class EventDirector;
class Recorder;

class CommandDispatch : public CommandHandler {
  public:
    // poses: the bench's watch; null: a watch with the default rules.
    CommandDispatch(std::vector<CommandedCamera> cameras, SimulatedClock& clock, PoseWatch* poses = nullptr)
        : cameras_(std::move(cameras)), clock_(clock), poses_(poses ? *poses : default_poses_) {}

    CommandStatus handle(const Command& command, const CommandSource& source) override;
    TimeTai now() const override { return clock_.now(); }
    ClockReading read_clock(std::int64_t arrival_monotonic_ns) const override {
        return clock_.read(arrival_monotonic_ns);
    }

    // Records all accepted commands. Call before the first command; the recorder must outlive the last.
    void record_to(Recorder& recorder) { recorder_ = &recorder; }
    // Consults the events before every frame in lockstep. Call before the first command; `events` must
    // outlive the last.
    void ask_events(EventDirector& events) { events_ = &events; }

  private:
    CommandStatus perform(const Command& command, const CommandSource& source);
    template <class F>
    CommandStatus for_cameras(std::uint16_t camera, F&& act, CommandNotes* notes = nullptr);
    CommandStatus set_pose(const PoseCommand& pose, const CommandSource& source);
    CommandStatus turn(const JointCommand& joint, const CommandSource& source);
    CommandStatus switch_lamp(const LampCommand& lamp, const CommandSource& source);
    template <class C, class F>
    CommandStatus move(const C& command, PoseWatch::Subject subject, TimeTai& tag,
                       const CommandSource& source, bool anew, F&& set);
    bool resolve(TimeTai& tag, const CommandSource& source) const;
    CommandStatus order(const ClockCommand& clock);
    void wake_cameras();
    std::int64_t settings_hold_from(const CommandSource& source) const;
    CommandStatus change(const SettingsChange& change, const CommandSource& source, CommandStatus refused);
    CommandStatus expose(const ExposeCommand& expose, const CommandSource& source);
    CommandStatus expose_in_lockstep(const TriggerOrder& order, const CommandSource& source);
    CommandStatus run_order(const TriggerOrder& order, const CommandSource& source);
    std::uint64_t note(const Command& command, const CommandSource& source, bool forgets);
    CommandStatus order(const FaultCommand& fault, const CommandSource& source);
    CommandStatus order_from_next_frame(FaultCommand fault, const CommandSource& source);

    std::vector<CommandedCamera> cameras_;
    SimulatedClock& clock_;
    PoseWatch default_poses_;
    PoseWatch& poses_;
    Recorder* recorder_ = nullptr;     // may be null
    EventDirector* events_ = nullptr;  // may be null
    // Held while a command takes effect and is noted, so that both happen in the same order.
    std::mutex recording_;
    std::mutex lockstep_;  // one sender's order at a time, including what events do before its frames
};

}  // namespace hilcam
