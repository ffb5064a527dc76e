#pragma once
// The halo of veiling glare around bright points of light, across the whole frame.
//
// The table of a point (convolution/psf.h) ends at 32 px and folds light beyond that into itself. For a point
// bright enough that the folded halo would show, the table is drawn without it, and without a smooth part of
// the halo. That part, and the halo from 24 px on, are drawn here:
//     F(x) = g r / (2 pi (r^2 + x^2)^1.5),  x >= 24 px; a parabola below
// with g, r the fraction and radius of stray_light.h. Points less than 4 px apart, such as the parts of a
// trail or the cells of a planet, are combined at the centroid of their light. Up to 64 px each pixel has its
// exact distance; farther away the halo is interpolated between places 8 px apart. All of this is right
// within 3 % of F. Not included: points beyond the guard band.

#include <cstdint>
#include <span>
#include <vector>

#include "render/vocabulary/image_geometry.h"
#include "sensor/stray/stray_light.h"

namespace hilcam {

struct HaloLaw;

class PointHalos {
  public:
    // Requires a halo: radius and fraction above 0. detector: geometry of its pixels. Owner thread.
    PointHalos(const StrayLightConfig& stray, const ImageGeometry& detector);

    // Returns the electrons below which a point needs no wide halo: folded into its table, the halo adds less
    // than 0.02 e- to a pixel.
    double min_e() const { return min_e_; }
    // Returns F, the share of light in a pixel at a distance. Any thread.
    double share(double distance_px) const;
    // Returns the share of the light that the halo has beyond a distance. Any thread.
    double share_beyond(double distance_px) const;

    // Call these functions in this order for each frame. Loop, one thread.
    void clear();
    void collect(Vec2d at_px, double electrons);
    bool empty() const { return lit_.empty(); }
    void spread();
    // Adds the halos to every `step`th pixel of a row, from `first` on. Any thread.
    void add_to_row(int y, std::size_t first, std::size_t step, std::span<float> row) const;

  private:
    static constexpr int kLevel_px = 24, kNear_px = 64, kCell_px = 4, kNode_px = 8;

    // While collecting, `at` is the sum of places weighted by light; afterwards, the centroid.
    struct Cell {
        float electrons = 0, at_x_px = 0, at_y_px = 0;
    };

    double glare_, radius_px_, min_e_;
    int width_px_, height_px_, margin_px_, across_, down_;
    std::vector<Cell> cells_;         // over the frame and a margin
    std::vector<std::uint32_t> lit_;  // cells with light, in the order in which they received it
    int nodes_across_;
    std::vector<float> nodes_;  // halo from 64 px on, a parabola nearer, at places 8 px apart over the frame

    HaloLaw law_of(const Cell& cell, int level_px) const;
};

}  // namespace hilcam
