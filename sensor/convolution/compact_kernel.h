#pragma once
// The convolution of a frame where its point spread function is small: two passes of a few weights, along the
// rows and along the columns, instead of an FFT pair.
//
// A transfer function has such a kernel when it is a product of one function of u and one of v (a Gaussian
// blur, a square pixel) that is close to zero at the image's Nyquist frequency. The kernel's own transfer
// function then differs from it by at most kMaxError anywhere, less than what the sampling of the radiance
// image folds back.

#include <optional>
#include <vector>

#include "sensor/convolution/convolve.h"

namespace hilcam {

class CompactKernel {
  public:
    static constexpr int kMaxRadius = 5;  // beyond, the FFT pair is faster
    static constexpr double kMaxError = 2.5e-3;

    // None where the function is no such product, or its kernel too wide. Owner thread.
    static std::optional<CompactKernel> find(const Transfer& transfer, int width, int height);

    int radius() const { return static_cast<int>(across_.size() / 2); }
    // Returns the factor that run() applies to a frequency [cycles/px].
    double at(double u, double v) const;
    // In place of image.run(): layer 0's rows. Beyond the image is nothing. Loop: no allocation, no lock.
    void run(Convolver& image);

  private:
    std::vector<float> across_, down_;  // 2 radius + 1 weights
    std::vector<float> filtered_;       // rows after the first pass
    std::vector<std::uint8_t> lit_;     // rows that are not all zero
};

}  // namespace hilcam
