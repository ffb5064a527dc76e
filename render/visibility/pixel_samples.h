#pragma once
// The samples of a pixel in the visibility buffer: a grid of 4 x 4, or of 8 x 8, for which the buffer has
// twice as many pixels in each direction. In the latter case sample 16 q + i is sample i of quarter q: upper
// left, upper right, lower left, lower right.

#include <bit>
#include <cstdint>

#include "render/visibility/visibility_samples.h"
#include "render/vocabulary/subpixel_light.h"
#include "render/vocabulary/vec.h"

namespace hilcam {

class PixelSamples {
  public:
    // across: 4 or 8.
    explicit constexpr PixelSamples(int across = kVisibilitySamplesAcross)
        : quarters_(across == kVisibilitySamplesAcross ? 1 : 4) {}

    // Returns the pixels of the buffer per pixel of the picture, in each direction.
    constexpr int buffer_px() const { return quarters_ == 1 ? 1 : 2; }
    constexpr int across() const { return buffer_px() * kVisibilitySamplesAcross; }
    constexpr int quarters() const { return quarters_; }
    constexpr SampleMask all() const { return quarters_ == 1 ? 0xFFFF : ~SampleMask{0}; }
    // Returns the weight of these samples, where a whole pixel has 16.
    float weight(SampleMask samples) const {
        return static_cast<float>(std::popcount(samples)) / static_cast<float>(quarters_);
    }
    // Returns the place of a sample in its pixel [px from the corner].
    constexpr Vec2f place(int sample) const {
        const int i = sample % kVisibilitySamples, quarter = sample / kVisibilitySamples;
        if (quarters_ == 1) return {sample_x(i), sample_y(i)};
        return {(static_cast<float>(quarter % 2) + sample_x(i)) / 2,
                (static_cast<float>(quarter / 2) + sample_y(i)) / 2};
    }
    // Returns the sample, or the four samples, at place i of a grid of 4 x 4.
    constexpr SampleMask about(int i) const {
        if (quarters_ == 1) return SampleMask{1} << i;
        const int column = i % 4, row = i / 4;
        const int first = 2 * (row % 2) * kVisibilitySamplesAcross + 2 * (column % 2);
        constexpr SampleMask kFour = 0x33;  // two in a row, and two below
        return kFour << (first + kVisibilitySamples * (2 * (row / 2) + column / 2));
    }
    // Returns where to look for what these samples see: the place of the sample nearest to their middle,
    // because the middle itself may show something else. At least one sample.
    Vec2f middle(SampleMask samples) const;
    // Returns the sub-pixel moments of these samples.
    SubpixelMoments moments(SampleMask samples) const;

  private:
    int quarters_;
};

// Takes one of the remaining samples, far from those taken before, and removes its neighbours from the
// remaining ones. When none remains, all are available again. At least one sample.
int next_sample(const PixelSamples& grid, SampleMask& rest, SampleMask all);
// The same in another order: of a pixel's samples, any four in succession have one in every quarter of its
// rows and of its columns, so that an edge passes between two of them wherever it is.
int next_sample_across(const PixelSamples& grid, SampleMask& rest, SampleMask all);

}  // namespace hilcam
