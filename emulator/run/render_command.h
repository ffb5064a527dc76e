#pragma once
// `hilcam render`: one picture of the scenario's first instant, at any stage of the chain.

#include <filesystem>

#include "emulator/scenario/app_config.h"

namespace hilcam {

enum class RenderStage { kRadiance, kElectrons, kFrame };

// Writes radiance or mean electrons as .exr, the frame as .png, .tiff or .raw. Throws InputError,
// DeviceError.
// truth: a folder for what the picture shows, with all layers unless outputs.truth says which; empty: none.
void render_to_file(const ScenarioConfig& scenario, RenderStage stage, double time_offset_s,
                    const std::filesystem::path& out, const std::filesystem::path& truth = {});

}  // namespace hilcam
