#pragma once
// Turns the colours of pictures into spectra: sRGB texels as reflectance in three broad bands, laid onto the
// spectral bins.

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "render/vocabulary/mesh.h"
#include "render/vocabulary/spectrum.h"

namespace hilcam {

// Linear value of an 8-bit sRGB code (IEC 61966-2-1:1999), 0..1.
float linear_from_srgb(std::uint8_t code);

// The shares of a texel's red, green and blue that each bin takes; the three sum to 1 in every bin. Blue
// below 0.49 um, green to 0.58 um, red above (near infrared goes with red): a picture holds no more than
// that.
class ColorBands {
  public:
    explicit ColorBands(const SpectralGrid& grid);
    Spectrum spectrum(Vec3f linear_rgb) const;
    // Returns the shares of red, green and blue that one bin takes.
    std::array<float, 3> shares(int bin) const { return {red_[bin], green_[bin], blue_[bin]}; }

  private:
    int bins_;
    Spectrum red_, green_, blue_;
};

// A picture and its halves: each level has half the width and height of the one before, averaged in linear
// light (Williams, "Pyramidal parametrics", SIGGRAPH 83), kept as 8-bit sRGB.
class MipTexture {
  public:
    MipTexture() = default;
    explicit MipTexture(Texture texture);

    bool empty() const { return levels_.empty(); }
    int width() const { return levels_.front().width; }
    int height() const { return levels_.front().height; }
    // Linear RGB, 0..1, averaged over about `footprint` (share of the picture's width that is asked for; 0:
    // none). Bilinear in a level and linear from half of the way to the next on, going on beyond its edges as the
    // picture says; (0, 0) is the outer corner of texel (0, 0).
    Vec3f sample(float u, float v, float footprint) const;
    // Returns the mean of all texels, weighted by `row_weight(v)`, v of the row's middle.
    Vec3f mean(const std::function<double(double)>& row_weight) const;

  private:
    std::vector<Texture> levels_;
};

}  // namespace hilcam
