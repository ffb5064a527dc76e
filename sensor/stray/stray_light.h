#pragma once
// Light that the lens sends to the wrong place.
//
// Veiling glare: a share of all light is removed from the image and spread, either evenly over the padded
// frame (radius 0), or as the halo r / (2 pi (r^2 + x^2)^1.5) with the transform exp(-2 pi r f). Its x^-3
// wings are those of scatter from polished glass (Peterson, "Analytic expression for in-field scattered light
// distribution", SPIE 5178, 2004, for surfaces with an inverse-square scatter law).
//
// Ghost: an out-of-focus image by two reflections between glass faces, mirrored about the principal point and
// scaled, a disk of the given radius. The transmission in a data sheet covers all light that reaches the
// detector, so the ghost has a share of it and the image the rest. Two faces of reflectance R send (1 - R)^2
// into the image and (1 - R)^2 R^2 into the ghost (Born & Wolf, Principles of Optics, chapter 7.6, with
// intensities added), so the ghost's share is R^2 / (1 + R^2).

#include <vector>

#include "render/vocabulary/config_field.h"
#include "render/vocabulary/image.h"
#include "render/vocabulary/image_geometry.h"
#include "sensor/convolution/convolve.h"

namespace hilcam {

struct StrayLightConfig {
    double veiling_glare_fraction = 0;
    double glare_radius_px = 0;  // 0: even glare
    double ghost_fraction = 0;   // share of a source's light that is missing from its image
    double ghost_scale = -1;     // image height of the ghost over that of its source; negative: mirrored
    double ghost_radius_px = 32;

    bool has_halo() const { return veiling_glare_fraction > 0 && glare_radius_px > 0; }
};
Fields fields(StrayLightConfig& config);

// The ghost of a whole picture, on cells of 8 x 8 pixels, which suffice for its blur.
class Ghost {
  public:
    // geometry: that of the detector's pixels. Owner thread.
    Ghost(const StrayLightConfig& config, const ImageGeometry& geometry);

    static constexpr int kCell_px = 8;

    // Call these functions in this order for each frame. Loop, one thread.
    void clear();
    // Adds the electrons of the image at a place [px of the sensor frame].
    void collect(double x_px, double y_px, double electrons);
    void spread();
    // Returns the electrons that the ghost adds to a pixel. Any thread.
    float at(int x_px, int y_px) const;

  private:
    double over_image_;  // light of the ghost over that of its image
    double scale_;
    ImageGeometry geometry_;
    Convolver cells_;
};

}  // namespace hilcam
