#pragma once
// Shape kernels (DSK) of SPICE: triangular plates, data type 2.
//
// NAIF, "DSK Required Reading" and "DLA Required Reading": a DAS file whose integers hold a chain of segments; a
// segment is a surface of a body, or a piece of one, in a frame that turns with the body. Type 2 has vertices in km and
// plates of three vertices each, counted from 1, counterclockwise seen from outside. The rest of it, an index of
// voxels, is passed over. Other types are refused.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "render/vocabulary/mesh.h"

namespace hilcam {

// A segment as its descriptor tells it. Codes are NAIF's.
struct DskSegment {
    int surface = 0, body = 0, frame = 0, type = 0;
    std::uint32_t vertices = 0, plates = 0;
};
// Returns all segments. Throws InputError, one line that names the file, for what is no DSK file or is damaged.
std::vector<DskSegment> dsk_segments(std::string_view bytes, const std::string& name);

// Returns all segments of one surface as a mesh in metres. surface: its code; none: that of the file, if there is but one.
// One surface, "shape", flat facets. Throws InputError as above, and for a file of several surfaces, bodies or frames of
// which none was chosen; the message names them.
Mesh read_dsk_shape(std::string_view bytes, const std::string& name, std::optional<int> surface = {});

}  // namespace hilcam
