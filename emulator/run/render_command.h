#pragma once
// `hilcam render`: makes one picture of the scenario's first instant, at any stage of the chain.

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>

#include "emulator/run/pixel_report.h"
#include "emulator/scenario/app_config.h"

namespace hilcam {

class StillCamera;

enum class PictureStage { kRadiance, kElectrons, kFrame };

struct RenderFiles {
    // By stage: radiance .exr; mean electrons .exr, .fits; a frame .png, .tiff, .fits, .raw.
    std::filesystem::path out;
    std::filesystem::path view{};  // .png picture of a frame for viewing; empty: none
    // Folder for the truth, in files named after the picture, with all layers unless outputs.truth names
    // some; empty: none.
    std::filesystem::path truth{};
    bool parts = false;  // true: also writes layers of the parts of the light; for radiance only
    std::optional<FramePixel> pixel{};  // pixel to describe on standard output; `out` may then be empty
    bool overwrite = false;             // true: replaces a run's frame, or the truth of another picture
};

// Writes the first picture of the camera with that number, from 1. Checks file names before rendering.
// on_loaded: called before rendering; may be empty. Throws InputError, DeviceError.
void render_to_files(const ScenarioConfig& scenario, PictureStage stage, double time_offset_s,
                     const RenderFiles& files, std::size_t camera = 1,
                     const std::function<void(StillCamera&)>& on_loaded = {});

}  // namespace hilcam
