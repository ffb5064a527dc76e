#pragma once
// Shared code of subcommands that compute frames: threads, memory, warnings.

#include <tbb/global_control.h>

#include <new>
#include <optional>
#include <string>
#include <vector>

#include "emulator/scenario/app_config.h"
#include "emulator/subcommands/arguments.h"

namespace hilcam {

// Limits oneTBB to the scenario's number of threads while the result exists.
std::optional<tbb::global_control> limit_threads(const ScenarioConfig& scenario);

// Reads and checks a scenario, and logs its warnings. Throws InputError.
ScenarioConfig load_and_warn(const ConfigArguments& config);

// Log each line that is not empty.
void log_info(const std::string& line);
void log_warning(const std::string& line);
void log_warnings(const std::vector<std::string>& lines);

// Throws a DeviceError that names the scenario's keys with the largest need for memory.
[[noreturn]] void refuse_for_memory(const ScenarioConfig& scenario);

// Returns the result of `action`. If memory runs out, throws an error that names the keys with the largest
// need.
template <class Action>
auto in_memory(const ScenarioConfig& scenario, const Action& action) {
    try {
        return action();
    } catch (const std::bad_alloc&) {
        refuse_for_memory(scenario);
    }
}

}  // namespace hilcam
