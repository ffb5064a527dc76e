#pragma once
// A corner of a floor and a wall, which light each other, and pictures of grey for what has surfaces.

#include <cstdint>
#include <utility>
#include <vector>

#include "tests/support/stage.h"

namespace hilcam {

// A floor at z = 0 and a wall of the same size that stands on its edge, both two metres wide.
inline SceneObject corner(const MaterialConfig& material, const SpectralGrid& grid) {
    return object_of({{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}, {1, -1, 2}, {1, 1, 2}},
                     {{0, 1, 2}, {0, 2, 3}, {1, 4, 5}, {1, 5, 2}}, material, grid);
}

// Greys of pictures and the reflectance that IEC 61966-2-1 has for them.
inline constexpr std::uint8_t kGrey = 188;
inline constexpr double kLinearGrey = 0.5029;
inline constexpr std::uint8_t kDarkGrey = 99;  // 0.125

// Returns the object with stripes of these greys across two metres of it, again and again; of 255 alone, which would change
// nothing, as it is.
inline SceneObject painted(SceneObject object, const std::vector<std::uint8_t>& greys) {
    if (greys == std::vector<std::uint8_t>{255}) return object;
    Texture stripes{"grey", static_cast<int>(greys.size()), 1, {}};
    for (const std::uint8_t grey : greys) stripes.texels.push_back({grey, grey, grey});
    object.mesh.textures = {stripes};
    for (const Vec3f& at_m : object.mesh.vertices_m) object.mesh.uvs.push_back({at_m.x / 2, 0});
    object.mesh.surfaces[0].base_color_texture = object.materials[0].texture = 0;
    return object;
}

// The corner by a path model and so many rays along a pixel, painted with one grey.
inline Stage corner_stage(const char* model, const MaterialConfig& material, int samples,
                          std::uint8_t grey = 255) {
    Stage s;
    s.quality.path_model = model;
    s.quality.max_depth = 12;
    s.quality.contribution_threshold = 0;
    s.quality.samples_per_axis = samples;
    s.quality.rays_across = 0;
    s.camera(48, 0.4);
    // Seen from above, the wall to the right; the Sun from the left, so that it lights the wall more than the
    // floor.
    s.add(painted(corner(material, s.grid), {grey}), {0, 0, 4});
    s.sun({-2, 0.3, -1});
    return s;
}

}  // namespace hilcam
