#pragma once
// Point sources on the detector. A point is not band-limited on the pixel grid, so it does not go through the
// image's FFT: its electrons are the pixel-integrated point spread function at its exact place, aliasing and
// all.
//
// The PSF is the inverse transform of MTF_sys up to 8 cycles/px, tabulated at 1/16 px over 64 px and
// interpolated by cubic convolution (Keys, IEEE Trans. ASSP 29(6), 1981), for faint points by lines. Every
// electron is kept: what falls farther than 32 px from the point (Airy wings, halo: about 1 % at f/4 and 5.5
// um) is folded into the 64 px, but for the halo of bright points (stray/point_halos.h), and what a smaller
// square leaves out is given to those inside. With a fill factor of 1 the sum over the pixels is then 1 within
// 1e-6 wherever the point falls; with gaps between pixels it varies as on a real detector, about the fill
// factor.

#include <array>
#include <complex>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "sensor/convolution/point_tables.h"

namespace hilcam {

// Part of a point's image: a square of pixels. Its rows begin `pitch` apart, a multiple of eight, and hold
// zeros beyond the square.
struct PointPatch {
    int left = 0, top = 0, size = 0, pitch = 0;
    const float* electrons = nullptr;
};

// Pixels of a picture, first to end, and where pixel (0, 0) is, or would be.
struct PictureWindow {
    int first_x, first_y, end_x, end_y;
    float* origin;
    std::ptrdiff_t pitch;
};

class PointSpread {
  public:
    // transfer: of cycles/px. Owner thread.
    PointSpread(const std::function<std::complex<double>(double u, double v)>& transfer, double fill_factor);

    // The same less a share that is drawn otherwise: taken_off(x, y) is that of a pixel whose centre lies so far from the point
    // [px], on a full-fill detector, with what of it the table has folded in. Owner thread.
    PointSpread less(const std::function<double(double x_px, double y_px)>& taken_off) const;

    static constexpr int kField_px = 64;  // farther light comes back from the other side
    static constexpr int kMaxRadius_px = 30;
    static constexpr int kMaxAcross_px = 2 * kMaxRadius_px + 1;
    static_assert(kMaxAcross_px <= kField_px);
    struct alignas(64) Room : std::array<float, std::size_t{kMaxAcross_px} * kField_px> {};

    // The image of `electrons` (on a full-fill detector) at a position [px; centre of pixel (0, 0) at (0.5,
    // 0.5)]: as large as it takes to leave out less than 0.05 e-. It lies in `room`. Loop; any thread.
    PointPatch at(double x_px, double y_px, double electrons, Room& room) const;
    // Adds those rows of that image that a window has, where its columns are all there, and up to seven beside it,
    // and the point is not one of a few electrons; else returns false. Loop; any thread.
    bool add(double x_px, double y_px, double electrons, const PictureWindow& window) const;
    // Pixels from the middle one of that image to its edge.
    int radius_for(double electrons) const;

  private:
    static constexpr int kOversampling = 16;
    static constexpr int kMinRadius_px = 3;
    static constexpr double kOutside_e = 0.05;  // an image leaves out less
    // Points are interpolated linearly where that is off by less [e-] in any pixel.
    static constexpr double kLinear_e = 0.005;
    // The least image has seven pixels in each of seven rows, and its tables eight: a zero is beside them, and a
    // row of zeros below.
    static constexpr int kMinAcross_px = 2 * kMinRadius_px + 1, kMinPitch_px = kMinAcross_px + 1;
    static constexpr int kRadii = kMaxRadius_px + 1;
    static constexpr int kMinSize = kMinPitch_px * kMinPitch_px;
    // Such tables for a point's place in its pixel: its centre lies half a pixel away at most, and a cubic's
    // samples one sixteenth farther.
    static constexpr int kPlaces = kOversampling / 2 + 1, kPlacesAcross = 2 * kPlaces + 1;

    struct Place;

    // Samples of one phase lie together: phases_[py][px][y][x].
    const float* phase(int px, int py) const;
    float value(int x, int y, int px, int py) const;
    void sum_up();
    double whole_at(int x, int y) const;
    double inside_at(int x, int y, int radius_px) const;
    bool is_linear(double electrons, int ring_px) const;
    void find_linear_errors();
    void make_places();
    const float* least_table(int x, int y) const;
    template <std::size_t kSamples>
    PointPatch least(const Place& place, const std::array<double, kSamples>& x_weights,
                     const std::array<double, kSamples>& y_weights, double electrons, Room& room) const;
    LargeImage large(const Place& place, int radius_px, double electrons) const;

    double fill_factor_;
    std::vector<float> phases_;  // and a row that is read but not used
    std::vector<float> least_;   // least_[place y][place x][y][x]; with the light that the square leaves out
    // Error of a line between phases per electron of a point, by ring about the middle pixel: there and beyond.
    std::vector<double> linear_errors_;
    std::vector<double> inside_;  // inside_[place y][place x][r]; sum over a square of half width r
    std::vector<double> phase_sums_;
    std::vector<double> outside_;  // share of the light outside a square of half width r
};

}  // namespace hilcam
