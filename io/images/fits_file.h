#pragma once
// Pictures as FITS (Flexible Image Transport System 4.0, IAU FITS Working Group, 2018; Pence et al., A&A 524
// (2010) A42): one image with a header of the picture's notes and a map of the sky (sky_map.h).
//
// Rows are stored from the top, as the keyword ROWORDER says: data[y][x] of a reader is the frame's pixel (x,
// y). DN are 16-bit numbers with BZERO 32768, electrons are 32-bit floats.

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "io/images/picture_notes.h"
#include "io/images/sky_map.h"

namespace hilcam {

struct FitsHeader {
    PictureNotes notes;
    std::string unit;           // BUNIT: "adu", "electron"
    std::optional<SkyMap> sky;  // none: the camera's pose is unknown
};
// Returns the whole file. Any thread.
std::string encode_fits(const DnImage& frame, const FitsHeader& header);
std::string encode_fits(const ElectronImage& electrons, const FitsHeader& header);
// Returns the length of such a file's header; the numbers follow it.
std::size_t fits_header_bytes(std::string_view file);

}  // namespace hilcam
