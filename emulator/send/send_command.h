#pragma once
// `hilcam send`: commands from a shell.

#include <CLI/CLI.hpp>
#include <functional>

namespace hilcam {

// Adds the subcommand. Choosing it sets `action`, which returns the exit status and throws InputError,
// DeviceError.
void add_send_command(CLI::App& app, std::function<int()>& action);

}  // namespace hilcam
