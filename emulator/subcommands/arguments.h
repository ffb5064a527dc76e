#pragma once
// Arguments that several subcommands share, and the connection between a subcommand and its function.

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
// Adds the positional argument CONFIG, which is required, and --set.
void add_config(CLI::App* command, ConfigArguments& config);
// Adds only --set. whose: what the help calls the owner of the keys, as in "the scenario".
void add_overrides(CLI::App* command, std::vector<std::string>& overrides, const std::string& whose);
// Replaces the name of a shipped file by its path; refuses a name that is neither shipped nor a file. Without
// a kind, for scenarios and cameras; with one, for that kind (io/system/shipped_parts.h).
CLI::Validator name_of_shipped();
CLI::Validator name_of_shipped(const ShippedKind& kind);
// Says why this machine has no shipped parts; empty: it has them.
std::string without_shipped_parts();

// Adds --camera, which counts from 1. Without it on the command line, camera stays 0.
void add_camera(CLI::App* command, std::size_t& camera);
// Throws InputError when the scenario has fewer cameras.
void require_camera(std::size_t camera, const ScenarioConfig& scenario);

// Makes `action` call `carry_out` with the arguments when the command line names the subcommand.
template <class Arguments>
void when_named(CLI::App* command, Action& action, std::shared_ptr<Arguments> arguments,
                std::type_identity_t<int (*)(const Arguments&)> carry_out) {
    command->callback([&action, arguments, carry_out] {
        action = [arguments, carry_out] { return carry_out(*arguments); };
    });
}

}  // namespace hilcam
