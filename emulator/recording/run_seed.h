#pragma once
// Settles the seed of a run's random numbers: the scenario's seed, or one of the run's own.
//
// Two runs with the same seed have the same noise in frames with the same number, whatever their light and
// exposure. That makes a run repeatable bit for bit, but spoils a measurement of the difference between two
// runs. So only a scenario that states a seed uses the same one twice.

#include <filesystem>
#include <string>

#include "emulator/scenario/app_config.h"

namespace hilcam {

// Sets the seed of a scenario that states none: that of the replayed recording, or a new one from the kernel.
// Returns a line about its origin; empty: the scenario states it. Throws InputError when the recording cannot
// be read, DeviceError when the kernel cannot supply random numbers.
std::string settle_seed(ScenarioConfig& scenario, const std::filesystem::path& replayed = {});

// Returns 16 hexadecimal digits from the kernel, as a unique name of a run. Throws DeviceError as above.
std::string drawn_run_id();

}  // namespace hilcam
