#pragma once
// A triangle mesh with named surfaces, as it comes from a file: body axes, metres.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "render/vocabulary/hapke_parameters.h"
#include "render/vocabulary/vec.h"

namespace hilcam {

// The way in which a picture goes on beyond its edge (glTF 2.0, section 5.26: wrapS and wrapT): it begins anew, its last
// texels go on, or it comes back as in a mirror.
enum class TextureWrap : std::uint8_t { kRepeat, kClamp, kMirror };

// 8-bit sRGB-encoded (IEC 61966-2-1) colour picture, rows from the top. A mesh's places on it begin at the outer corner of the
// top left texel, u to the right and v downwards, as in glTF.
struct Texture {
    std::string name;
    int width = 0;
    int height = 0;
    std::vector<std::array<std::uint8_t, 3>> texels;
    std::array<TextureWrap, 2> wrap{TextureWrap::kRepeat, TextureWrap::kRepeat};  // along u, along v
};

// The look that the mesh file itself gives a surface (glTF metallic-roughness terms); the scenario may
// replace it by name with a measured material.
struct MeshSurface {
    std::string name;
    Vec3f base_color{0.5f, 0.5f, 0.5f};  // linear RGB reflectance, 0..1
    float metallic = 0;                  // 0 dielectric .. 1 metal
    float roughness = 1;                 // perceptual; GGX alpha is its square
    int base_color_texture = -1;         // index into Mesh::textures; multiplies base_color
    float refractive_index = 1.5f;       // index of a dielectric's clear layer: 1.5 reflects 4 % (glTF 2.0)
    float opacity = 1;                   // share of it that is no hole; below 1 it is a veil
    float transmission = 0;              // share that goes through; from one half on it is a sheet of glass
};

struct Mesh {
    std::vector<Vec3f> vertices_m;
    std::vector<Vec3f> normals;  // one unit vector per vertex, or empty: flat shading
    std::vector<Vec2f> uvs;      // one per vertex, or empty: no textures
    std::vector<Vec3f> colors;   // one per vertex, or empty: factors on what the surface reflects, linear RGB
    std::vector<HapkeParameters> hapke;  // one per vertex, or empty: the material's own
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::vector<std::uint16_t> surface_of_triangle;  // index into surfaces
    std::vector<MeshSurface> surfaces;
    std::vector<Texture> textures;
    // Looks of the file that are not in here, each the rest of a sentence: "emission of 'lamp': not used".
    std::vector<std::string> left_out;
};

// The area of a triangle [m^2] along its normal; corners counterclockwise where it is seen from.
inline Vec3d area_vector(const Mesh& mesh, const std::array<std::uint32_t, 3>& triangle) {
    const Vec3d a = to_double(mesh.vertices_m[triangle[0]]);
    return 0.5 *
           cross(to_double(mesh.vertices_m[triangle[1]]) - a, to_double(mesh.vertices_m[triangle[2]]) - a);
}

}  // namespace hilcam
