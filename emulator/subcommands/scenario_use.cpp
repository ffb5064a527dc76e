#include "emulator/subcommands/scenario_use.h"

#include <spdlog/spdlog.h>

#include "emulator/scenario/scene_loader.h"
#include "render/vocabulary/check.h"

namespace hilcam {

std::optional<tbb::global_control> limit_threads(const ScenarioConfig& scenario) {
    std::optional<tbb::global_control> limit;
    if (scenario.threads > 0)
        limit.emplace(tbb::global_control::max_allowed_parallelism,
                      static_cast<std::size_t>(scenario.threads));
    return limit;
}

ScenarioConfig load_and_warn(const ConfigArguments& config) {
    ScenarioConfig scenario = load_scenario(config.file, config.overrides);
    log_warnings(scenario.warnings);
    return scenario;
}

void log_info(const std::string& line) {
    if (!line.empty()) spdlog::info("{}", line);
}

void log_warning(const std::string& line) {
    if (!line.empty()) spdlog::warn("{}", line);
}

void log_warnings(const std::vector<std::string>& lines) {
    for (const std::string& line : lines) log_warning(line);
}

void refuse_for_memory(const ScenarioConfig& s) {
    const auto oversampling = static_cast<int>(s.quality.oversampling);
    const ImageGeometry image = geometry_of(s.camera, static_cast<int>(s.quality.guard_px), oversampling);
    const std::size_t bins = s.spectrum_edges_um.size() - 1;
    const double bytes = 4.0 * image.padded_width() * image.padded_height() * static_cast<double>(bins);
    throw DeviceError(fmt::format(
        "there is not enough memory for the scenario: its camera of {} x {} px has radiance images of {} "
        "x {} px in {} bins, {:.3g} GB each (camera.width_px, height_px, quality.oversampling, guard_px, "
        "spectrum_edges_um)",
        s.camera.width_px, s.camera.height_px, image.padded_width(), image.padded_height(), bins,
        bytes * 1e-9));
}

}  // namespace hilcam
