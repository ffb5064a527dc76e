#pragma once
// What decoded commands do: poses to the world, settings and triggers to the cameras, faults to their boards.
//
// Every camera has a picture of the world of its own, so poses go to all of them. Settings, triggers and
// faults go to the camera that a command names, or to all: with several, a setting that one of them refuses
// is refused for that one only, and the status says so.

#include <cstdint>
#include <mutex>
#include <vector>

#include "emulator/clock.h"
#include "emulator/live_settings.h"
#include "emulator/world_state.h"
#include "io/command.h"

namespace hilcam {

// What commands reach of a camera; all of it outlives the dispatch.
struct CommandedCamera {
    WorldState* world = nullptr;
    LiveSettings* settings = nullptr;
    FaultBoard* faults = nullptr;
};

class CommandDispatch : public CommandHandler {
  public:
    CommandDispatch(std::vector<CommandedCamera> cameras, const SimulatedClock& clock)
        : cameras_(std::move(cameras)), clock_(clock) {}

    CommandStatus handle(const Command& command, std::uint32_t sequence,
                         std::int64_t arrival_monotonic_ns) override;
    TimeTai now() const override { return clock_.now(); }

  private:
    // Which cameras: from 1; 0: all.
    struct Source {
        std::uint32_t sequence = 0;
        std::int64_t arrival_monotonic_ns = 0;
        std::uint16_t camera = 0;
    };
    template <class F>
    CommandStatus for_cameras(std::uint16_t camera, F&& act);
    CommandStatus set_pose(const PoseCommand& pose, const Source& source);
    CommandStatus turn(const JointCommand& joint, const Source& source);
    bool resolve(TimeTai& tag, const Source& source) const;
    CommandStatus change(const SettingsChange& change, const Source& source, CommandStatus refused);
    CommandStatus expose(const ExposeCommand& expose, const Source& source);
    CommandStatus expose_in_lockstep(const TriggerOrder& order, const Source& source);
    CommandStatus order(const FaultCommand& fault, const Source& source);

    std::vector<CommandedCamera> cameras_;
    const SimulatedClock& clock_;
    std::mutex lockstep_;  // one order at a time
};

}  // namespace hilcam
