#pragma once
// The far wings of very bright light, above all the Sun's, across the whole picture. The table of the point
// spread function ends before them, and an FFT would fold them over the picture's edges.
//
// Far from the centre an image is determined by the cusp of its transfer function at zero frequency: with
// slope -s there, it is s / (4 pi^2 r^3), averaged over the rings (the transform of |f|; for a clear aperture
// s = 4 lambda N / pi, and this is the Airy pattern's envelope lambda N / (pi^3 r^3)), plus the halo of
// veiling glare. The wings are smooth, so they are computed on cells of 8 px. Nearer than 24 px they stay
// level; there the table is used, minus that level (point_light.h). Not modelled: the spikes of a spider.

#include <vector>

#include "render/vocabulary/image_geometry.h"
#include "sensor/stray/stray_light.h"

namespace hilcam {

class FarWings {
  public:
    static constexpr int kLevel_px = 24;

    // slope_px: s of the lens alone. Owner thread.
    FarWings(double slope_px, const StrayLightConfig& stray, const ImageGeometry& geometry);

    // Call these functions in this order for each frame. Loop, one thread.
    void clear();
    void collect(double x_px, double y_px, double electrons);  // px of the sensor frame
    void spread();
    bool empty() const { return sources_.empty(); }
    // Returns the electrons that the wings add to a pixel. Any thread.
    float at(int x_px, int y_px) const;
    // Returns the share of a source's light in a pixel at a distance. Any thread.
    double density(double distance_px) const;

  private:
    struct Source {
        int i, j;  // cell
        double electrons;
    };
    static constexpr int kCell_px = 8;

    double slope_px_, glare_, glare_radius_px_;
    int guard_px_, across_, down_;
    std::vector<float> shares_;    // density by distance in cells, [down][across]
    std::vector<double> cells_;    // collected light, by cell of the padded picture
    std::vector<Source> sources_;  // lit cells
    std::vector<float> wings_;     // at the centres of the cells
};

}  // namespace hilcam
