#pragma once
// Three small kernels that correct a convolved picture for where light falls within its pixels
// (subpixel_light.h), one for each of the differences.
//
// A pixel's light is modelled as four equal points at the centres of its quarters; the differences move light
// between them. Let p(x, y) be the image of a point, sampled twice as densely as pixels in each direction,
// with (x, y) the vector from the point to a pixel's centre [px]. The difference of the right and left halves
// then adds to that pixel
//     (p(x - 1/4, y - 1/4) - p(x + 1/4, y - 1/4) + p(x - 1/4, y + 1/4) - p(x + 1/4, y + 1/4)) / 4,
// and the other two differences add corresponding terms. The picture as a whole is convolved as if light
// changed smoothly from pixel to pixel, with the differences that this implies (smooth_difference(),
// smooth_transfer()). The kernels apply to known deviations from these. The approximation: effects beyond
// reach_px() are left out, less than kMaxRest of the light for each difference.

#include <array>
#include <complex>
#include <span>
#include <vector>

#include "sensor/convolution/convolve.h"

namespace hilcam {

// Returns the difference of the right half's mean and the left one's [in units of twice the pixel's mean] for
// light that changes smoothly, from the means of pixels one and two to either side. Right up to 0.3 cycles
// per pixel (within 3 %).
inline constexpr float kNextWeight = 0.2071068f;  // tan(pi / 8) / 2: exact at 1/4 cycle per pixel
inline constexpr float kSecondWeight = (0.125f - kNextWeight) / 2;  // exact for even slower changes
constexpr float smooth_difference(float second_left, float left, float right, float second_right) {
    return kNextWeight * (right - left) + kSecondWeight * (second_right - second_left);
}

// Returns the transfer function for a picture of pixels with smooth differences, including the aliasing
// caused by the pixels' sampling. u, v: in cycles per pixel. fine: transfer function of light by halves,
// called up to frequency 1.
std::complex<double> smooth_transfer(const Transfer& fine, double u, double v);

class MomentKernels {
  public:
    static constexpr double kMaxRest = 5e-3;
    static constexpr int kMaxReach_px = 8, kBlock_px = 32;
    static constexpr int kSide_px = kBlock_px + 2 * kMaxReach_px;
    // Differences in a block and around it, in the order of SubpixelMoments, minus the smooth ones; row by
    // row.
    static constexpr std::size_t kParts = 3;
    using Parts = std::array<std::array<float, kSide_px * kSide_px>, kParts>;

    // Owner thread.
    explicit MomentKernels(const Transfer& fine);

    // Makes the kernels for a frame's blur (without its `axis`). Returns false when the blur is so wide that
    // the kernels would not reach far enough. Loop: no allocation, no lock; one thread.
    bool prepare(const FrameBlur& blur);
    int reach_px() const { return reach_px_; }
    // Returns the weight of a difference (0 to 2) for the pixel at (x, y) relative to it.
    float weight(std::size_t part, int x, int y) const;

    // Adds the effect of the differences in a block and around it to the block: `rows` rows of `columns`
    // pixels, at most kBlock_px, stride floats apart. Loop, any thread.
    void add(const Parts& parts, int columns, int rows, float* out, std::size_t stride) const;

  private:
    static constexpr int kAcross = 2 * kMaxReach_px + 1;

    std::vector<float> point_;  // image of a point; negative places are at the end
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
