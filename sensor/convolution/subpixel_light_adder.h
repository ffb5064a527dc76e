#pragma once
// Corrects a convolved channel for where light falls within pixels (subpixel_light.h), block by block, in
// blocks with such light. Next to objects, light known from one sample a pixel is treated as even over the
// pixel, because nothing can be concluded from light beyond an edge.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "render/vocabulary/radiance_image.h"
#include "sensor/convolution/convolve.h"
#include "sensor/convolution/moment_kernels.h"

namespace hilcam {

class SubpixelLightAdder {
  public:
    // illumination: the lens's factors over the radiance image, row by row. zone_weights: weights of the
    // field zones over the convolver's image; empty with one zone. Both must outlive this object. Owner
    // thread.
    SubpixelLightAdder(const std::vector<float>& illumination,
                       const std::vector<std::vector<float>>& zone_weights)
        : illumination_(illumination), zone_weights_(zone_weights) {}

    // One channel of the detector: its number, the kernels of each field zone, its response to radiance, and
    // the largest charge to which its pixels were cut.
    struct Channel {
        int number;
        std::span<MomentKernels> kernels;
        const Spectrum& response;
        float max_e;
    };
    // radiance: the picture with halves from which `image` was made and convolved. Loop: no allocation, no
    // lock.
    void add(const RadianceImage& radiance, const Channel& channel, const FrameBlur& blur, double exposure_s,
             Convolver& image) const;

  private:
    const std::vector<float>& illumination_;
    const std::vector<std::vector<float>>& zone_weights_;

    struct Source {
        const RadianceImage& radiance;
        const SubpixelLight& light;
        int number;
        const Spectrum* response;  // null: the image holds charge rates
        float exposure_s, max_e;   // max_e: charge to which brighter pixels were cut
        const float* zone;         // null: a single zone covers the field
        std::size_t zone_width;    // floats in a row of `zone`

        bool knows(int x, int y) const;
        const float* rates_e_s(int x, int y, std::size_t count, float* room) const;
    };
    // A block and its surroundings, as far as kernels reach and differences need.
    static constexpr int kRim_px = MomentKernels::kMaxReach_px + 2,
                         kArea_px = MomentKernels::kBlock_px + 2 * kRim_px;
    using Area = std::array<std::array<float, kArea_px>, kArea_px>;
    struct Scratch {
        Area charge_e;  // light of the pixels
        std::array<std::array<SubpixelKind, kArea_px>, kArea_px> kinds;
        // Pixels with light that is not smooth.
        std::array<std::array<std::uint8_t, kArea_px>, kArea_px> sharp;
        MomentKernels::Parts parts;
    };
    bool gather(const Source& source, int x_px, int y_px, Scratch& scratch) const;
    void copy_row(const Source& source, int x_px, int y_px, int row, Scratch& scratch) const;
    static void find_sharp(Scratch& scratch);
    static bool take_smooth(Scratch& scratch);
};

}  // namespace hilcam
