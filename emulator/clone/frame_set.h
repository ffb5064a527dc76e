#pragma once
// A laboratory's frames of one camera: series of frames that were taken one after the other with the same
// settings, in the dark or of an evenly lit surface; and what shows the lens and the lag.

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "render/vocabulary/image.h"

namespace hilcam {

enum class SeriesKind { kDark, kFlat, kEdge, kChessboard, kLag };
// True for frames that show pixels; the others show the lens or the lag.
inline bool shows_pixels(SeriesKind kind) { return kind == SeriesKind::kDark || kind == SeriesKind::kFlat; }

struct FrameSeries {
    std::string name;  // for messages: the folder or the file names' common part
    SeriesKind kind = SeriesKind::kDark;
    double exposure_s = 0;
    std::optional<double> temperature_c;
    double gain_db = 0;
    double light = 1;                         // light of a flat, in any unit that is the same for all flats
    int corner_columns = 0, corner_rows = 0;  // inner corners of a chessboard
    std::size_t frames = 0;
    std::vector<std::string> files;  // names of the frames' files, for messages
    // Writes frame i, which has the set's size. Throws InputError when it cannot be read. The same i gives
    // the same frame.
    std::function<void(std::size_t i, DnImage& frame)> read;
};

struct FrameSet {
    std::string name;
    int width = 0, height = 0, bits = 12;
    std::vector<FrameSeries> series;  // darks and flats
    std::vector<FrameSeries> others;  // edges, chessboards, lag
};

}  // namespace hilcam
