#pragma once
// Spectra on a grid over the unit square, bilinear in between.

#include <algorithm>
#include <cstddef>
#include <vector>

#include "render/vocabulary/spectrum.h"

namespace hilcam {

class SpectrumTable {
  public:
    // At least 2 x 2, all zero.
    SpectrumTable(int width, int height)
        : width_(width), height_(height), cells_(static_cast<std::size_t>(width * height)) {}
    int width() const { return width_; }
    int height() const { return height_; }
    Spectrum& at(int x, int y) { return cells_[static_cast<std::size_t>(y * width_ + x)]; }
    // u, v: clamped to 0..1, where the outermost cells are. Loop, any thread.
    Spectrum operator()(double u, double v) const {
        const double x = std::clamp(u, 0.0, 1.0) * (width_ - 1), y = std::clamp(v, 0.0, 1.0) * (height_ - 1);
        const int x0 = std::min(static_cast<int>(x), width_ - 2),
                  y0 = std::min(static_cast<int>(y), height_ - 2);
        const auto fx = static_cast<float>(x - x0), fy = static_cast<float>(y - y0);
        const Spectrum* row = cells_.data() + y0 * width_ + x0;
        Spectrum out = ((1 - fx) * (1 - fy)) * row[0];
        out += (fx * (1 - fy)) * row[1];
        out += ((1 - fx) * fy) * row[width_];
        out += (fx * fy) * row[width_ + 1];
        return out;
    }
    std::vector<Spectrum>& cells() { return cells_; }
    const std::vector<Spectrum>& cells() const { return cells_; }

  private:
    int width_, height_;
    std::vector<Spectrum> cells_;
};

}  // namespace hilcam
