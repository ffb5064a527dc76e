#include "emulator/subcommands/arguments.h"

#include <spdlog/fmt/fmt.h>

#include "io/config/config_advice.h"
#include "io/system/program_files.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {

namespace {

// Refuses what is neither a file, a path nor one of `names`. Errors in a path show when the file is read.
std::string refusal_of_name(const std::string& name, const std::filesystem::path& file,
                            const std::string& what, std::span<const std::string> names) {
    std::error_code error;
    if (std::filesystem::exists(file, error) || file.has_parent_path() || file.has_extension()) return {};
    const std::string nearest = nearest_of(name, names);
    return "found " + in_quotes(name) + ", which is neither a file nor a shipped " + what +
           (nearest.empty() ? "" : "; nearest: " + nearest) +
           (without_shipped_parts().empty() ? "" : "; " + without_shipped_parts());
}

}  // namespace

std::string without_shipped_parts() {
    if (!data_folder().empty()) return {};
    if (program_file().empty())
        return "shipped parts are not found: /proc is not mounted, so hilcam cannot tell where it is";
    return "shipped parts are not found: there is no share/hilcam beside " +
           program_file().parent_path().string();
}

CLI::Validator name_of_shipped() {
    return {[](std::string& name) {
                const std::filesystem::path file = named_config(name);
                std::string refusal =
                    refusal_of_name(name, file, "scenario or camera ('hilcam list')", config_names());
                if (refusal.empty()) name = file.string();
                return refusal;
            },
            ""};
}

CLI::Validator name_of_shipped(const ShippedKind& kind) {
    return {[kind](std::string& name) {
                std::error_code error;
                std::filesystem::path file = name;
                if (!std::filesystem::exists(file, error))
                    if (std::filesystem::path shipped = shipped_part(kind, name); !shipped.empty())
                        file = std::move(shipped);
                std::string refusal = refusal_of_name(
                    name, file, "one ('hilcam list " + std::string(kind.words) + "')", shipped_names(kind));
                if (refusal.empty()) name = file.string();
                return refusal;
            },
            ""};
}

void add_overrides(CLI::App* command, std::vector<std::string>& overrides, const std::string& whose) {
    command->add_option("--set", overrides, "KEY=VALUE replaces a value of " + whose + "; may be repeated")
        ->allow_extra_args(false);
}

void add_config(CLI::App* command, ConfigArguments& config) {
    command->add_option("config", config.file, "scenario file (YAML), or the name of a shipped one")
        ->required()
        ->transform(name_of_shipped());
    add_overrides(command, config.overrides, "the scenario");
}

void add_camera(CLI::App* command, std::size_t& camera) {
    command->add_option("--camera", camera, "number of the scenario's camera, from 1")
        ->check(CLI::Range(std::size_t{1}, kMaxCameras));
}

void require_camera(std::size_t camera, const ScenarioConfig& scenario) {
    const std::size_t cameras = 1 + scenario.more_cameras.size();
    if (camera > cameras)
        throw InputError(fmt::format("--camera: found {}; accepted: 1 to {}", camera, cameras));
}

}  // namespace hilcam
