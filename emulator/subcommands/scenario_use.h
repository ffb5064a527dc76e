#pragma once
// The common part of subcommands that compute a scenario's frames: threads, memory, warnings.

#include <tbb/global_control.h>

#include <new>
#include <optional>
#include <string>
#include <vector>

#include "emulator/scenario/app_config.h"
#include "emulator/subcommands/arguments.h"

namespace hilcam {

// Holds oneTBB to the scenario's number of threads for as long as it lives.
std::optional<tbb::global_control> limit_threads(const ScenarioConfig& scenario);

// Reads and checks a scenario, and logs the warnings of that. Throws InputError.
ScenarioConfig load_and_warn(const ConfigArguments& config);

// Each line is logged; an empty one says nothing.
void log_info(const std::string& line);
void log_warning(const std::string& line);
void log_warnings(const std::vector<std::string>& lines);

// Throws a DeviceError that says which of the scenario's keys ask for most of the memory.
[[noreturn]] void refuse_for_memory(const ScenarioConfig& scenario);

// Returns what `action` returns; where memory does not suffice for that, the message names the keys that need
// most.
template <class Action>
auto in_memory(const ScenarioConfig& scenario, const Action& action) {
    try {
        return action();
    } catch (const std::bad_alloc&) {
        refuse_for_memory(scenario);
    }
}

}  // namespace hilcam
