#pragma once
// Point sources on the detector. A point is not band-limited on the pixel grid, so it does not go through the
// image's FFT: its electrons are the pixel-integrated point spread function at its exact place, aliasing and
// all.
//
// The PSF is the inverse transform of MTF_sys up to 8 cycles/px, tabulated at 1/16 px over 64 px and
// interpolated by cubic convolution (Keys, IEEE Trans. ASSP 29(6), 1981), for faint points by lines. Every
// electron is kept: what falls farther than 32 px from the point (Airy wings, halo: about 1 % at f/4 and 5.5
// um) is folded into the 64 px, and what a smaller square leaves out is given to those inside. With a fill
// factor of 1 the sum over the pixels is then 1 within 1e-6 wherever the point falls; with gaps between
// pixels it varies as on a real detector, about the fill factor.

#include <array>
#include <complex>
#include <functional>
#include <span>
#include <vector>

namespace hilcam {

// Part of a point's image: a square of pixels.
struct PointPatch {
    int left = 0, top = 0, size = 0;
    const float* electrons = nullptr;  // size x size
};

class PointSpread {
  public:
    // transfer: of cycles/px. Owner thread.
    PointSpread(const std::function<std::complex<double>(double u, double v)>& transfer, double fill_factor);

    static constexpr int kField_px = 64;  // farther light comes back from the other side
    static constexpr int kMaxRadius_px = 30;
    static constexpr int kMaxAcross_px = 2 * kMaxRadius_px + 1;
    using Room = std::array<float, std::size_t{kMaxAcross_px} * kMaxAcross_px>;

    // The image of `electrons` (on a full-fill detector) at a position [px; centre of pixel (0, 0) at (0.5,
    // 0.5)]: as large as it takes to leave out less than 0.05 e-. It lies in `room`. Loop; any thread.
    PointPatch at(double x_px, double y_px, double electrons, Room& room) const;
    // Pixels from the middle one of that image to its edge.
    int radius_for(double electrons) const;

  private:
    static constexpr int kOversampling = 16;
    static constexpr int kMinRadius_px = 3;
    // Points are interpolated linearly where that is off by less [e-] in any pixel.
    static constexpr double kLinear_e = 0.005;
    // The smallest images need at least this of a phase: eight rows of eight pixels, four lines of a cache.
    static constexpr int kCoreAcross_px = 8, kCoreSize = kCoreAcross_px * kCoreAcross_px;
    static_assert(kCoreAcross_px >= 2 * kMinRadius_px + 2);

    // Samples of one phase lie together: phases_[py][px][y][x].
    const float* phase(int px, int py) const;
    void copy_core();

    std::vector<float> phases_;
    std::vector<float> core_;  // core_[py][px][y][x], and two rows that are read but not used
    double linear_error_ = 0;  // error of a line between phases, per electron of a point
    std::vector<double> phase_sums_;
    std::vector<double> outside_;  // share of the light outside a square of half width r
};

}  // namespace hilcam
