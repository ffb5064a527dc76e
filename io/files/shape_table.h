#pragma once
// Shapes of small bodies as planetary archives have them: tables of numbers in text.
//
//   .tab   PDS: lines "v x y z" and "f i j k", corners counted from 1, or from 0 (as Eros of NEAR has them)
//   .plt   plates: how many vertices, a line "number x y z" for each, how many plates, a line "number i j k" for each
//   .icq   implicitly connected quadrilaterals: Q, then (Q + 1)^2 vertices of each face of a cube (Gaskell, "The Implicitly
//          Connected Quadrilateral Format", with the Itokawa shape in PDS)
//
// The form follows from the first lines, whatever the ending. Coordinates are taken as the file has them, mostly
// kilometres: an object's `scale: 1000`. Corners are turned so that the surface encloses a volume.

#include <string>
#include <string_view>

#include "render/vocabulary/mesh.h"

namespace hilcam {

// True for the endings above, in small letters.
bool is_shape_table(std::string_view kind);
// Throws InputError with name:line for a table that is none of those forms, has a number that is none, an index outside, or
// ends too early. One surface, "shape"; no normals: flat facets.
Mesh read_shape_table(std::string_view text, const std::string& name);

}  // namespace hilcam
