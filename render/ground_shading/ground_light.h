#pragma once
// Shades ground that is alone in the scene and lit by the Sun alone, by one sample in the middle of each
// pixel: the same result as rays for a third of their cost. A visibility buffer with a sixteenth of the
// picture's pixels finds the triangles, so its sixteen samples per pixel are the middles of 4 x 4 pixels of
// the picture, which are shaded side by side. With a step, they are the middles of 4 x 4 squares of step x
// step pixels (ground_upsampler.h).
//
// FrameSetup chooses the frames. Tiles that show anything but ground are left to rays.

#include "render/shading/tile.h"
#include "render/vocabulary/image_geometry.h"

namespace hilcam {

// Samples along an edge of the buffer's pixels, and of its tiles.
inline constexpr int kGroundBlock = kVisibilitySamplesAcross;
inline constexpr int kGroundTile = kGroundBlock * kVisibilityTile_px;

// Returns the geometry of the buffer, whose samples are the middles of squares of step x step pixels of the
// padded picture, from its corner on.
ImageGeometry ground_geometry(const ImageGeometry& picture, int step_px);

// True for materials that this method supports: no facets, glass or textures.
bool is_plain_ground(const Material& material);

// Adds light to a tile's places. tile.box: in places, which are frame.ground_step_px pixels apart.
// tile.ground: from the frame's buffer, filled at the tile. Returns false, and adds nothing, if part of it is
// not ground. Loop, any thread.
bool add_ground_light(Tile& tile);

}  // namespace hilcam
