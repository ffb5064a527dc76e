#pragma once
// A camera on an optical bench: a target fills its view, frames are taken one after the other.
//
// The target is a Lambert plate that faces the camera with the lamp (the renderer's Sun) straight behind it,
// so that its radiance E rho / pi is the same in every direction and everywhere: what a laboratory has an
// integrating sphere for. Two plates side by side make an edge. The light is of one spectral bin. Everything
// goes the way of any frame: Renderer, SensorChain, digital numbers.

#include <memory>

#include "render/frame/renderer.h"
#include "sensor/chain.h"

namespace hilcam {

// The target before the camera. The dark half lies on the right of an upright edge, below a lying one.
struct BenchTarget {
    double bright_albedo = 1;
    double dark_albedo = 1;    // the same: no edge
    double edge_tilt_rad = 0;  // tilt of the edge through the window's middle against the image's columns
};

class CameraBench {
  public:
    // `lamp_w_m2_um`: irradiance of the plate. InputError as of SensorChain. Owner thread.
    CameraBench(const CameraModel& camera, const SpectralGrid& grid, const SensorSampling& sampling,
                double lamp_w_m2_um, const DetectorPictures& pictures);

    void show(const BenchTarget& target);
    // Sets the exposure from here on, with the light dimmed by a neutral filter (0: shutter closed).
    void expose(const Exposure& exposure, double filter);
    // The next frame; valid until the one after next is taken.
    const DnImage& frame();

    const SensorChain& chain() const { return chain_; }
    const ImageGeometry& geometry() const { return geometry_; }  // geometry of the detector's window
    std::uint64_t frames_taken() const { return frames_; }

  private:
    CameraModel camera_;
    SpectralGrid grid_;
    SensorSampling sampling_;
    double lamp_w_m2_um_;
    ImageGeometry geometry_, image_;
    SensorChain chain_;
    RadianceImage full_, dimmed_;
    double filter_ = -1;  // the filter of dimmed_
    Exposure exposure_;
    ElectronImage mean_e_;
    DnImage frame_[2];
    std::uint64_t frames_ = 0;
};

}  // namespace hilcam
