#pragma once
// What it adds to a convolved picture that light is known by halves of its pixels (half_light.h): three small
// kernels, one for each of the differences.
//
// The picture that is convolved holds each pixel's light as if a quarter of it came from the middle of each of
// the pixel's quarters (halved_transfer()). A difference moves light from one quarter to another, and with
// p(x, y) the image of a point, (x, y) from it to a pixel's middle [px], adds to that pixel
//     across:  (p(x - 1/4, y - 1/4) + p(x - 1/4, y + 1/4) - p(x + 1/4, y - 1/4) - p(x + 1/4, y + 1/4)) / 4
// and likewise for the other two. The approximation: what light that moves by half a pixel changes further away
// than reach_px() is left out, less than kMaxRest of it in all.

#include <array>
#include <complex>
#include <span>
#include <vector>

#include "sensor/convolution/convolve.h"

namespace hilcam {

// Frequencies in cycles per pixel; `fine` is asked to 1 cycle per pixel: by halves, light is sampled twice in one.
// Returns the transfer function of a picture of light that comes alike from the four quarters' middles, with what
// the pixels' sampling folds back.
std::complex<double> halved_transfer(const Transfer& fine, double u, double v);

class HalfKernels {
  public:
    static constexpr double kMaxRest = 5e-3;
    static constexpr int kMaxReach_px = 8, kBlock_px = 32;
    static constexpr int kSide_px = kBlock_px + 2 * kMaxReach_px;
    // Differences of a block and about it, row by row.
    using Differences = std::array<std::array<float, kSide_px * kSide_px>, 3>;

    // Owner thread.
    explicit HalfKernels(const Transfer& fine);

    // Makes the kernels of a frame's blur (its `axis` apart). False: it blurs by so much that they would not
    // reach far enough. Loop: no allocation, no lock; one thread.
    bool prepare(const FrameBlur& blur);
    int reach_px() const { return reach_px_; }
    // Returns a weight: of light whose difference (0 to 2) is 1, in the pixel at (x, y) from it.
    float weight(int difference, int x, int y) const;

    // Adds a block's differences, and those about it, to its rows: `rows` of `columns` pixels, at most kBlock_px,
    // stride floats apart. Loop, any thread.
    void add(const Differences& differences, int columns, int rows, float* out, std::size_t stride) const;

  private:
    static constexpr int kFinePerPx = 8, kField_px = 32, kFine = kField_px * kFinePerPx;
    static constexpr int kAcross = 2 * kMaxReach_px + 1;

    std::vector<float>
        point_;  // the image of a point, kFinePerPx values a pixel; what lies before it is at the end
    int still_reach_px_ = 0, reach_px_ = 0;
    FrameBlur prepared_;
    std::array<std::array<float, kAcross * kAcross>, 3> weights_{};

    float point_at(double x_px, double y_px) const;
    void make_weights(const FrameBlur& blur);
    double rest_beyond(int reach_px) const;
};

}  // namespace hilcam
