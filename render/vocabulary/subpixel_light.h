#pragma once
// Where in its pixel light falls, as far as the moments of a 2 x 2 Haar transform tell: three differences of light for each
// pixel, beside the sum that a radiance image has. A lens that blurs by less than a pixel shows an edge elsewhere for light from
// a pixel's left than for light from its right; the sum alone says "from all of it".
//
// The differences are weighed by the response of each of the detector's channels, so they are charge rates on
// the axis [e- s^-1]. They are known where many samples have told what a pixel sees; elsewhere one sample has told of
// light that changes smoothly from pixel to pixel. Blocks may be marked in which they are known of no pixel; their memory
// holds anything.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "render/vocabulary/image.h"
#include "render/vocabulary/spectrum.h"

namespace hilcam {

// Which parts of a pixel have more of some light, from -1 to 1 each: the right half less the left, the lower
// less the upper, and the quarters at the upper left and the lower right less the other two.
struct SubpixelMoments {
    float across = 0, down = 0, crossed = 0;

    SubpixelMoments& operator+=(const SubpixelMoments& other) {
        across += other.across, down += other.down, crossed += other.crossed;
        return *this;
    }
};
inline SubpixelMoments operator*(float factor, const SubpixelMoments& of) {
    return {factor * of.across, factor * of.down, factor * of.crossed};
}
// Returns those of light at a place in its pixel, from the pixel's corner [px].
constexpr SubpixelMoments subpixel_moments_at(float x_px, float y_px) {
    const auto half = [](float at) { return at > 0.5f ? 1.0f : (at < 0.5f ? -1.0f : 0.0f); };
    const float across = half(x_px), down = half(y_px);
    return {across, down, across * down};
}

// A pixel's differences are known in one of these ways.
enum class SubpixelKind : std::uint8_t {
    kSmooth,      // one sample has told of all of it
    kBackground,  // many have, and none sees an object
    kObject,      // one of many sees an object
};

class SubpixelLight {
  public:
    static constexpr int kDifferences = 3;  // in the order of SubpixelMoments

    // responses: charge rate of each channel by radiance [e- s^-1 per W m^-2 sr^-1 um^-1], at least one. Blocks
    // are squares of block_px.
    SubpixelLight(int width, int height, int block_px, std::vector<Spectrum> responses)
        : responses_(std::move(responses)),
          differences_(width, height, kDifferences * static_cast<int>(responses_.size())),
          kinds_(width, height),
          block_px_(block_px),
          blocks_across_((width + block_px - 1) / block_px),
          unknown_(static_cast<std::size_t>(blocks_across_ * ((height + block_px - 1) / block_px)), 1) {}

    int width() const { return differences_.width(); }
    int height() const { return differences_.height(); }
    std::span<const Spectrum> responses() const { return responses_; }
    // True when the frame that is in it was made with differences. Who makes a frame says so.
    bool used() const { return used_; }
    void set_used(bool used) { used_ = used; }

    std::span<float> row(int y, int difference, int channel) {
        return differences_.row(y, kDifferences * channel + difference);
    }
    std::span<const float> row(int y, int difference, int channel) const {
        return differences_.row(y, kDifferences * channel + difference);
    }
    std::span<SubpixelKind> kinds(int y) { return kinds_.row(y); }
    std::span<const SubpixelKind> kinds(int y) const { return kinds_.row(y); }
    // Returns the mark of the block that holds pixel (x, y).
    bool unknown(int x, int y) const { return unknown_[block(x, y)] != 0; }
    void mark_unknown(int x, int y, bool unknown) { unknown_[block(x, y)] = unknown ? 1 : 0; }

  private:
    std::size_t block(int x, int y) const {
        return static_cast<std::size_t>(y / block_px_ * blocks_across_ + x / block_px_);
    }
    std::vector<Spectrum> responses_;
    Image<float, struct MomentQuantity> differences_;
    Image<SubpixelKind, struct KindQuantity> kinds_;
    int block_px_, blocks_across_;
    bool used_ = false;
    std::vector<std::uint8_t> unknown_;
};

}  // namespace hilcam
