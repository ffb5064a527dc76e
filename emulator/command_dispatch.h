#pragma once
// What decoded commands do: poses to the world, settings to the camera.

#include <cstdint>

#include "emulator/clock.h"
#include "emulator/live_settings.h"
#include "emulator/world_state.h"
#include "io/command.h"

namespace hilcam {

class CommandDispatch : public CommandHandler {
  public:
    CommandDispatch(WorldState& world, LiveSettings& settings, const SimulatedClock& clock)
        : world_(world), settings_(settings), clock_(clock) {}

    CommandStatus handle(const Command& command, std::uint32_t sequence,
                         std::int64_t arrival_monotonic_ns) override;
    TimeTai now() const override { return clock_.now(); }

  private:
    CommandStatus set_pose(const PoseCommand& pose, std::uint32_t sequence,
                           std::int64_t arrival_monotonic_ns);
    CommandStatus turn(const JointCommand& joint, std::uint32_t sequence, std::int64_t arrival_monotonic_ns);
    static bool resolve(TimeTai& tag, TimeTai arrival);
    CommandStatus change(const SettingsCommand& settings);

    WorldState& world_;
    LiveSettings& settings_;
    const SimulatedClock& clock_;
};

}  // namespace hilcam
