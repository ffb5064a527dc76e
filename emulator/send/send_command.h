#pragma once
// `hilcam send`: commands from a shell.

#include <CLI/CLI.hpp>
#include <functional>

namespace hilcam {

// Adds the subcommand. When it is chosen, `action` is set to what is to be done; it gives the exit status and
// throws InputError, DeviceError.
void add_send_command(CLI::App& app, std::function<int()>& action);

}  // namespace hilcam
