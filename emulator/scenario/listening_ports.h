#pragma once
// The addresses and ports on which a scenario listens. Two parts with the same one are a mistake that shows
// before anything is opened.

#include "emulator/scenario/app_config.h"

namespace hilcam {

// Throws KeyError at the key of the second part that would listen on the same address and port.
void check_listening_ports(const ScenarioConfig& scenario);

}  // namespace hilcam
