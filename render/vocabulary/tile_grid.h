#pragma once
// Divides a picture into square tiles, from its corner on. The last tile of a row or column may be narrower.

#include <algorithm>

#include "render/vocabulary/pixel_box.h"

namespace hilcam {

class TileGrid {
  public:
    TileGrid(int width_px, int height_px, int edge_px)
        : width_px_(width_px),
          height_px_(height_px),
          edge_px_(edge_px),
          across_((width_px + edge_px - 1) / edge_px),
          down_((height_px + edge_px - 1) / edge_px) {}

    int edge_px() const { return edge_px_; }
    int size() const { return across_ * down_; }
    // Tiles are numbered in pairs of rows, so that four neighbours follow each other.
    PixelBox operator[](int index) const {
        const int first_row = index / (2 * across_) * 2, within = index % (2 * across_);
        const int rows = std::min(2, down_ - first_row);
        const int x = within / rows * edge_px_, y = (first_row + within % rows) * edge_px_;
        return {x, y, std::min(x + edge_px_, width_px_), std::min(y + edge_px_, height_px_)};
    }

  private:
    int width_px_, height_px_, edge_px_, across_, down_;
};

}  // namespace hilcam
