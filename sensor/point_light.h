#pragma once
// Light of points on the detector: stars, things smaller than a pixel, and pixels of the picture that are far
// too bright for its FFT (the Sun, a mirror's glint of it).
//
// A point that moves through the exposure is drawn as many, half a pixel apart; one that jitters, as a grid
// of them half a standard deviation apart, out to three, by the normal density.
//
// Images of points are drawn by all threads, a band of rows each: what falls on a pixel is added in the
// points' order, whatever the number of threads.

#include <span>
#include <vector>

#include "render/vocabulary/image.h"
#include "render/vocabulary/point_source.h"
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
    void add(const BrightPixel& pixel, ElectronImage& light_e);
    void add(const PointSource& point, ElectronImage& light_e);
    // The last of the points, and what glare spreads evenly of all that was added.
    void finish(ElectronImage& light_e);

    // Of this exposure: standard deviation of what a jitter's density leaves within it [px], 0 if not seen.
    double jitter_px() const { return jitter_px_; }

  private:
    // An image of a point that is still to be drawn.
    struct Spot {
        Vec2d at_px;
        double electrons = 0;
        int channel = 0;
        int radius_px = 0;
    };
    // Rows of the window that a thread draws on.
    struct Rows {
        int begin, end;
    };

    template <class Draw>
    void along_trail(Vec2d middle_px, Vec2d drift_px, const Vec3d& turn_rad, const Draw& draw) const;
    template <class Draw>
    void scatter(Vec2d at_px, const Draw& draw) const;
    Spot spot_of(int channel, Vec2d at_px, double electrons);
    void draw(const Spot& spot, Rows rows, ElectronImage& light_e) const;
    void draw_spots(ElectronImage& light_e);
    void add_patch(const PointPatch& patch, int channel, Rows rows, ElectronImage& light_e) const;
    Rows all_rows() const { return {0, view_.detector.height_px}; }
    void add_glare(ElectronImage& light_e) const;
    void take_off_wings(Vec2d at_px, int channel, double electrons, ElectronImage& light_e);

    const DetectorView& view_;
    std::vector<LightChannel>& channels_;
    int bins_;
    Exposure exposure_;
    double jitter_px_ = 0;
    std::vector<double> glare_e_;  // by channel
    std::vector<Spot> spots_;      // with room for kMostSpots
    // Of each channel: what the wings give near a point, and what the table has folded in of them.
    std::vector<std::vector<double>> near_wings_;
    std::vector<float> patch_;
};

}  // namespace hilcam
