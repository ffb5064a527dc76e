#pragma once
// The picture before the lens, as rays have found it.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "render/vocabulary/image.h"
#include "render/vocabulary/subpixel_light.h"

namespace hilcam {

// Band-averaged spectral radiance at the aperture [W m^-2 sr^-1 um^-1], a plane per spectral bin. Or, for one
// given detector, the charge rate of its channels on the axis [e- s^-1], a plane per channel. Most of a
// picture of space is black: the writer may mark blocks in which every plane is zero, and readers may skip
// those. A new image has no marks.
class RadianceImage : public Image<float, struct RadianceQuantity> {
  public:
    static constexpr int kBlock_px = 32;

    RadianceImage() = default;
    RadianceImage(int width, int height, int planes = 1)
        : Image(width, height, planes),
          blocks_across_((width + kBlock_px - 1) / kBlock_px),
          dark_(static_cast<std::size_t>(blocks_across_) *
                    static_cast<std::size_t>((height + kBlock_px - 1) / kBlock_px),
                0) {}

    // Makes an image of charge rates. responses: of the channels [e- s^-1 per W m^-2 sr^-1 um^-1], at least
    // one.
    RadianceImage(int width, int height, std::vector<Spectrum> responses)
        : RadianceImage(width, height, static_cast<int>(responses.size())) {
        responses_ = std::move(responses);
    }
    // Empty: the image holds radiance.
    std::span<const Spectrum> responses() const { return responses_; }

    // True when the block that holds pixel (x, y) is marked as dark.
    bool dark(int x, int y) const { return dark_[block(x, y)] != 0; }
    void mark_dark(int x, int y, bool dark) { dark_[block(x, y)] = dark ? 1 : 0; }
    void clear_marks() { std::fill(dark_.begin(), dark_.end(), std::uint8_t{0}); }

    // Adds memory for the sub-pixel moments of each pixel, for channels with these responses
    // (subpixel_light.h).
    void keep_moments(std::vector<Spectrum> responses) {
        moments_.emplace(width(), height(), kBlock_px, std::move(responses));
    }
    // Null when moments are not kept.
    SubpixelLight* moments() { return moments_ ? &*moments_ : nullptr; }
    const SubpixelLight* moments() const { return moments_ ? &*moments_ : nullptr; }

  private:
    std::size_t block(int x, int y) const {
        return static_cast<std::size_t>(y / kBlock_px * blocks_across_ + x / kBlock_px);
    }
    int blocks_across_ = 0;
    std::vector<std::uint8_t> dark_;
    std::vector<Spectrum> responses_;
    std::optional<SubpixelLight> moments_;
};

}  // namespace hilcam
