#pragma once
// The transports of a scenario's commands, made from their configuration.

#include <memory>
#include <vector>

#include "emulator/app_config.h"
#include "io/command_receiver.h"

namespace hilcam {

// `handler` and `faults` outlive them.
std::vector<std::unique_ptr<CommandReceiver>> make_receivers(const CommandsConfig& config,
                                                             CommandHandler& handler, FaultBoard& faults);
// All together.
CommandReport report_of(const std::vector<std::unique_ptr<CommandReceiver>>& receivers);

}  // namespace hilcam
