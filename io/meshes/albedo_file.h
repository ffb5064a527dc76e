#pragma once
// Albedos of a mesh's facets or vertices: a table beside the mesh, one number a line.
//
// Lines that begin with # and empty lines are skipped. Only ratios matter: a material keeps its reflectance
// where the albedo equals the reference, and is scaled in proportion elsewhere.
//
// The albedos become a texture, which surface renderers and cached light already support: a ramp of all 8-bit
// sRGB greys. A texture coordinate between two codes gives any value in single precision, so facets keep
// their numbers exactly. Between vertices the albedo follows the ramp, which is 1.3 % below the straight line
// in the middle between values of 1 and 1.5.

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "render/vocabulary/mesh.h"

namespace hilcam {

// Throws InputError with name:line for anything but numbers of 0 or more, and for more than 300 million of
// them.
std::vector<float> parse_albedos(std::string_view text, const std::string& name);
std::vector<float> read_albedos(const std::filesystem::path& file);

// Paints a mesh, facets if there are as many albedos as triangles, vertices if there are as many as vertices.
// Returns the factor for all of the mesh's materials, the greatest albedo over the reference. reference: the
// albedo at which materials keep their reflectance; none: the mean by area. Throws InputError that begins
// with `name` for another number of albedos, for a mesh with textures, and when all albedos are 0.
double paint_albedos(Mesh& mesh, const std::vector<float>& albedos, std::optional<double> reference,
                     const std::string& name);

}  // namespace hilcam
