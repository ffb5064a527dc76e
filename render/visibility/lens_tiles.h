#pragma once
// A lens that bends straight lines, as the visibility buffer takes it: in each tile of the screen it is the
// affine map nearest to it, so that edges are straight there and triangles that share one still share it. The
// error is that of the lens's curvature over half a tile, some thousandths of a pixel for a camera of a few
// thousand pixels; tiles differ by it where they meet.
//
// Places are of two kinds, both in padded px. Ideal: where a pinhole of the same focal length would show a
// direction. On the screen: where the lens shows it.
//
// Not taken: fisheyes, and lenses whose error is above 0.05 px or which fold over beside the picture
// (takes()). Owner thread; const functions: loop, any thread.

#include <vector>

#include "render/visibility/visibility_raster.h"
#include "render/vocabulary/image_geometry.h"

namespace hilcam {

class LensTiles {
  public:
    static bool takes(const ImageGeometry& geometry);
    explicit LensTiles(const ImageGeometry& geometry);

    // Null where the lens leaves straight lines straight: ideal places are those on the screen then.
    const ScreenLens* screen() const { return straight_ ? nullptr : &screen_; }
    // Returns the map of the tile whose corner is at x_px, y_px; null as above.
    const TileLens* forward(int x_px, int y_px) const {
        return straight_ ? nullptr : &forward_[index(x_px, y_px)];
    }
    // Directions of a tile's places, camera axes, z = 1: corner + x right + y down, x and y [px] from the
    // corner.
    struct View {
        Vec3d corner, right, down;
        Vec3d at(double x_px, double y_px) const { return corner + x_px * right + y_px * down; }
    };
    View view(int x_px, int y_px) const;

    // The slopes that the picture shows, at least: the least and greatest x / z and y / z of directions.
    struct Slopes {
        double left, right, top, bottom;
    };
    const Slopes& slopes() const { return slopes_; }
    // The tiles that may show a box of ideal places, a pixel wider.
    void tiles_of(double x0, double x1, double y0, double y1, TileRange& range) const;

  private:
    // An affine map from a tile's pixels, from its middle, to ideal places.
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
    // Ideal places of a column's and a row's tiles, least and greatest.
    std::vector<Vec2d> column_, row_;

    std::size_t index(int x_px, int y_px) const {
        return static_cast<std::size_t>(y_px / kVisibilityTile_px * across_ + x_px / kVisibilityTile_px);
    }
    void make_tile(int tile_x, int tile_y);
};

}  // namespace hilcam
