#pragma once
// Writes a cloned camera as a camera file: what was measured, then the text of the camera of --like without
// the keys that the measurement replaces. Maps and the list of defects go into a folder beside it.

#include <filesystem>
#include <string>
#include <vector>

#include "emulator/clone/clone_measurement.h"
#include "emulator/clone/frame_set.h"

namespace hilcam {

struct CloneSource {
    std::string frames;  // the folder of the frames
    std::size_t frame_count = 0;
    std::filesystem::path like_file;     // camera of the same type
    CameraModel like;                    // the same, as read
    std::vector<std::string> overrides;  // "key=VALUE" of --set, on top-level keys
};

// Returns a YAML mapping without these top-level keys, comments above them included; the rest is unchanged.
std::string without_keys(const std::string& yaml, const std::vector<std::string>& keys);

// Returns the text of the camera file. maps: the folder of the maps, relative to the file.
std::string clone_yaml(const CloneMeasurement& clone, const CloneSource& source, const std::string& maps);

// Writes FILE and, into the folder FILE without its ending + "_maps", gain.fits, offset.fits, dark.fits and
// defects.csv, then reads the camera back. Throws DeviceError when a file cannot be written, InputError when
// the camera is refused.
void write_clone(const CloneMeasurement& clone, const CloneSource& source, const std::filesystem::path& file);

}  // namespace hilcam
