#pragma once
// Light of points on the detector: stars, things smaller than a pixel, and pixels of the picture that are far
// too bright for its FFT (the Sun, a mirror's glint of it).
//
// A point that moves through the exposure is drawn as many, half a pixel apart; one that jitters, as a grid
// of them half a standard deviation apart, out to three, by the normal density.

#include <span>
#include <vector>

#include "render/image.h"
#include "render/point_source.h"
#include "sensor/far_wings.h"
#include "sensor/light_channel.h"

namespace hilcam {

// A pixel of the picture that is drawn as a point.
struct BrightPixel {
    Vec2d position_px;  // of the detector's frame
    double electrons = 0;
    int channel = 0;
};

class PointLight {
  public:
    // wings: of each channel's bright pixels.
    PointLight(const DetectorView& view, std::vector<LightChannel>& channels,
               const std::vector<FarWings>& wings, int bins);

    // In this order each frame; loop, one thread. light_e: the read-out array.
    void begin(const Exposure& exposure);
    void add(const PointSource& point, ElectronImage& light_e);
    void add(const BrightPixel& pixel, ElectronImage& light_e);
    // What glare spreads evenly of all that was added.
    void add_glare(ElectronImage& light_e) const;

    // Of this exposure: standard deviation of what a jitter's density leaves within it [px], 0 if not seen.
    double jitter_px() const { return jitter_px_; }

  private:
    template <class Draw>
    void along_trail(Vec2d middle_px, Vec2d drift_px, const Vec3d& turn_rad, const Draw& draw) const;
    template <class Draw>
    void scatter(Vec2d at_px, const Draw& draw) const;
    void draw_point(int channel, Vec2d at_px, double electrons, ElectronImage& light_e);
    void add_patch(const PointPatch& patch, int channel, ElectronImage& light_e) const;
    void take_off_wings(Vec2d at_px, int channel, double electrons, ElectronImage& light_e);

    const DetectorView& view_;
    std::vector<LightChannel>& channels_;
    int bins_;
    Exposure exposure_;
    double jitter_px_ = 0;
    std::vector<double> glare_e_;  // by channel
    // Of each channel: what the wings give near a point, and what the table has folded in of them.
    std::vector<std::vector<double>> near_wings_;
    std::vector<float> patch_;
};

}  // namespace hilcam
