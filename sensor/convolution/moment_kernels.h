#pragma once
// Three small kernels change a convolved picture by what is known of parts of its pixels (subpixel_light.h), one for each
// of the differences.
//
// A pixel's light is a quarter each from the middles of its quarters, plus what its differences move between them. With
// p(x, y) the image of a point by samples that are twice as dense each way as pixels, (x, y) from it to a pixel's
// middle [px], the difference of the right half and the left one adds to that pixel
//     (p(x - 1/4, y - 1/4) - p(x + 1/4, y - 1/4) + p(x - 1/4, y + 1/4) - p(x + 1/4, y + 1/4)) / 4,
// and likewise for the other two. The picture as a whole is convolved as if light changed smoothly from pixel to pixel,
// with the differences that follow from that (smooth_difference(), smooth_transfer()); the kernels are for those that are
// known to be others. The approximation: what the three change further away than reach_px() is left out, less than
// kMaxRest of the light in each.

#include <array>
#include <complex>
#include <span>
#include <vector>

#include "sensor/convolution/convolve.h"

namespace hilcam {

// Returns the difference of the right half's mean and the left one's [of twice the pixel's mean] in light that changes
// smoothly, from the means of pixels one and two to either side: a fifth of the way to them is right up to 0.3 cycles per
// pixel (within 3 %).
inline constexpr float kNextWeight = 0.2071068f;  // tan(pi / 8) / 2: exact at 1/4 cycle per pixel
inline constexpr float kSecondWeight = (0.125f - kNextWeight) / 2;  // exact for what is even slower
constexpr float smooth_difference(float second_left, float left, float right, float second_right) {
    return kNextWeight * (right - left) + kSecondWeight * (second_right - second_left);
}

// Frequencies in cycles per pixel. fine: the transfer function of light by halves, asked to 1. Returns that of a picture of
// pixels whose differences are smooth, with what the pixels' sampling folds back.
std::complex<double> smooth_transfer(const Transfer& fine, double u, double v);

class MomentKernels {
  public:
    static constexpr double kMaxRest = 5e-3;
    static constexpr int kMaxReach_px = 8, kBlock_px = 32;
    static constexpr int kSide_px = kBlock_px + 2 * kMaxReach_px;
    // Differences of a block and about it, in the order of SubpixelMoments, less the smooth ones; row by row.
    static constexpr std::size_t kParts = 3;
    using Parts = std::array<std::array<float, kSide_px * kSide_px>, kParts>;

    // Owner thread.
    explicit MomentKernels(const Transfer& fine);

    // Makes the kernels of a frame's blur (its `axis` apart). False: it blurs by so much that they would not
    // reach far enough. Loop: no allocation, no lock; one thread.
    bool prepare(const FrameBlur& blur);
    int reach_px() const { return reach_px_; }
    // Returns the weight of a difference (0 to 2) in the pixel at (x, y) from it.
    float weight(std::size_t part, int x, int y) const;

    // Adds what a block's parts, and those about it, give to its rows: `rows` of `columns` pixels, at most kBlock_px,
    // stride floats apart. Loop, any thread.
    void add(const Parts& parts, int columns, int rows, float* out, std::size_t stride) const;

  private:
    static constexpr int kAcross = 2 * kMaxReach_px + 1;

    std::vector<float> point_;  // the image of a point; what lies before it is at the end
    int still_reach_px_ = 0, reach_px_ = 0;
    FrameBlur prepared_;
    std::array<std::array<float, kAcross * kAcross>, kParts> weights_{};

    static std::size_t index_of(int x, int y) {
        return static_cast<std::size_t>((y + kMaxReach_px) * kAcross + x + kMaxReach_px);
    }
    void make_weights(const FrameBlur& blur);
    double rest_beyond(int reach_px) const;
};

}  // namespace hilcam
