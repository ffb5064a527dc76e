#pragma once
// One FFT pair per frame: multiplies an image's spectrum by MTF_sys. Circular; the guard band takes what
// wraps around.
//
// Single precision, FFTW, planned once at construction; run as rows, columns
// (forward, MTF and back while they are in cache) and rows again on oneTBB. The result depends
// neither on the thread count nor on the run.

#include <functional>
#include <memory>
#include <span>

namespace hilcam {

class Convolver {
  public:
    // `mtf` is asked once for every frequency pair, |u|, |v| <= 0.5 [cycles/px]. Owner thread.
    Convolver(int width, int height, const std::function<double(double u, double v)>& mtf);
    ~Convolver();

    int width() const { return width_; }
    int height() const { return height_; }
    // Row y of the working image: filled before run(), read after it. 64-byte aligned.
    std::span<float> row(int y);
    std::span<const float> row(int y) const;
    // Loop: no allocation after the first call with this thread pool, no lock.
    void run();

  private:
    struct Implementation;
    int width_;
    int height_;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace hilcam
