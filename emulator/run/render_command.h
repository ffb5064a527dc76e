#pragma once
// `hilcam render`: one picture of the scenario's first instant, at any stage of the chain.

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
    std::filesystem::path out;  // radiance .exr; mean electrons .exr, .fits; a frame .png, .tiff, .fits, .raw
    std::filesystem::path view{};  // a frame's picture to look at, .png; empty: none
    // A folder for what the picture shows, in files that are named after it, with all layers unless
    // outputs.truth says which; empty: none.
    std::filesystem::path truth{};
    bool parts = false;  // layers of the parts of the light are written, too; radiance alone
    std::optional<FramePixel>
        pixel{};             // say on the standard output what it is made of; `out` may then be empty
    bool overwrite = false;  // a run's frame, or the truth of another picture
};

// Writes what the camera of that number, from 1, sees first. Throws InputError, DeviceError; names of files
// that cannot be, before anything is rendered. on_loaded: is called before it is rendered; may be empty.
void render_to_files(const ScenarioConfig& scenario, PictureStage stage, double time_offset_s,
                     const RenderFiles& files, std::size_t camera = 1,
                     const std::function<void(StillCamera&)>& on_loaded = {});

}  // namespace hilcam
