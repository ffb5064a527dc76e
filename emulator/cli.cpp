#include "emulator/cli.h"

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <new>
#include <sstream>

#include "emulator/commit.h"
#include "emulator/recording/program_version.h"
#include "emulator/run/log_setup.h"
#include "emulator/send/choice_option.h"
#include "emulator/send/command_examples.h"
#include "emulator/send/number_options.h"
#include "emulator/send/send_command.h"
#include "emulator/subcommands/subcommands.h"
#include "emulator/subcommands/unknown_option.h"
#include "io/system/plain_words.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {
namespace {

// True when a command that only groups subcommands was named without one.
bool lacks_subcommand(const CLI::App& app, const CLI::ParseError& error) {
    const CLI::App* last = &app;
    while (!last->get_subcommands().empty()) last = last->get_subcommands().front();
    return error.get_name() == "RequiredError" && last->get_require_subcommand_min() > 0 &&
           last->remaining().empty();
}

// Prints help, version or the error, and returns the exit status.
int answer(const CLI::App& app, const CLI::ParseError& error) {
    if (const std::string what = unknown_subcommand(app); !what.empty()) {
        fmt::print(stderr, "hilcam: {}\n", what);
        return 2;
    }
    if (dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr)
        if (const std::string what = unknown_option(app); !what.empty()) {
            fmt::print(stderr, "hilcam: {}\n", what);
            return 2;
        }
    if (lacks_subcommand(app, error)) {
        fmt::print(stderr, "{}", app.help());
        return 2;
    }
    // The library's messages quote the command line.
    std::ostringstream help, problem;
    const int status = app.exit(error, help, problem);
    fmt::print("{}", help.str());
    std::istringstream lines(problem.str());
    for (std::string line; std::getline(lines, line);) fmt::print(stderr, "{}\n", harmless(line));
    return status == 0 ? 0 : 2;
}

int carry_out(const Action& action) {
    try {
        return action();
    } catch (const InputError& error) {
        spdlog::error("{}", error.what());
        return 2;
    } catch (const std::bad_alloc&) {
        spdlog::error(
            "not enough memory: sensor, spectral bins, meshes or maps ask for more than the machine has, or "
            "than 'ulimit -v' allows");
        return 1;
    } catch (const std::exception& error) {
        spdlog::error("{}", plain_words(error));
        return 1;
    }
}

}  // namespace

// Adds the subcommands in the order of the help.
void set_up_command_line(CLI::App& app, Action& action) {
    app.name("hilcam");
    app.description("hilcam: a spacecraft's camera for the test bench");
    app.set_version_flag("--version", fmt::format("{} ({})", kProgramVersion, program_commit()));
    app.require_subcommand(1);
    set_examples(&app, {"hilcam list scenarios", "hilcam run small --frames 3",
                        "hilcam run geo_inspection --preview 8080", "hilcam check --help"});
    add_run_command(app, action);
    add_prepare_command(app, action);
    add_recording_command(app, action);
    add_render_command(app, action);
    add_check_command(app, action);
    add_list_command(app, action);
    add_mesh_command(app, action);
    add_ground_command(app, action);
    add_bench_command(app, action);
    add_tradeoff_command(app, action);
    add_campaign_command(app, action);
    add_characterise_command(app, action);
    add_clone_command(app, action);
    add_doctor_command(app, action);
    add_cache_command(app, action);
    add_manual_command(app, action);
    add_send_command(app, action);
    add_pages_command(app, action);
}

int run_command_line(int argc, char** argv) {
    set_up_log();
    CLI::App app;
    Action action;
    set_up_command_line(app, action);
    read_numbers_strictly(app);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return answer(app, error);
    }
    return carry_out(action);
}

}  // namespace hilcam
