#pragma once
// A triangle mesh with named surfaces, as read from a file: body axes, metres.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "render/vocabulary/hapke_parameters.h"
#include "render/vocabulary/vec.h"

namespace hilcam {

// The way a texture continues beyond its edge (glTF 2.0, section 5.26: wrapS and wrapT): it repeats, its last
// texels are continued, or it is mirrored.
enum class TextureWrap : std::uint8_t { kRepeat, kClamp, kMirror };

// An 8-bit sRGB (IEC 61966-2-1) colour picture, rows from the top. As in glTF, texture coordinates start at
// the outer corner of the top left texel, with u to the right and v downwards.
struct Texture {
    std::string name;
    int width = 0;
    int height = 0;
    std::vector<std::array<std::uint8_t, 3>> texels;
    std::array<TextureWrap, 2> wrap{TextureWrap::kRepeat, TextureWrap::kRepeat};  // along u, along v
};

// The look that the mesh file gives a surface, in glTF's metallic-roughness terms. The scenario may replace
// it, by name, with a measured material.
struct MeshSurface {
    std::string name;
    Vec3f base_color{0.5f, 0.5f, 0.5f};  // linear RGB reflectance, 0..1
    float metallic = 0;                  // 0 dielectric .. 1 metal
    float roughness = 1;                 // perceptual; GGX alpha is its square
    int base_color_texture = -1;         // index into Mesh::textures; multiplies base_color
    float refractive_index = 1.5f;       // clear layer of a dielectric: 1.5 reflects 4 % (glTF 2.0)
    float opacity = 1;                   // share of the surface that is not a hole; below 1 it is a veil
    float transmission = 0;  // share of light that passes through; a half or more makes it a sheet of glass
};

struct Mesh {
    std::vector<Vec3f> vertices_m;
    std::vector<Vec3f> normals;  // one unit vector per vertex, or empty: flat shading
    std::vector<Vec2f> uvs;      // one per vertex, or empty: no textures
    std::vector<Vec3f> colors;   // one per vertex, or empty: factors on the surface's reflectance, linear RGB
    std::vector<HapkeParameters> hapke;  // one per vertex, or empty: the material's own
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::vector<std::uint16_t> surface_of_triangle;  // index into surfaces
    std::vector<MeshSurface> surfaces;
    std::vector<Texture> textures;
    // Features of the file that the mesh does not represent, each the rest of a sentence: "emission of
    // 'lamp': not used".
    std::vector<std::string> left_out;
};

// Returns a triangle's area [m^2] times its normal. The corners run counterclockwise seen from the normal's
// side.
inline Vec3d area_vector(const Mesh& mesh, const std::array<std::uint32_t, 3>& triangle) {
    const Vec3d a = to_double(mesh.vertices_m[triangle[0]]);
    return 0.5 *
           cross(to_double(mesh.vertices_m[triangle[1]]) - a, to_double(mesh.vertices_m[triangle[2]]) - a);
}

}  // namespace hilcam
