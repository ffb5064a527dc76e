#pragma once
// The subcommands of the program in the order of `hilcam --help`; each has a file of the same name.
//
// Each function adds one subcommand to `app`. When the command line names it, `action` is set to a function
// that returns the exit status and throws InputError, DeviceError. `app` and `action` must outlive the
// parsing and the action. `hilcam send` has its own room (emulator/send/send_command.h).

#include <CLI/CLI.hpp>
#include <functional>

namespace hilcam {

using Action = std::function<int()>;

void add_run_command(CLI::App& app, Action& action);
void add_prepare_command(CLI::App& app, Action& action);
void add_recording_command(CLI::App& app, Action& action);
void add_render_command(CLI::App& app, Action& action);
void add_check_command(CLI::App& app, Action& action);
void add_list_command(CLI::App& app, Action& action);
void add_mesh_command(CLI::App& app, Action& action);
void add_ground_command(CLI::App& app, Action& action);
void add_bench_command(CLI::App& app, Action& action);
void add_tradeoff_command(CLI::App& app, Action& action);
void add_campaign_command(CLI::App& app, Action& action);
void add_characterise_command(CLI::App& app, Action& action);
void add_clone_command(CLI::App& app, Action& action);
void add_doctor_command(CLI::App& app, Action& action);
void add_cache_command(CLI::App& app, Action& action);
void add_manual_command(CLI::App& app, Action& action);
// Adds the hidden subcommand `make-pages`, with which the build makes manual pages and the completion from
// the command line itself.
void add_pages_command(CLI::App& app, Action& action);

}  // namespace hilcam
