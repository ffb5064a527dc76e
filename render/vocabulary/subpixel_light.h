#pragma once
// The distribution of light within each pixel: three differences beside the sum that a radiance image has,
// the moments of a 2 x 2 Haar transform. A lens that blurs by less than a pixel shows an edge at one place
// for light from a pixel's left half and at another for light from its right half; the sum alone cannot tell
// these apart.
//
// The differences are weighted by the response of each channel of the detector, so they are charge rates on
// the axis [e- s^-1]. They are known in pixels that many samples have seen. Other pixels were seen by one
// sample, as their light changes smoothly. Blocks may be marked as unknown in all their pixels; their memory
// is then undefined.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "render/vocabulary/image.h"
#include "render/vocabulary/spectrum.h"

namespace hilcam {

// Three differences, from -1 to 1 each: right half less left half, lower half less upper half, and the upper
// left and lower right quarters less the other two.
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
// Returns the moments of light at one place in its pixel, measured from the pixel's corner [px].
constexpr SubpixelMoments subpixel_moments_at(float x_px, float y_px) {
    const auto half = [](float at) { return at > 0.5f ? 1.0f : (at < 0.5f ? -1.0f : 0.0f); };
    const float across = half(x_px), down = half(y_px);
    return {across, down, across * down};
}

// The way in which a pixel's differences are known.
enum class SubpixelKind : std::uint8_t {
    kSmooth,      // by one sample, which stands for the whole pixel
    kBackground,  // by many samples, none of which sees an object
    kObject,      // by many samples, of which at least one sees an object
};

class SubpixelLight {
  public:
    static constexpr int kDifferences = 3;  // in the order of SubpixelMoments

    // responses: charge rate of each channel by radiance [e- s^-1 per W m^-2 sr^-1 um^-1], at least one.
    // Blocks are squares of block_px.
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
    // True when the present frame was made with differences. The maker of the frame sets it.
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
    // True when the block that holds pixel (x, y) is marked as unknown.
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
