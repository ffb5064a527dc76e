#pragma once
// The manifest of a folder of a camera's own frames, frames.yaml: which files are darks, flats and others,
// and how they were taken. Without a manifest the names of folders and files say it (frame_names.h).

#include <cstdint>
#include <string>
#include <vector>

#include "emulator/clone/frame_set.h"
#include "render/vocabulary/config_field.h"

namespace hilcam {

struct SeriesConfig {
    SeriesKind kind = SeriesKind::kDark;
    double exposure_s = 0;
    double temperature_c = 0;
    bool has_temperature_c = false;
    double gain_db = 0;
    double light = 1;
    std::vector<double> corners;     // inner corners of a chessboard in a row, in a column
    std::vector<std::string> files;  // names with * and ?, relative to the manifest
};
Fields fields(SeriesConfig& series);
void validate(const SeriesConfig& series);

struct FramesConfig {
    enum class ByteOrder { kLittle, kBig };

    std::int64_t bits = 0;      // 0: those of the camera of --like
    std::int64_t width_px = 0;  // for raw files; 0: those of the camera of --like
    std::int64_t height_px = 0;
    std::int64_t container_bits = 0;  // for raw files; 0: 8 up to 8 bits, else 16
    std::int64_t header_bytes = 0;    // for raw files
    std::int64_t shift_bits = 0;
    ByteOrder byte_order = ByteOrder::kLittle;
    std::vector<SeriesConfig> series;
};
Fields fields(FramesConfig& frames);

}  // namespace hilcam
