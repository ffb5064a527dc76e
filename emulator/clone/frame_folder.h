#pragma once
// Reads a folder of a camera's own frames: which files there are (frames.yaml, or the files' names), and
// their pixels. PNG, TIFF, FITS and PGM of one channel, and raw files.

#include <cstdint>
#include <filesystem>

#include "emulator/clone/frame_set.h"
#include "emulator/clone/frames_config.h"
#include "sensor/camera_model.h"

namespace hilcam {

// The command line's words for what the manifest says; 0: none.
struct RawShape {
    std::int64_t width_px = 0, height_px = 0, bits = 0;
};

// like: the camera file that gives the size and the bits when neither the files nor the manifest do. Files
// are read when their frames are asked for; frames are kept in memory up to 2 GB. Throws InputError for a
// folder without frames, a manifest that is not one, names that no file has, and pictures of another size
// than the first.
FrameSet read_frame_folder(const std::filesystem::path& folder, const RawShape& shape,
                           const CameraModel& like);

}  // namespace hilcam
