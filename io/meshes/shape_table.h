#pragma once
// Shapes of small bodies as planetary archives have them: tables of numbers in text. The form follows from the first lines,
// whatever the ending:
//
//   lines                                  form
//   v x y z ... f i j k                    PDS (.tab): corners counted from 1, or from 0 (as Eros of NEAR has them)
//   N / 1 x y z ... / M / 1 i j k          plates (.plt) of NAIF's MKDSK, type 1; N and M may stand on one line
//   N M / x y z ... / i j k ...            polyhedra of DAMIT, ADAM and Basilisk, plates of PDS's Small Bodies Node (Thomas' Eros);
//                                          a facet may begin with how many corners it has, also on a line before (NAIF's type 4)
//   Q / x y z ...                          implicitly connected quadrilaterals (.icq): (Q + 1)^2 vertices of each face of a cube (Gaskell, "The Implicitly
//                                          Connected Quadrilateral Format", with the Itokawa shape in PDS)
//   latitude longitude radius              radii in degrees, also longitude first (radius_grid.h)
//
// Columns are parted by blanks or commas, lines that begin with # are comments, exponents may be Fortran's (1.0D+00), and what
// stands behind the end of a text of DOS (0x1A) is left out. Coordinates are taken as the file has them, mostly kilometres: an object's `scale: 1000`.
// Corners are turned so that the surface encloses a volume.

#include <string>
#include <string_view>
#include <vector>

#include "io/meshes/radius_grid.h"
#include "render/vocabulary/mesh.h"

namespace hilcam {

// True for the endings above, in small letters.
bool is_shape_table(std::string_view kind);
// Throws InputError with name:line for a table that is none of those forms, has a number that is none, an index outside, or
// ends too early. One surface, "shape"; no normals: flat facets. longitudes: of a table of radii, as a label says. remarks: gets what had
// to be assumed.
Mesh read_shape_table(std::string_view text, const std::string& name,
                      Longitudes longitudes = Longitudes::kUnsaid,
                      std::vector<std::string>* remarks = nullptr);

}  // namespace hilcam
