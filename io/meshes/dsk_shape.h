#pragma once
// Reads SPICE's shape kernels (DSK): triangular plates, data type 2.
//
// NAIF, "DSK Required Reading" and "DLA Required Reading": a DAS file with a chain of segments in its
// integers. A segment is a surface of a body, or a piece of one, in a body-fixed frame. Type 2 has vertices
// in km and plates of three vertices, numbered from 1, counterclockwise seen from outside. Its voxel index is
// skipped. Other types are refused.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "render/vocabulary/mesh.h"

namespace hilcam {

// The facts in a segment's descriptor. Codes are NAIF's.
struct DskSegment {
    int surface = 0, body = 0, frame = 0, type = 0;
    std::uint32_t vertices = 0, plates = 0;
};
// Returns all segments. Throws InputError, one line that names the file, when it is not a DSK or is damaged.
std::vector<DskSegment> dsk_segments(std::string_view bytes, const std::string& name);

// Returns all segments of one surface as a mesh in metres: one mesh surface, "shape", with flat facets.
// surface: its code; none: the only one in the file. Throws InputError as above, and, naming the choices,
// when the file has several surfaces, bodies or frames and none was chosen.
Mesh read_dsk_shape(std::string_view bytes, const std::string& name, std::optional<int> surface = {});

}  // namespace hilcam
