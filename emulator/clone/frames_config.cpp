#include "emulator/clone/frames_config.h"

#include <cmath>

namespace hilcam {

Fields fields(SeriesConfig& s) {
    return {
        required(choice("kind", s.kind, {"dark", "flat", "edge", "chessboard", "lag"},
                        "dark: without any light; flat: of an evenly lit surface; edge: of a slanted edge; "
                        "chessboard: a board in many poses; lag: bright flats, then darks")),
        number("exposure_ms", s.exposure_s, 1e-3, {0, 1e7}, "exposure time; darks and flats need it"),
        optional(number("temperature_c", s.temperature_c, 1, {-200, 150}, "temperature of the detector"),
                 s.has_temperature_c),
        number("gain_db", s.gain_db, 1, {-60, 60}, "gain; the same for all series"),
        number("light", s.light, 1, {1e-9, 1e12},
               "light of a flat in any unit that is the same for all flats, if it was not constant"),
        numbers("corners", s.corners, 1, {3, 100}, {2, 2},
                "inner corners of the chessboard in a row and in a column, as [9, 6]"),
        required(texts("files", s.files, "names of the frames, with * and ?, in the order of their taking")),
    };
}

void validate(const SeriesConfig& s) {
    if (s.files.empty()) throw refused_key("files", "no name", "names, such as [\"dark_10ms/*.png\"]");
    if (shows_pixels(s.kind) && s.exposure_s < 1e-9)
        throw refused_key("exposure_ms", "none", "the exposure time of the darks or flats [ms]");
    if (s.kind == SeriesKind::kChessboard && s.corners.empty())
        throw refused_key("corners", "none", "inner corners of the chessboard, as [9, 6]");
    for (const double corner : s.corners)
        if (corner != std::floor(corner))
            throw refused_key("corners", "a fraction", "whole numbers, as [9, 6]");
}

Fields fields(FramesConfig& f) {
    return {
        integer("bits", f.bits, {0, 16}, "bits of a number; 0: those of the camera that --like names"),
        integer("width_px", f.width_px, {0, 16384}, "columns of raw files; 0: those of that camera"),
        integer("height_px", f.height_px, {0, 16384}, "rows of raw files; 0: those of that camera"),
        integer("container_bits", f.container_bits, {0, 16},
                "bits of a pixel in raw files: 8 or 16; 0: 8 for numbers of up to 8 bits, else 16"),
        integer("header_bytes", f.header_bytes, {0, 1e6}, "bytes before the first pixel of raw files"),
        integer("shift_bits", f.shift_bits, {0, 15},
                "places by which all numbers are shifted up in the files"),
        choice("byte_order", f.byte_order, {"little", "big"},
               "byte that comes first in raw files of 16 bits"),
        sections("series", f.series, "series of frames with the same settings"),
    };
}

}  // namespace hilcam
