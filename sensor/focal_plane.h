#pragma once
// Light on the detector: turns radiance image and points into photo-electrons of every pixel, as if all
// pixels were alike.
//
// Radiance is weighted by S (optics.h), convolved with MTF_sys (system_mtf.h) and sampled at the pixel
// centres. Differences of light within a pixel are added (convolution/subpixel_light_adder.h), and points are
// drawn with their PSF (convolution/psf.h). With a colour filter array, each filter is a channel: an image of
// its own, of which only that filter's pixels are read. Ringing at a sharp edge can make values negative, and
// overflow could make them infinite, so results are limited to 0 .. 1e9 e-.

#include <memory>
#include <span>

#include "render/vocabulary/point_source.h"
#include "render/vocabulary/radiance_image.h"
#include "render/vocabulary/side_light.h"
#include "sensor/camera_model.h"
#include "sensor/convolution/convolve.h"
#include "sensor/exposure.h"

namespace hilcam {

class FocalPlane {
  public:
    FocalPlane(const CameraModel& camera, const SpectralGrid& grid, const SensorSampling& sampling);
    ~FocalPlane();

    // Call these functions in this order for each frame. Loop, one thread at a time.
    void collapse(const RadianceImage& radiance, const Exposure& exposure);
    void convolve(const RadianceImage& radiance, const Exposure& exposure);
    // Writes the light-sensitive part of the read-out array, and 0 into black pixels. beside: light from
    // outside the picture.
    void gather(std::span<const PointSource> points, std::span<const SideLight> beside,
                const Exposure& exposure, ElectronImage& light_e);

    // Returns the modulus of MTF_sys for the first channel at the centre of the field [cycles/px of the
    // detector].
    double mtf(double u, double v) const;
    // Runs one bare FFT pair, for benchmarks.
    void run_fft_pair();
    // Returns the radius of the compact kernel that convolves the picture [px of the radiance image]; 0: by
    // FFT.
    int kernel_radius() const;

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace hilcam
