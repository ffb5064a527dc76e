#pragma once
// Point sources on the detector. A point is not band-limited on the pixel grid, so it does not go through the
// image's FFT: its electrons are the pixel-integrated point spread function at its exact place, aliasing and
// all.
//
// The PSF is the inverse transform of optics MTF x pixel aperture MTF up to the optics' cut-off, tabulated at
// 1/16 px over 64 px and interpolated by cubic convolution (Keys, IEEE Trans. ASSP 29(6), 1981). With a fill
// factor of 1 its sum over the pixels is 1 within 1e-4 wherever the point falls; with gaps between pixels it
// varies as on a real detector, about the fill factor. What falls farther than 31 px from the point is lost
// (Airy wings: about 1 % at f/4 and 5.5 um).

#include <vector>

#include "render/image.h"
#include "sensor/mtf.h"

namespace hilcam {

class PointSpread {
  public:
    PointSpread(const CameraModel& camera, const OpticsMtf& optics);

    // Adds `electrons` (on a full-fill detector) at a position [px; centre of pixel (0, 0) at (0.5, 0.5)]
    // that may lie outside. The square that is touched is as large as it takes to leave out less than 0.05
    // e-. Loop; one thread.
    void add(double x_px, double y_px, double electrons, ElectronImage& image);

  private:
    static constexpr int kOversampling = 16;
    static constexpr int kField_px = 64;
    static constexpr int kMostRadius_px = 30;

    // Samples of one phase lie together: phases_[py][px][y][x].
    const float* phase(int px, int py) const;
    int radius_for(double electrons) const;

    std::vector<float> phases_;
    std::vector<double> outside_;  // share of the light outside a square of half width r
    std::vector<float> kernel_;
};

}  // namespace hilcam
