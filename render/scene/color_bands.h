#pragma once
// Turns the colours of pictures into spectra: sRGB texels become reflectance in three broad bands,
// distributed over the spectral bins.

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "render/vocabulary/mesh.h"
#include "render/vocabulary/spectrum.h"

namespace hilcam {

// Returns the linear value of an 8-bit sRGB code (IEC 61966-2-1:1999), 0..1.
float linear_from_srgb(std::uint8_t code);

// The weights of a texel's red, green and blue in each bin; they sum to 1. Blue is below 0.49 um, green from
// there to 0.58 um, red above; near infrared counts as red, because a picture has no more than that. Colours
// say nothing of thermal bins: they are 1 there, and the weights 0.
class ColorBands {
  public:
    explicit ColorBands(const SpectralGrid& grid);
    Spectrum spectrum(Vec3f linear_rgb) const;
    const Spectrum& red() const { return red_; }
    const Spectrum& green() const { return green_; }
    const Spectrum& blue() const { return blue_; }
    // Returns the weights of red, green and blue in one bin.
    std::array<float, 3> shares(int bin) const { return {red_[bin], green_[bin], blue_[bin]}; }

  private:
    int bins_;
    Spectrum red_, green_, blue_;
    Spectrum thermal_;  // 1 in thermal bins
};

// A picture with its mip levels: each level has half the width and height of the one before, averaged in
// linear light (Williams, "Pyramidal parametrics", SIGGRAPH 83), and is stored as 8-bit sRGB.
class MipTexture {
  public:
    MipTexture() = default;
    explicit MipTexture(Texture texture);

    bool empty() const { return levels_.empty(); }
    int width() const { return levels_.front().width; }
    int height() const { return levels_.front().height; }
    // Returns linear RGB, 0..1, averaged over about `footprint` (share of the picture's width; 0: no
    // averaging). Bilinear within a level; from halfway to the next level on, linear between the two. Beyond
    // the edges the picture's wrap mode applies. (0, 0) is the outer corner of texel (0, 0).
    Vec3f sample(float u, float v, float footprint) const;
    // Returns the mean of all texels, weighted by `row_weight(v)` where v is the middle of the row.
    Vec3f mean(const std::function<double(double)>& row_weight) const;

  private:
    std::vector<Texture> levels_;
};

}  // namespace hilcam
