#pragma once
// Albedos of a mesh's facets or vertices: a table beside the mesh, a number a line.
//
// Lines that begin with # and empty ones are skipped. Only ratios count: a material stays what it is where the albedo is
// the reference, and is scaled in proportion elsewhere. They become a texture, which is what renderers of surfaces,
// cached light included, already know: a ramp of all 8-bit sRGB greys, whose places between two codes give any value to
// single precision. Facets keep their numbers exactly. From vertex to vertex the albedo goes along the ramp, which is
// 1.3 % below the straight line in the middle between values of 1 to 1.5.

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "render/vocabulary/mesh.h"

namespace hilcam {

// Throws InputError with name:line for what is no number from 0 on, and for more than 300 million.
std::vector<float> parse_albedos(std::string_view text, const std::string& name);
std::vector<float> read_albedos(const std::filesystem::path& file);

// Paints a mesh: as many albedos as it has triangles are theirs, as many as it has vertices those of vertices.
// reference: the albedo that materials have as they are; none: the mean by area. Returns what all of the mesh's materials
// must be multiplied with, the greatest albedo over the reference. Throws InputError that begins with `name` for another
// number of them, for a mesh with textures, and where all are 0.
double paint_albedos(Mesh& mesh, const std::vector<float>& albedos, std::optional<double> reference,
                     const std::string& name);

}  // namespace hilcam
