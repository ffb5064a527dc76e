#pragma once
// `hilcam manual`: every key of a scenario file; and `make-pages`, hidden, by which the build makes manual
// pages and the completion out of the command line itself.

#include <CLI/CLI.hpp>
#include <functional>
#include <string>

namespace hilcam {

// Add the subcommands. When one is chosen, `action` is set to what is to be done; it gives the exit status
// and throws InputError, DeviceError. `app` outlives the action.
void add_manual_command(CLI::App& app, std::function<int()>& action);
void add_pages_command(CLI::App& app, std::function<int()>& action);

}  // namespace hilcam
