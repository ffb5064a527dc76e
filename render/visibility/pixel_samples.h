#pragma once
// The samples of a pixel that the visibility buffer finds: a grid of 4 x 4; or of 8 x 8, for which the buffer has
// twice as many pixels each way. Then sample 16 q + i is sample i of quarter q: upper left, upper right, lower
// left, lower right.

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

    // Pixels of the buffer in one of the picture, in each direction.
    constexpr int buffer_px() const { return quarters_ == 1 ? 1 : 2; }
    constexpr int across() const { return buffer_px() * kVisibilitySamplesAcross; }
    constexpr int quarters() const { return quarters_; }
    constexpr SampleMask all() const { return quarters_ == 1 ? 0xFFFF : ~SampleMask{0}; }
    // Returns how many samples of sixteen a pixel these stand for.
    float weight(SampleMask samples) const {
        return static_cast<float>(std::popcount(samples)) / static_cast<float>(quarters_);
    }
    // Returns where a sample lies in its pixel [px from the corner].
    constexpr Vec2f place(int sample) const {
        const int i = sample % kVisibilitySamples, quarter = sample / kVisibilitySamples;
        if (quarters_ == 1) return {sample_x(i), sample_y(i)};
        return {(static_cast<float>(quarter % 2) + sample_x(i)) / 2,
                (static_cast<float>(quarter / 2) + sample_y(i)) / 2};
    }
    // Returns the samples nearest to place i of a grid of 4 x 4: one, or four.
    constexpr SampleMask about(int i) const {
        if (quarters_ == 1) return SampleMask{1} << i;
        const int column = i % 4, row = i / 4;
        const int first = 2 * (row % 2) * kVisibilitySamplesAcross + 2 * (column % 2);
        constexpr SampleMask kFour = 0x33;  // two in a row, and two below
        return kFour << (first + kVisibilitySamples * (2 * (row / 2) + column / 2));
    }
    // Returns the place where to look for what some samples see: that of the sample next to their middle, as the middle
    // itself may see something else. At least one sample.
    Vec2f middle(SampleMask samples) const;
    // Returns which halves of the pixel they are in.
    SubpixelMoments moments(SampleMask samples) const;

  private:
    int quarters_;
};

// Takes one of the samples that are left of some, far from those before, and leaves out those beside it; all of them once
// more after the last. At least one sample.
int next_sample(const PixelSamples& grid, SampleMask& rest, SampleMask all);
// The same in another order: of all samples of a pixel each four have one in every quarter of its rows and of its columns, so that
// an edge passes between two of them wherever it is.
int next_sample_across(const PixelSamples& grid, SampleMask& rest, SampleMask all);

}  // namespace hilcam
