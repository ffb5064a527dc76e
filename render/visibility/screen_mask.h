#pragma once
// Marks the small blocks of pixels that an object can cover: an object's triangles are boxed in clusters, and
// the boxes' outlines marked. Empty sky inside the object's own bounds then costs no rays. Conservative: a
// block that is not marked cannot meet a triangle.

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

    // Takes the mask over to another picture, which has no more blocks than the first; nothing of it is marked. Loop; no
    // allocation.
    void place(const ImageGeometry& geometry);
    void clear();
    // Everything.
    void fill();
    int width() const { return geometry_.width_px; }
    // Marks what the boxes [least corner, greatest corner; body axes, m] of an object can cover. Gives
    // whether there was anything. Loop; no allocation.
    bool add(const Pose& camera, const Pose& object, std::span<const std::array<Vec3f, 2>> boxes_m);

    // The block that holds a pixel (padded px).
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
