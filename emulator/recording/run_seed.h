#pragma once
// The seed decides which random numbers a run draws: that which its scenario states, or the run's own.
//
// Two runs of one seed have the same noise in frames of the same number, whatever their light and exposure.
// That repeats a run bit for bit, and spoils a measurement that takes one run from another. So only a
// scenario that states a seed has the same one twice.

#include <filesystem>
#include <string>

#include "emulator/scenario/app_config.h"

namespace hilcam {

// Gives a scenario without a seed that of its run: of the recording that is replayed, or a new one from the
// kernel. Returns a line about where it is from; empty: the scenario states it. Throws InputError when the
// recording cannot be read, DeviceError when the kernel has no random numbers.
std::string settle_seed(ScenarioConfig& scenario, const std::filesystem::path& replayed = {});

// Returns 16 hexadecimal digits from the kernel: a name for a run that no other run has. DeviceError as
// above.
std::string drawn_run_id();

}  // namespace hilcam
