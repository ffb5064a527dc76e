#include "emulator/subcommands/arguments.h"

#include <spdlog/fmt/fmt.h>

#include "io/config/config_advice.h"
#include "io/system/program_files.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {

CLI::Validator name_of_shipped() {
    return {
        [](std::string& name) {
            const std::filesystem::path file = named_config(name);
            std::error_code error;
            // A path is told when it is read.
            if (!std::filesystem::exists(file, error) && !file.has_parent_path() && !file.has_extension()) {
                const std::string nearest = nearest_of(name, shipped_names());
                return "found " + in_quotes(name) +
                       ", which is neither a file nor a shipped scenario or camera" +
                       (nearest.empty() ? "" : "; nearest: " + nearest);
            }
            name = file.string();
            return std::string();
        },
        ""};
}

void add_overrides(CLI::App* command, std::vector<std::string>& overrides, const std::string& whose) {
    command->add_option("--set", overrides, "KEY=VALUE, replaces a value of " + whose + "; may be repeated")
        ->allow_extra_args(false);
}

void add_config(CLI::App* command, ConfigArguments& config) {
    command->add_option("config", config.file, "scenario file (YAML), or the name of a shipped one")
        ->required()
        ->transform(name_of_shipped());
    add_overrides(command, config.overrides, "the scenario");
}

void add_camera(CLI::App* command, std::size_t& camera) {
    command->add_option("--camera", camera, "which of the scenario's cameras, from 1")
        ->check(CLI::Range(std::size_t{1}, kMaxCameras));
}

void require_camera(std::size_t camera, const ScenarioConfig& scenario) {
    const std::size_t cameras = 1 + scenario.more_cameras.size();
    if (camera > cameras)
        throw InputError(fmt::format("--camera: found {}; accepted: 1 to {}", camera, cameras));
}

}  // namespace hilcam
