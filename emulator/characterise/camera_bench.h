#pragma once
// A camera on an optical bench: a target fills its view, and frames are taken one after the other.
//
// The target is a Lambert plate that faces the camera, with the lamp (the renderer's Sun) straight behind the
// camera. Its radiance E rho / pi is the same in every direction and at every place, as an integrating sphere
// provides in a laboratory. Two plates side by side make an edge. The light has one spectral bin. Frames go
// the usual way: Renderer, SensorChain, digital numbers.

#include <memory>

#include "render/frame/renderer.h"
#include "sensor/chain.h"

namespace hilcam {

// The target in front of the camera. The dark half is to the right of an upright edge, or below a horizontal
// one.
struct BenchTarget {
    double bright_albedo = 1;
    double dark_albedo = 1;  // the same as bright_albedo: no edge
    // Angle between the image's columns and the edge, which passes through the window's middle.
    double edge_tilt_rad = 0;
};

class CameraBench {
  public:
    // lamp_w_m2_um: irradiance of the plate. seed: the noise's. Throws InputError as SensorChain does. Owner
    // thread.
    CameraBench(const CameraModel& camera, const SpectralGrid& grid, const SensorSampling& sampling,
                double lamp_w_m2_um, const DetectorPictures& pictures, std::uint64_t seed = 1288);

    void show(const BenchTarget& target);
    // Sets the exposure of the next frames. filter: transmission of a neutral filter in the light (0: shutter
    // closed).
    void expose(const Exposure& exposure, double filter);
    // Takes the next frame. It stays valid until the frame after the next one is taken.
    const DnImage& frame();

    const SensorChain& chain() const { return chain_; }
    const ImageGeometry& geometry() const { return geometry_; }  // the detector's window
    // Takes the frame of that number: the same number, settings and target give the same frame.
    const DnImage& frame(std::uint64_t number);
    std::uint64_t frames_taken() const { return frames_; }

  private:
    CameraModel camera_;
    SpectralGrid grid_;
    SensorSampling sampling_;
    double lamp_w_m2_um_;
    ImageGeometry geometry_, image_;
    SensorChain chain_;
    std::uint64_t seed_;  // seed of the noise
    RadianceImage full_, dimmed_;
    double filter_ = -1;  // filter with which dimmed_ was made
    Exposure exposure_;
    ElectronImage mean_e_;
    DnImage frame_[2];
    std::uint64_t frames_ = 0;
};

}  // namespace hilcam
