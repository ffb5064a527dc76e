#pragma once
// One FFT pair per frame: multiplies an image's spectrum by a transfer function. Circular; the guard band
// takes what wraps around. A lens that differs over the field has several layers, one for each of its zones:
// each is transformed and multiplied by its own function, and their sum is transformed back.
//
// Single precision; run as columns, rows (forward, transfer function and back while they are in cache) and
// columns again on oneTBB. The result depends neither on the thread count nor on the run nor on the
// processor.

#include <complex>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "render/vocabulary/vec.h"

namespace hilcam {

// A transfer function takes the frequencies u, v in -0.5 .. 0.5 [cycles/px of the image].
using Transfer = std::function<std::complex<double>(double u, double v)>;

// One frame's own blur: motion while it is taken, of all of it alike, and what else is a product of the same
// function of u and of v.
struct FrameBlur {
    Vec2d smear_px{};                      // from start to end, at constant speed
    Vec2d sigma_px{};                      // Gaussian, along x and y
    std::function<double(double)> axis{};  // a further factor, of |u| and of |v|; none: 1

    bool none() const {
        return smear_px.x == 0 && smear_px.y == 0 && sigma_px.x == 0 && sigma_px.y == 0 && !axis;
    }
};

// The least even number from n on whose prime factors are 2, 3, 5 and 7: others cost an FFT several times
// more.
int fft_size(int n);

class Convolver {
  public:
    // Width and height have no prime factors but those of fft_size. Each function is asked once for every
    // frequency pair. The image's transform must be real, so of values at opposite frequencies one is the
    // other's conjugate. Owner thread.
    Convolver(int width, int height, const std::vector<Transfer>& transfers);
    ~Convolver();
    Convolver(Convolver&&) noexcept;

    int width() const { return width_; }
    int height() const { return height_; }
    int layers() const;
    // Row y of a layer: filled before run(); after it layer 0 holds the result. 64-byte aligned.
    std::span<float> row(int y, int layer = 0);
    std::span<const float> row(int y, int layer = 0) const;
    // Loop: no allocation after the first call with this thread pool, no lock.
    void run(const FrameBlur& blur = {});

  private:
    struct Implementation;
    int width_;
    int height_;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace hilcam
