#pragma once
// Very bright light, the Sun above all, reaches across the whole picture by the wings of its image, which the
// point spread function's table ends before and which an FFT would fold over the picture's edges.
//
// Far out an image is what its transfer function's cusp at zero frequency says: with slope -s there, s / (4
// pi^2 r^3) averaged over the rings (the transform of |f|; for a clear aperture s = 4 lambda N / pi and this
// is the Airy pattern's envelope lambda N / (pi^3 r^3)); and the halo of veiling glare as it is. On cells of
// 8 px, smooth as it is. Nearer than 24 px the wings stay level; what is near is the table's, less the level
// (point_light.h). Not modelled: the spikes of a spider.

#include <vector>

#include "render/vocabulary/image_geometry.h"
#include "sensor/stray/stray_light.h"

namespace hilcam {

class FarWings {
  public:
    static constexpr int kLevel_px = 24;

    // slope_px: s of the lens alone. Owner thread.
    FarWings(double slope_px, const StrayLightConfig& stray, const ImageGeometry& geometry);

    // These functions are called in this order each frame; loop, one thread.
    void clear();
    void collect(double x_px, double y_px, double electrons);  // px of the sensor frame
    void spread();
    bool empty() const { return sources_.empty(); }
    // Electrons that the wings put into a pixel. Any thread.
    float at(int x_px, int y_px) const;
    // Share of a source's light in a pixel at a distance. Any thread.
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
    std::vector<float> wings_;     // at the cells' middles
};

}  // namespace hilcam
