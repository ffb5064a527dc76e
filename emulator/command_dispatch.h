#pragma once
// What decoded commands do: poses to the world, settings and triggers to the camera,
// faults to their board.

#include <cstdint>

#include "emulator/clock.h"
#include "emulator/live_settings.h"
#include "emulator/world_state.h"
#include "io/command.h"

namespace hilcam {

class CommandDispatch : public CommandHandler {
  public:
    CommandDispatch(WorldState& world, LiveSettings& settings, FaultBoard& faults,
                    const SimulatedClock& clock)
        : world_(world), settings_(settings), faults_(faults), clock_(clock) {}

    CommandStatus handle(const Command& command, std::uint32_t sequence,
                         std::int64_t arrival_monotonic_ns) override;
    TimeTai now() const override { return clock_.now(); }

  private:
    CommandStatus set_pose(const PoseCommand& pose, std::uint32_t sequence,
                           std::int64_t arrival_monotonic_ns);
    CommandStatus turn(const JointCommand& joint, std::uint32_t sequence, std::int64_t arrival_monotonic_ns);
    static bool resolve(TimeTai& tag, TimeTai arrival);
    CommandStatus change(const SettingsCommand& settings);
    CommandStatus set_trigger_mode(const TriggerModeCommand& mode);
    CommandStatus trigger(const ExposeCommand& expose, std::uint32_t sequence,
                          std::int64_t arrival_monotonic_ns);
    CommandStatus order(const FaultCommand& fault);

    WorldState& world_;
    LiveSettings& settings_;
    FaultBoard& faults_;
    const SimulatedClock& clock_;
};

}  // namespace hilcam
