#pragma once
// Triangles that cross the camera's plane or extend far beyond the picture, for the visibility buffer: which
// tiles may show them, and their set-up for a tile. Their edges are planes through the camera, so no corner
// is ever divided by its depth (Olano & Greer, Graphics Hardware 1997). Corners are in camera axes, relative
// to the camera. Loop, any thread.

#include <array>

#include "render/visibility/lens_tiles.h"
#include "render/visibility/visibility_raster.h"

namespace hilcam {

using CornersInCamera = std::array<Vec3d, 3>;

// Finds the tiles that may show the part of a triangle in front of the camera. Returns false if it is behind
// the camera or outside the picture.
bool bounds_of_cut(const CornersInCamera& corners_m, const ImageGeometry& geometry, const LensTiles& lens,
                   TileRange& range);

// A triangle at the instants of a tile's upper and lower edge; both are the same for a camera of one instant.
struct CutTriangle {
    CornersInCamera upper_m, lower_m;
    std::uint32_t id;
    double depth_origin_m;
};
// view: of the tile.
void set_up_cut(const CutTriangle& triangle, const LensTiles::View& view, TriangleSetup& setup);

}  // namespace hilcam
