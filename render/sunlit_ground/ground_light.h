#pragma once
// The light of ground that alone is in the scene and lit by the Sun alone, a sample in each pixel's middle: what rays would find, for
// a third of what they cost. A visibility buffer with a sixteenth of the picture's pixels finds the triangles, so that its sixteen
// samples a pixel are the middles of 4 x 4 pixels of the picture, which are then worked out side by side.
//
// FramePlacer says which frames that is for. Tiles that see something else than ground are left to rays.

#include "render/light/tile.h"
#include "render/vocabulary/image_geometry.h"

namespace hilcam {

// Picture's pixels on an edge of the buffer's pixels and of its tiles.
inline constexpr int kGroundBlock_px = kVisibilitySamplesAcross;
inline constexpr int kGroundTile_px = kGroundBlock_px * kVisibilityTile_px;

// Returns the geometry of the buffer, whose first sample is the middle of the padded picture's first pixel.
ImageGeometry ground_geometry(const ImageGeometry& picture);

// True for materials that are worked out so: without facets, glass or textures.
bool is_plain_ground(const Material& material);

// Adds the light that a tile's pixels see to them. False, and nothing is added, where not all of it is ground. tile.ground: of
// the frame's buffer, filled where the tile is. Loop, any thread.
bool add_ground_light(Tile& tile);

}  // namespace hilcam
