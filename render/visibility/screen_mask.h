#pragma once
// Marks the blocks of pixels that objects may cover: the outlines of boxes around clusters of an object's
// triangles. Rays then skip empty sky inside an object's bounds. Conservative: no triangle is visible in an
// unmarked block.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "render/vocabulary/image_geometry.h"
#include "render/vocabulary/pixel_box.h"
#include "render/vocabulary/pose.h"

namespace hilcam {

class ScreenMask {
  public:
    explicit ScreenMask(const ImageGeometry& geometry);

    // Reuses the mask for another picture with at most as many blocks; nothing is marked. Loop; no
    // allocation.
    void place(const ImageGeometry& geometry);
    void clear();
    // Marks everything.
    void fill();
    int width() const { return geometry_.width_px; }
    // Marks what the boxes [least corner, greatest corner; body axes, m] of an object may cover. Returns
    // whether anything was marked. Loop; no allocation.
    bool add(const Pose& camera, const Pose& object, std::span<const std::array<Vec3f, 2>> boxes_m);

    // Returns the mark of the block that holds a pixel (padded px).
    bool at(int x, int y) const {
        return blocks_[static_cast<std::size_t>(y / kBlock_px * across_ + x / kBlock_px)] != 0;
    }
    bool any(const PixelBox& box) const;

    static constexpr int kBlock_px = 4;

  private:
    ImageGeometry geometry_;
    int across_, down_;
    std::vector<std::uint8_t> blocks_;

    bool mark(Vec2d least, Vec2d most);
};

}  // namespace hilcam
