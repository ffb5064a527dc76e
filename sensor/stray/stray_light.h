#pragma once
// Light that the lens sends where it does not belong.
//
// Veiling glare: a share of all light is taken out of the image and spread: evenly over the padded frame
// (radius 0), or as the halo r / (2 pi (r^2 + x^2)^1.5), whose transform is exp(-2 pi r f): x^-3 wings as of
// scatter from polished glass (Peterson, "Analytic expression for in-field scattered light distribution",
// SPIE 5178, 2004, for surfaces with an inverse-square scatter law). Ghost: one out-of-focus image by two
// reflections between glass faces, mirrored about the principal point and scaled, a disk of the given radius.
// A data sheet's transmission is that of all light on its way to the detector, so a ghost has a share of it and the image
// the rest: two faces of reflectance R send (1 - R)^2 into the image and (1 - R)^2 R^2 into the ghost (Born & Wolf,
// Principles of Optics, chapter 7.6, with intensities added), whose share is R^2 / (1 + R^2).

#include <vector>

#include "render/vocabulary/config_field.h"
#include "render/vocabulary/image.h"
#include "render/vocabulary/image_geometry.h"
#include "sensor/convolution/convolve.h"

namespace hilcam {

struct StrayLightConfig {
    double veiling_glare_fraction = 0;
    double glare_radius_px = 0;  // 0: even
    double ghost_fraction = 0;   // share of a source's light, which its image lacks
    double ghost_scale = -1;     // image height of the ghost over that of its source; negative: mirrored
    double ghost_radius_px = 32;

    bool has_halo() const { return veiling_glare_fraction > 0 && glare_radius_px > 0; }
};
Fields fields(StrayLightConfig& config);

// The ghost of a whole picture, on cells of 8 x 8 pixels: blurred as it is, it needs no more.
class Ghost {
  public:
    // geometry: of the detector's pixels. Owner thread.
    Ghost(const StrayLightConfig& config, const ImageGeometry& geometry);

    static constexpr int kCell_px = 8;

    // These functions are called in this order each frame; loop, one thread.
    void clear();
    // electrons: of the image at that place, px of the sensor frame.
    void collect(double x_px, double y_px, double electrons);
    void spread();
    // Electrons that the ghost puts into a pixel. Any thread.
    float at(int x_px, int y_px) const;

  private:
    double over_image_;  // the ghost's light over its image's
    double scale_;
    ImageGeometry geometry_;
    Convolver cells_;
};

}  // namespace hilcam
