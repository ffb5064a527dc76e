#pragma once
// Light on the detector: radiance image and points in, photo-electrons of every pixel out, as if all pixels
// were alike.
//
// Radiance is weighted by S (optics.h), convolved by MTF_sys (system_mtf.h) and sampled at the pixels'
// centres; where light falls in its pixel moves it (convolution/subpixel_light_adder.h); points get their PSF
// (convolution/psf.h). A colour filter array makes a channel of each filter: an image of its own, of which only that filter's
// pixels are read. Ringing of a band-limited edge can dip below zero and overflow could leave infinities; charge is neither, so
// results are cut off at 0 and 1e9 e-.

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

    // These functions are called in this order each frame. Loop, one thread at a time.
    void collapse(const RadianceImage& radiance, const Exposure& exposure);
    void convolve(const RadianceImage& radiance, const Exposure& exposure);
    // Writes into the light-sensitive part of the read-out array; black pixels get 0. beside: light from beside
    // the picture.
    void gather(std::span<const PointSource> points, std::span<const SideLight> beside,
                const Exposure& exposure, ElectronImage& light_e);

    // Modulus of MTF_sys, of the first channel in the middle of the field [cycles/px of the detector].
    double mtf(double u, double v) const;
    // One bare FFT pair, for benchmarks.
    void run_fft_pair();
    // The radius of the compact kernel by which the picture is convolved [px of the radiance image]; 0: by
    // FFT.
    int kernel_radius() const;

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace hilcam
