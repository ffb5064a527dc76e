#pragma once
// Labels of pictures as NASA's Planetary Data System has them, version 4: a file of XML beside a FITS file, which says what
// bytes are what (PDS4 Information Model 1.16, Product_Observational, Array_2D_Image).
//
// What a label says of a mission is that there is none: the picture is simulated. Its names are hilcam's own and registered
// nowhere.

#include <cstddef>
#include <string>

#include "io/images/picture_notes.h"

namespace hilcam {

struct LabelledFile {
    std::string name;
    int width = 0, height = 0;     // 16-bit DN, as encode_fits() writes them
    std::size_t header_bytes = 0;  // before the numbers
    std::size_t bytes = 0;
};
// Any thread.
std::string pds4_label(const PictureNotes& notes, const LabelledFile& file);

}  // namespace hilcam
