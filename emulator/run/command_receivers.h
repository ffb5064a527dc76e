#pragma once
// The transports of a scenario's commands, made from their configuration.

#include <memory>
#include <vector>

#include "emulator/run/camera_station.h"
#include "emulator/scenario/app_config.h"
#include "io/contract/command_receiver.h"

namespace hilcam {

// `handler` and `faults` outlive them.
std::vector<std::unique_ptr<CommandReceiver>> make_receivers(const CommandsConfig& config,
                                                             CommandHandler& handler, FaultBoard& faults);
// That of Basilisk's Vizard protocol, and an output for it in every camera. Before the loops are made.
std::unique_ptr<CommandReceiver> make_vizard(const ScenarioConfig& scenario,
                                             const std::vector<std::unique_ptr<CameraStation>>& stations,
                                             CommandHandler& handler);
// All together.
CommandReport report_of(const std::vector<std::unique_ptr<CommandReceiver>>& receivers);

}  // namespace hilcam
