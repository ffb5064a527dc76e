#pragma once
// Adds to a convolved channel what it changes that its light lies in parts of pixels (subpixel_light.h), block by
// block, where there is any such light. Next to objects, light that is known by one sample a pixel is taken to be even:
// from what lies beyond an edge nothing follows.

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
    // illumination: the lens' factors over the radiance image, row by row; zone_weights: shares of the field's
    // zones over the convolver's image, none with one zone. Both outlive it. Owner thread.
    SubpixelLightAdder(const std::vector<float>& illumination,
                       const std::vector<std::vector<float>>& zone_weights)
        : illumination_(illumination), zone_weights_(zone_weights) {}

    // One channel of the detector: its number, the kernels of each zone of the field, its response to radiance, and the
    // greatest charge that its pixels were cut to.
    struct Channel {
        int number;
        std::span<MomentKernels> kernels;
        const Spectrum& response;
        float max_e;
    };
    // radiance: the picture with halves of which `image` was made and convolved. Loop: no allocation, no lock.
    void add(const RadianceImage& radiance, const Channel& channel, const FrameBlur& blur, double exposure_s,
             Convolver& image) const;

  private:
    const std::vector<float>& illumination_;
    const std::vector<std::vector<float>>& zone_weights_;

    struct Source {
        const RadianceImage& radiance;
        const SubpixelLight& light;
        int number;
        const Spectrum* response;  // null: the image has charge rates already
        float exposure_s, max_e;   // max_e: the charge to which brighter pixels were cut
        const float* zone;         // null: the whole field is one
        std::size_t zone_width;    // floats in a row of it

        bool knows(int x, int y) const;
        const float* rates_e_s(int x, int y, std::size_t count, float* room) const;
    };
    // A block and what lies about it, as far as kernels reach and differences are taken from.
    static constexpr int kRim_px = MomentKernels::kMaxReach_px + 2,
                         kArea_px = MomentKernels::kBlock_px + 2 * kRim_px;
    using Area = std::array<std::array<float, kArea_px>, kArea_px>;
    struct Scratch {
        Area charge_e;  // light of pixels
        std::array<std::array<SubpixelKind, kArea_px>, kArea_px> kinds;
        std::array<std::array<std::uint8_t, kArea_px>, kArea_px> sharp;  // pixels whose light is not smooth
        MomentKernels::Parts parts;
    };
    bool gather(const Source& source, int x_px, int y_px, Scratch& scratch) const;
    void copy_row(const Source& source, int x_px, int y_px, int row, Scratch& scratch) const;
    static void find_sharp(Scratch& scratch);
    static bool take_smooth(Scratch& scratch);
};

}  // namespace hilcam
