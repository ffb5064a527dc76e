#pragma once
// `hilcam render`: one picture of the scenario's first instant, at any stage of the chain.

#include <cstddef>
#include <filesystem>

#include "emulator/scenario/app_config.h"

namespace hilcam {

enum class RenderStage { kRadiance, kElectrons, kFrame };

struct RenderFiles {
    std::filesystem::path out;
    // A folder for what the picture shows, in files that are named after it, with all layers unless
    // outputs.truth says which; empty: none.
    std::filesystem::path truth{};
    bool overwrite = false;  // a run's frame, or the truth of another picture
};

// Writes radiance or mean electrons as .exr, the frame as .png, .tiff or .raw, as the camera of that number
// has them, from 1. Throws InputError, DeviceError.
void render_to_file(const ScenarioConfig& scenario, RenderStage stage, double time_offset_s,
                    const RenderFiles& files, std::size_t camera = 1);

}  // namespace hilcam
