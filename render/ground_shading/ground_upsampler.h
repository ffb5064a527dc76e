#pragma once
// A frame's light at every second pixel each way, and the pixels that are made of it by cubic convolution (Keys, IEEE
// Transactions ASSP 29, 1981, with a = -1/2; less than nothing is taken as nothing).
//
// Precision: what is narrower than two pixels is lost, or shows at another place. docs/ground.md has what that is of the sensor's
// noise.

#include <cstdint>
#include <vector>

#include "render/vocabulary/pixel_box.h"
#include "render/vocabulary/radiance_image.h"

namespace hilcam {

class GroundUpsampler {
  public:
    static constexpr int kStep_px = 2;
    static constexpr int kTile = 32;  // places on an edge of a tile, whose light is known or not

    // Has room for a picture's. Owner thread.
    explicit GroundUpsampler(const RadianceImage& picture);
    bool has_room_for(const RadianceImage& picture) const;

    // The light at the places, whose corner is the picture's. A tile's is known from set_known() on. Loop, any thread, one a tile.
    RadianceImage& light() { return light_; }
    void set_known(const PixelBox& tile, bool known) {
        known_[index(tile.x0 / kTile, tile.y0 / kTile)] = known;
    }

    // Writes the pixels of a box of the picture, of RadianceImage::kBlock_px at most. False, and nothing is written: a place is not
    // known that it takes. Loop, any thread.
    bool give(const PixelBox& box, RadianceImage& picture) const;

  private:
    RadianceImage light_;
    int tiles_across_, tiles_down_;
    std::vector<std::uint8_t> known_;  // by tile

    std::size_t index(int x, int y) const { return static_cast<std::size_t>(y * tiles_across_ + x); }
    bool knows(const PixelBox& places) const;
};

}  // namespace hilcam
