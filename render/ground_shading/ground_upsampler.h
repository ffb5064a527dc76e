#pragma once
// Holds a frame's light at every second pixel in each direction, and interpolates all pixels from it by cubic
// convolution (Keys, IEEE Transactions ASSP 29, 1981, with a = -1/2; negative results become zero).
//
// Structures narrower than two pixels are lost, or aliased. docs/ground.md has the error in units of the
// sensor's noise.

#include <cstdint>
#include <vector>

#include "render/vocabulary/pixel_box.h"
#include "render/vocabulary/radiance_image.h"

namespace hilcam {

class GroundUpsampler {
  public:
    static constexpr int kStep_px = 2;
    static constexpr int kTile = 32;  // places along the edge of a tile whose light is known or not

    // Allocates for a picture. Owner thread.
    explicit GroundUpsampler(const RadianceImage& picture);
    bool has_room_for(const RadianceImage& picture) const;

    // The light at the places, from the picture's corner on. A tile's light is valid after set_known(). Loop,
    // any thread, one per tile.
    RadianceImage& light() { return light_; }
    void set_known(const PixelBox& tile, bool known) {
        known_[index(tile.x0 / kTile, tile.y0 / kTile)] = known;
    }

    // Writes the pixels of a box of the picture, at most RadianceImage::kBlock_px wide and high. Returns
    // false, and writes nothing, if a place that it needs is not known. Loop, any thread.
    bool give(const PixelBox& box, RadianceImage& picture) const;

  private:
    RadianceImage light_;
    int tiles_across_, tiles_down_;
    std::vector<std::uint8_t> known_;  // by tile

    std::size_t index(int x, int y) const { return static_cast<std::size_t>(y * tiles_across_ + x); }
    bool knows(const PixelBox& places) const;
};

}  // namespace hilcam
