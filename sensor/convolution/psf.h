#pragma once
// Images of point sources on the detector. A point is not band-limited on the pixel grid, so it bypasses the
// image's FFT: its electrons are the pixel-integrated point spread function at its exact place, with all
// aliasing.
//
// The PSF is the inverse transform of MTF_sys up to 8 cycles/px, tabulated at 1/16 px over 64 px and
// interpolated by cubic convolution (Keys, IEEE Trans. ASSP 29(6), 1981), for faint points linearly. All
// electrons are kept. Light farther than 32 px from the point (Airy wings, halo: about 1 % at f/4 and 5.5 um)
// is folded into the 64 px, except for the halo of bright points (stray/point_halos.h). Light outside a
// smaller square is distributed over the pixels inside. With a fill factor of 1, the sum over the pixels is
// therefore 1 within 1e-6 wherever the point falls; with gaps between pixels it varies about the fill factor,
// as on a real detector.

#include <array>
#include <complex>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "sensor/convolution/point_tables.h"

namespace hilcam {

// The image of a point: a square of pixels. Its rows begin `pitch` apart, a multiple of eight, with zeros
// beyond the square.
struct PointPatch {
    int left = 0, top = 0, size = 0, pitch = 0;
    const float* electrons = nullptr;
};

// Pixels of a picture, from first to end. origin: place of pixel (0, 0), even if outside.
struct PictureWindow {
    int first_x, first_y, end_x, end_y;
    float* origin;
    std::ptrdiff_t pitch;
};

class PointSpread {
  public:
    // transfer: function of frequencies in cycles/px. Owner thread.
    PointSpread(const std::function<std::complex<double>(double u, double v)>& transfer, double fill_factor);

    // Returns the same spread minus a share that is drawn separately. taken_off(x, y): that share of a
    // point's light in a pixel with its centre at this distance [px], on a detector with full fill factor,
    // including what the table has folded in of it. Owner thread.
    PointSpread less(const std::function<double(double x_px, double y_px)>& taken_off) const;

    static constexpr int kField_px = 64;  // light farther away wraps around to the other side
    static constexpr int kMaxRadius_px = 30;
    static constexpr int kMaxAcross_px = 2 * kMaxRadius_px + 1;
    static_assert(kMaxAcross_px <= kField_px);
    struct alignas(64) Room : std::array<float, std::size_t{kMaxAcross_px} * kField_px> {};

    // Returns the image of `electrons` (for a full fill factor) at a position [px; centre of pixel (0, 0) at
    // (0.5, 0.5)], large enough to leave out less than 0.05 e-. The image is stored in `room`. Loop; any
    // thread.
    PointPatch at(double x_px, double y_px, double electrons, Room& room) const;
    // Adds those rows of the image that are in the window. Requires all its columns in the window, with up to
    // seven more beside it, and more than a few electrons; returns false otherwise. Loop; any thread.
    bool add(double x_px, double y_px, double electrons, const PictureWindow& window) const;
    // Returns the number of pixels from the image's middle pixel to its edge.
    int radius_for(double electrons) const;

  private:
    static constexpr int kOversampling = 16;
    static constexpr int kMinRadius_px = 3;
    static constexpr double kOutside_e = 0.05;  // an image leaves out less than this
    // Points are interpolated linearly if the error is below this [e-] in every pixel.
    static constexpr double kLinear_e = 0.005;
    // The smallest image has seven rows of seven pixels. Its tables have eight, with a column and a row of
    // zeros.
    static constexpr int kMinAcross_px = 2 * kMinRadius_px + 1, kMinPitch_px = kMinAcross_px + 1;
    static constexpr int kRadii = kMaxRadius_px + 1;
    static constexpr int kMinSize = kMinPitch_px * kMinPitch_px;
    // Number of such tables over the point's place in its pixel: its centre is at most half a pixel away, and
    // the cubic's samples one sixteenth more.
    static constexpr int kPlaces = kOversampling / 2 + 1, kPlacesAcross = 2 * kPlaces + 1;

    struct Place;

    // Samples of one phase are contiguous: phases_[py][px][y][x].
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
    std::vector<float> phases_;  // followed by a row that is read but not used
    std::vector<float> least_;   // least_[place y][place x][y][x]; includes the light outside the square
    // Error of linear interpolation between phases for one electron, by ring about the middle pixel: maximum
    // from there outwards.
    std::vector<double> linear_errors_;
    std::vector<double> inside_;  // inside_[place y][place x][r]; sum over a square of half width r
    std::vector<double> phase_sums_;
    std::vector<double> outside_;  // share of the light outside a square of half width r
};

}  // namespace hilcam
