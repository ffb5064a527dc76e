#pragma once
// One FFT pair per frame: multiplies an image's spectrum by a transfer function. The convolution is circular;
// the guard band takes what wraps around. For a lens that varies over the field there is a layer for each
// field zone: each layer is transformed and multiplied by its own function, and their sum is transformed
// back.
//
// Single precision. Runs on oneTBB as columns, rows (forward, transfer function and back while they are in
// cache) and columns again. The result does not depend on the number of threads, the run or the processor.

#include <complex>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "render/vocabulary/vec.h"

namespace hilcam {

// A transfer function of frequencies u, v in -0.5 .. 0.5 [cycles/px of the image].
using Transfer = std::function<std::complex<double>(double u, double v)>;

// The additional blur of a single frame: motion of the whole picture during the exposure, and a factor that
// is a product of the same function of u and of v.
struct FrameBlur {
    Vec2d smear_px{};                      // motion from start to end, at constant speed
    Vec2d sigma_px{};                      // standard deviations of a Gaussian along x and y
    std::function<double(double)> axis{};  // another factor, applied to |u| and to |v|; empty: 1

    bool none() const {
        return smear_px.x == 0 && smear_px.y == 0 && sigma_px.x == 0 && sigma_px.y == 0 && !axis;
    }
};

// Returns the smallest even number from n on with no prime factors other than 2, 3, 5 and 7; an FFT of other
// sizes takes several times as long.
int fft_size(int n);

class Convolver {
  public:
    // Width and height must have no other prime factors than fft_size() allows. Each function is called once
    // for every frequency pair. The transform of the image must be real, so values at opposite frequencies
    // must be complex conjugates. Owner thread.
    Convolver(int width, int height, const std::vector<Transfer>& transfers);
    ~Convolver();
    Convolver(Convolver&&) noexcept;

    int width() const { return width_; }
    int height() const { return height_; }
    int layers() const;
    // Returns row y of a layer, 64-byte aligned. Fill the rows before run(); afterwards layer 0 holds the
    // result.
    std::span<float> row(int y, int layer = 0);
    std::span<const float> row(int y, int layer = 0) const;
    // Loop: no lock, and no allocation after the first call with this thread pool.
    void run(const FrameBlur& blur = {});

  private:
    struct Implementation;
    int width_;
    int height_;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace hilcam
