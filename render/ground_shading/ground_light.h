#pragma once
// The light of ground that alone is in the scene and lit by the Sun alone, a sample in each pixel's middle: what rays would find, for
// a third of what they cost. A visibility buffer with a sixteenth of the picture's pixels finds the triangles, so that its sixteen
// samples a pixel are the middles of 4 x 4 pixels of the picture, which are then worked out side by side. Or a buffer with as few
// pixels again has the middles of 4 x 4 squares of step x step pixels (ground_upsampler.h).
//
// FrameSetup says which frames that is for. Tiles that see something else than ground are left to rays.

#include "render/shading/tile.h"
#include "render/vocabulary/image_geometry.h"

namespace hilcam {

// Places on an edge of the buffer's pixels and of its tiles.
inline constexpr int kGroundBlock = kVisibilitySamplesAcross;
inline constexpr int kGroundTile = kGroundBlock * kVisibilityTile_px;

// Returns the geometry of the buffer, whose samples are the middles of squares of step x step pixels of the padded picture, from
// its corner on.
ImageGeometry ground_geometry(const ImageGeometry& picture, int step_px);

// True for materials that are worked out so: without facets, glass or textures.
bool is_plain_ground(const Material& material);

// Adds the light that is seen at a tile's places to them. tile.box: of places, each frame.ground_step_px pixels from the next.
// False, and nothing is added, where not all of it is ground. tile.ground: of the frame's buffer, filled where the tile is. Loop,
// any thread.
bool add_ground_light(Tile& tile);

}  // namespace hilcam
