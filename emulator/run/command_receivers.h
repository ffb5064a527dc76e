#pragma once
// Makes the transports of a scenario's commands from their configuration.

#include <memory>
#include <vector>

#include "emulator/run/camera_station.h"
#include "emulator/scenario/app_config.h"
#include "io/contract/command_receiver.h"

namespace hilcam {

// `handler` and `faults` must outlive the receivers.
std::vector<std::unique_ptr<CommandReceiver>> make_receivers(const CommandsConfig& config,
                                                             CommandHandler& handler, FaultBoard& faults);
// Makes the receiver of Basilisk's Vizard protocol, and an output for it in every camera. Call before the
// loops are made.
std::unique_ptr<CommandReceiver> make_vizard(const ScenarioConfig& scenario,
                                             const std::vector<std::unique_ptr<CameraStation>>& stations,
                                             CommandHandler& handler);
// Makes the receiver of 42's states, and an output in every camera that knows when a frame is done. Call
// before the loops are made.
std::unique_ptr<CommandReceiver> make_ip42(const ScenarioConfig& scenario,
                                           const std::vector<std::unique_ptr<CameraStation>>& stations,
                                           CommandHandler& handler);
// Returns the report of all receivers together.
CommandReport report_of(const std::vector<std::unique_ptr<CommandReceiver>>& receivers);

}  // namespace hilcam
