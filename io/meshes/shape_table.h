#pragma once
// Reads shapes of small bodies as planetary archives have them: tables of numbers in text. The first lines
// tell the form, whatever the file's ending:
//
//  lines                       form
//  v x y z ... f i j k         PDS (.tab): corners numbered from 1, or from 0 (Eros by NEAR)
//  N / 1 x y z ... / M /       plates (.plt) of NAIF's MKDSK, type 1; N and M may be on one line
//    1 i j k
//  N M / x y z ... / i j k     polyhedra of DAMIT, ADAM and Basilisk, plates of PDS's Small Bodies Node
//                              (Thomas's Eros); a facet may begin with its number of corners, also on the
//                              line before (NAIF's type 4)
//  Q / x y z ...               implicitly connected quadrilaterals (.icq): (Q + 1)^2 vertices for each face
//                              of a cube (Gaskell, "The Implicitly Connected Quadrilateral Format", with the
//                              Itokawa shape in PDS)
//  latitude longitude radius   radii, angles in degrees, also longitude first (radius_grid.h)
//
// Columns are separated by blanks or commas, lines that begin with # are comments, exponents may be Fortran's
// (1.0D+00), and what follows DOS's end of text (0x1A) is ignored. Coordinates are used as they are, mostly
// kilometres: an object then needs `scale: 1000`. Corners are reordered so that the surface encloses a
// volume.

#include <string>
#include <string_view>
#include <vector>

#include "io/meshes/radius_grid.h"
#include "render/vocabulary/mesh.h"

namespace hilcam {

// True for the endings above, in lower case.
bool is_shape_table(std::string_view kind);
// Returns one mesh surface, "shape", without normals: flat facets. longitudes: of a table of radii, from a
// label. remarks: gets what had to be assumed. Throws InputError with name:line for a table in none of those
// forms, a malformed number, an index out of range, or an early end.
Mesh read_shape_table(std::string_view text, const std::string& name,
                      Longitudes longitudes = Longitudes::kUnsaid,
                      std::vector<std::string>* remarks = nullptr);

}  // namespace hilcam
