#pragma once
// A lens with distortion, as the visibility buffer treats it: affine within each tile of the screen, so that
// edges are straight there and triangles with a common edge still share it. The error is the lens's curvature
// over half a tile, some thousandths of a pixel for a camera of a few thousand pixels; neighbouring tiles
// differ by it.
//
// There are two kinds of places, both in padded px. Ideal: where a pinhole of the same focal length would
// show a direction. On the screen: where the lens shows it.
//
// Not supported (takes()): fisheyes, polynomial distortion, and lenses whose error is above 0.05 px or which
// fold over beside the picture. Owner thread; const functions: loop, any thread.

#include <vector>

#include "render/visibility/visibility_raster.h"
#include "render/vocabulary/image_geometry.h"

namespace hilcam {

class LensTiles {
  public:
    static bool takes(const ImageGeometry& geometry);
    explicit LensTiles(const ImageGeometry& geometry);

    // Null if the lens has no distortion; ideal places are then the places on the screen.
    const ScreenLens* screen() const { return straight_ ? nullptr : &screen_; }
    // Returns the map of the tile with its corner at x_px, y_px; null if the lens has no distortion.
    const TileLens* forward(int x_px, int y_px) const {
        return straight_ ? nullptr : &forward_[index(x_px, y_px)];
    }
    // Directions of a tile's places in camera axes, z = 1: corner + x right + y down, x and y [px] from the
    // tile's corner.
    struct View {
        Vec3d corner, right, down;
        Vec3d at(double x_px, double y_px) const { return corner + x_px * right + y_px * down; }
    };
    View view(int x_px, int y_px) const;

    // Bounds of the directions that the picture shows: least and greatest x / z and y / z.
    struct Slopes {
        double left, right, top, bottom;
    };
    const Slopes& slopes() const { return slopes_; }
    // Finds the tiles that may show a box of ideal places, enlarged by a pixel.
    void tiles_of(double x0, double x1, double y0, double y1, TileRange& range) const;

  private:
    // An affine map from a tile's pixels, relative to its middle, to ideal places.
    struct Inverse {
        Vec2d middle, right, down;
    };

    ImageGeometry geometry_;
    bool straight_;
    int across_, down_;
    Slopes slopes_;
    ScreenLens screen_{};
    std::vector<TileLens> forward_;
    std::vector<Inverse> inverse_;
    // Least and greatest ideal places of each column and row of tiles.
    std::vector<Vec2d> column_, row_;

    std::size_t index(int x_px, int y_px) const {
        return static_cast<std::size_t>(y_px / kVisibilityTile_px * across_ + x_px / kVisibilityTile_px);
    }
    void make_tile(int tile_x, int tile_y);
};

}  // namespace hilcam
