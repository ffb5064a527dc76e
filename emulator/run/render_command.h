#pragma once
// `hilcam render`: one picture of the scenario's first instant, at any stage of the chain.

#include <filesystem>

#include "emulator/scenario/app_config.h"

namespace hilcam {

enum class RenderStage { kRadiance, kElectrons, kFrame };

struct RenderFiles {
    std::filesystem::path out;  // radiance .exr; mean electrons .exr, .fits; a frame .png, .tiff, .fits, .raw
    std::filesystem::path view;   // a frame's picture to look at, .png; empty: none
    std::filesystem::path truth;  // a folder for what the picture shows, with all layers unless outputs.truth
                                  // says which; empty: none
};

// Throws InputError, DeviceError; names of files that cannot be, before anything is rendered.
void render_to_files(const ScenarioConfig& scenario, RenderStage stage, double time_offset_s,
                     const RenderFiles& files);

}  // namespace hilcam
