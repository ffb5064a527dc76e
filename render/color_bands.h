#pragma once
// From pictures to spectra: sRGB texels as reflectance in three broad bands, laid onto the spectral bins.

#include <array>
#include <cstdint>

#include "render/mesh.h"
#include "render/spectrum.h"

namespace hilcam {

// Linear value of an 8-bit sRGB code (IEC 61966-2-1:1999), 0..1.
float linear_from_srgb(std::uint8_t code);

// How much of a texel's red, green and blue each bin takes; the three sum to 1 in every bin. Blue below 0.49
// um, green to 0.58 um, red above (near infrared goes with red): a picture holds no more than that.
class ColorBands {
  public:
    explicit ColorBands(const SpectralGrid& grid);
    Spectrum spectrum(Vec3f linear_rgb) const;

  private:
    int bins_;
    Spectrum red_, green_, blue_;
};

// Bilinear, wrapping around in both directions; (0, 0) is the outer corner of texel (0, 0). Linear RGB, 0..1.
Vec3f sample(const Texture& texture, float u, float v);

}  // namespace hilcam
