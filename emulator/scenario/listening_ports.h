#pragma once
// The addresses and ports that a scenario listens on: two of its own parts on one is a mistake that can be
// told before anything is opened.

#include "emulator/scenario/app_config.h"

namespace hilcam {

// Throws KeyError at the key of the second of two that are to listen on the same address and port.
void check_listening_ports(const ScenarioConfig& scenario);

}  // namespace hilcam
