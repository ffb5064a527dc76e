#pragma once
// Convolution of a frame with a small point spread function: two passes with a few weights, along rows and
// along columns, instead of an FFT pair.
//
// A transfer function has such a kernel if it is a product of a function of u and one of v (a Gaussian blur,
// a square pixel) and is close to zero at the image's Nyquist frequency. The kernel's transfer function then
// differs from it by at most kMaxError anywhere. That is less than the aliasing caused by the sampling of the
// radiance image.

#include <optional>
#include <vector>

#include "sensor/convolution/convolve.h"

namespace hilcam {

class CompactKernel {
  public:
    static constexpr int kMaxRadius = 5;  // beyond it, the FFT pair is faster
    static constexpr double kMaxError = 2.5e-3;

    // Returns nothing when the function is not such a product, or its kernel is too wide. Owner thread.
    static std::optional<CompactKernel> find(const Transfer& transfer, int width, int height);

    int radius() const { return static_cast<int>(across_.size() / 2); }
    // Returns the factor by which run() multiplies a frequency [cycles/px].
    double at(double u, double v) const;
    // Convolves layer 0 in place, instead of image.run(). The surroundings of the image count as zero. Loop:
    // no allocation, no lock.
    void run(Convolver& image);

  private:
    std::vector<float> across_, down_;  // 2 radius + 1 weights
    std::vector<float> filtered_;       // rows after the first pass
    std::vector<std::uint8_t> lit_;     // rows that are not all zero
};

}  // namespace hilcam
