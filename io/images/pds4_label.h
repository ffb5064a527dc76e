#pragma once
// Labels of pictures for version 4 of NASA's Planetary Data System: an XML file beside a FITS file that
// describes its bytes (PDS4 Information Model 1.16, Product_Observational, Array_2D_Image).
//
// The label names no mission, because the picture is simulated. Its identifiers are hilcam's own and
// registered nowhere.

#include <cstddef>
#include <string>

#include "io/images/picture_notes.h"

namespace hilcam {

struct LabelledFile {
    std::string name;
    int width = 0, height = 0;     // 16-bit DN as encode_fits() writes them
    std::size_t header_bytes = 0;  // length of the header, which the numbers follow
    std::size_t bytes = 0;
};
// Returns the label's text. Any thread.
std::string pds4_label(const PictureNotes& notes, const LabelledFile& file);

}  // namespace hilcam
