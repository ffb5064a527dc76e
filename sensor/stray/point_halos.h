#pragma once
// The halo of veiling glare about bright points of light, as far as the frame reaches.
//
// A point's table (convolution/psf.h) ends at 32 px and folds in what falls beyond. Of a point whose folded halo would show, the
// table is drawn without it and less a smooth part of the halo; this part, and the halo from 24 px on,
//     F(x) = g r / (2 pi (r^2 + x^2)^1.5),  x >= 24 px; a parabola below
// are drawn here (g, r: fraction and radius of stray_light.h). Points less than 4 px apart are drawn together, at the middle of
// their light: the parts of a trail, the cells of a planet. Up to 64 px each pixel has its own distance, farther ones are
// between places 8 px apart. All of that is right within 3 % of F. Not in it: points beyond the guard band.

#include <cstdint>
#include <span>
#include <vector>

#include "render/vocabulary/image_geometry.h"
#include "sensor/stray/stray_light.h"

namespace hilcam {

struct HaloLaw;

class PointHalos {
  public:
    // There is a halo: a radius and a fraction above 0. detector: its pixels. Owner thread.
    PointHalos(const StrayLightConfig& stray, const ImageGeometry& detector);

    // A point of fewer electrons has no wide halo: folded into its table, it adds less than 0.02 e- to a pixel.
    double min_e() const { return min_e_; }
    // F above: its share in a pixel at a distance. Any thread.
    double share(double distance_px) const;
    // Returns the share of the light that the halo has beyond a distance. Any thread.
    double share_beyond(double distance_px) const;

    // These functions are called in this order each frame; loop, one thread.
    void clear();
    void collect(Vec2d at_px, double electrons);
    bool empty() const { return lit_.empty(); }
    void spread();
    // Adds the halos to every `step`-th pixel of a row from `first` on. Any thread.
    void add_to_row(int y, std::size_t first, std::size_t step, std::span<float> row) const;

  private:
    static constexpr int kLevel_px = 24, kNear_px = 64, kCell_px = 4, kNode_px = 8;

    // While collecting, `at` is the sum of places by their light; then its middle.
    struct Cell {
        float electrons = 0, at_x_px = 0, at_y_px = 0;
    };

    double glare_, radius_px_, min_e_;
    int width_px_, height_px_, margin_px_, across_, down_;
    std::vector<Cell> cells_;         // over the frame and a margin
    std::vector<std::uint32_t> lit_;  // cells with light, in the order in which they got it
    int nodes_across_;
    std::vector<float>
        nodes_;  // the halo from 64 px on, a parabola before, at places 8 px apart over the frame

    HaloLaw law_of(const Cell& cell, int level_px) const;
};

}  // namespace hilcam
