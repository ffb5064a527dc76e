#pragma once
// The arguments that several subcommands take on the command line, and the tie between a subcommand and what
// it does.

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include "emulator/scenario/app_config.h"
#include "emulator/subcommands/subcommands.h"
#include "io/system/shipped_parts.h"

namespace hilcam {

// A configuration file and the keys that --set replaces in it.
struct ConfigArguments {
    std::filesystem::path file;
    std::vector<std::string> overrides;
};
// Adds the positional CONFIG, which is required, and --set.
void add_config(CLI::App* command, ConfigArguments& config);
// Adds --set alone. whose: "the scenario", as the help says whose keys are replaced.
void add_overrides(CLI::App* command, std::vector<std::string>& overrides, const std::string& whose);
// Puts a shipped file's path in the place of its name, and refuses a name that is neither that nor a file: of a
// scenario or a camera; of a part of that kind (io/system/shipped_parts.h).
CLI::Validator name_of_shipped();
CLI::Validator name_of_shipped(const ShippedKind& kind);
// Says why there is no shipped part on this machine; empty: there are.
std::string without_shipped_parts();

// Adds --camera, which counts from 1; 0 stays where the command line does not say it.
void add_camera(CLI::App* command, std::size_t& camera);
// Throws InputError when the scenario has fewer cameras than that.
void require_camera(std::size_t camera, const ScenarioConfig& scenario);

// Has `action` call `carry_out` with the arguments when the command line names the subcommand.
template <class Arguments>
void when_named(CLI::App* command, Action& action, std::shared_ptr<Arguments> arguments,
                std::type_identity_t<int (*)(const Arguments&)> carry_out) {
    command->callback([&action, arguments, carry_out] {
        action = [arguments, carry_out] { return carry_out(*arguments); };
    });
}

}  // namespace hilcam
