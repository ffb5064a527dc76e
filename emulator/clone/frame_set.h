#pragma once
// A laboratory's frames of one camera: series of frames that were taken one after the other with the same
// settings, in the dark or of an evenly lit surface.

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "render/vocabulary/image.h"

namespace hilcam {

enum class SeriesKind { kDark, kFlat };

struct FrameSeries {
    std::string name;  // for messages: the folder or the file names' common part
    SeriesKind kind = SeriesKind::kDark;
    double exposure_s = 0;
    std::optional<double> temperature_c;
    double gain_db = 0;
    double light = 1;  // light of a flat, in any unit that is the same for all flats
    std::size_t frames = 0;
    // Writes frame i, which has the set's size. Throws InputError when it cannot be read. The same i gives
    // the same frame.
    std::function<void(std::size_t i, DnImage& frame)> read;
};

struct FrameSet {
    std::string name;
    int width = 0, height = 0, bits = 12;
    std::vector<FrameSeries> series;
};

}  // namespace hilcam
