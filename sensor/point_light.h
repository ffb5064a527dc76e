#pragma once
// Draws the light of points on the detector: stars, things smaller than a pixel, and pixels of the picture
// that are too bright for its FFT (the Sun, or its glint in a mirror).
//
// A point that moves during the exposure or jitters is drawn as several points (point_trail.h). All threads
// compute where their images are, some points each; then all threads draw the images, a band of rows each.
// Light on a pixel is added in the order of the points, whatever the number of threads.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "render/vocabulary/image.h"
#include "render/vocabulary/point_source.h"
#include "sensor/convolution/bright_pixels.h"
#include "sensor/light_channel.h"
#include "sensor/point_trail.h"
#include "sensor/stray/far_wings.h"
#include "sensor/stray/point_halos.h"

namespace hilcam {

class PointLight {
  public:
    // wings: for each channel's bright pixels.
    PointLight(const DetectorView& view, std::vector<LightChannel>& channels,
               const std::vector<FarWings>& wings, int bins);

    // Call these functions in this order for each frame. light_e: the read-out array. Loop, one thread.
    void begin(const Exposure& exposure);
    void add(const BrightPixel& pixel, ElectronImage& light_e);
    void add(std::span<const PointSource> points, ElectronImage& light_e);
    // Adds the share of all light that glare spreads evenly, or the wide halos of bright points.
    void finish(ElectronImage& light_e);

    // Returns the standard deviation of the jitter within this exposure, by its density [px]; 0 if too small
    // to see.
    double jitter_px() const { return jitter_px_; }

  private:
    // A point of light in one channel.
    struct Source {
        PointTrails::Trail trail;
        double electrons;
        int channel;
        bool wide_halo;  // true: the halo of glare is drawn separately
    };
    // One place on a point's way, and the light that falls there.
    struct Part {
        Vec2d place_px;
        double electrons = 0;
        int channel = 0;
        bool wide_halo = false;
    };
    // An image still to be drawn.
    struct Spot {
        Vec2d at_px;
        double electrons = 0;
        double glare_e = 0;   // charge that glare removes from it
        double spikes_e = 0;  // charge in a spider's spikes, which reach across the frame
        int channel = 0;
        bool wide_halo = false;
        int radius_px = kNone;
        static constexpr int kNone = -1;  // nothing to draw
    };
    // Rows of the window that one thread draws.
    struct Rows {
        int begin, end;
    };
    static constexpr std::size_t kBands = 16;

    Source source_of(const PointSource& point, std::size_t channel) const;
    void draw_sources(ElectronImage& light_e);
    void make_spots(std::size_t first_spot);
    void finish_spots(ElectronImage& light_e);
    Part part_of(const Source& source, int number) const;
    Spot spot_of(const Part& part, std::size_t i) const;
    Spot spot_of(int channel, Vec2d at_px, double electrons, bool wide_halo) const;
    const std::vector<PointSpread>& spreads_of(const Spot& spot) const {
        const LightChannel& channel = channels_[static_cast<std::size_t>(spot.channel)];
        return spot.wide_halo ? channel.cores : channel.spreads;
    }
    void finish_halos(ElectronImage& light_e);
    void sort_into_bands();
    PictureWindow window_of(Rows rows, ElectronImage& light_e) const;
    void draw(const Spot& spot, Rows rows, ElectronImage& light_e) const;
    void draw_spots(ElectronImage& light_e);
    void draw_spikes(const Spot& spot, Rows rows, ElectronImage& light_e) const;
    void add_patch(const PointPatch& patch, int channel, Rows rows, ElectronImage& light_e) const;
    Rows all_rows() const { return {0, view_.detector.height_px}; }
    void take_off_wings(Vec2d at_px, int channel, double electrons, ElectronImage& light_e);

    const DetectorView& view_;
    std::vector<LightChannel>& channels_;
    int bins_;
    Exposure exposure_;
    double jitter_px_ = 0;
    std::vector<double> glare_e_;    // by channel
    std::vector<PointHalos> halos_;  // by channel; empty without a halo
    PointTrails trails_;
    std::vector<Source> sources_;           // a batch of points at a time
    std::vector<std::size_t> spots_until_;  // running total of the spots of all sources
    std::vector<Spot> spots_;               // a batch of their spots, in order
    std::vector<std::uint8_t> band_of_row_;
    std::array<std::vector<std::uint32_t>, kBands> band_spots_;  // spots in each band of rows, in order
    // For each channel: light of the wings near a point, and the part of them that the table has folded in.
    std::vector<std::vector<double>> near_wings_;
    std::vector<float> patch_;
};

}  // namespace hilcam
