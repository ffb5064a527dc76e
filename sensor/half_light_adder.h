#pragma once
// Adds to a convolved channel what it changes that its light lies in halves of pixels (half_light.h), block by
// block, where there is any such light.

#include <vector>

#include "render/vocabulary/radiance_image.h"
#include "sensor/light_channel.h"

namespace hilcam {

class HalfLightAdder {
  public:
    // illumination: the lens' factors over the radiance image, row by row; zone_weights: shares of the field's
    // zones over the convolver's image, none with one zone. Both outlive it. Owner thread.
    HalfLightAdder(const std::vector<float>& illumination,
                   const std::vector<std::vector<float>>& zone_weights)
        : illumination_(illumination), zone_weights_(zone_weights) {}

    // most_e: the greatest charge of a pixel in the channel before it was convolved; no half has more. number: of
    // the channel. Loop: no allocation, no lock.
    void add(const HalfLight& light, int number, const FrameBlur& blur, double exposure_s, float most_e,
             LightChannel& channel) const;

  private:
    const std::vector<float>& illumination_;
    const std::vector<std::vector<float>>& zone_weights_;

    struct Source {
        const HalfLight& light;
        int number;
        float exposure_s, most_e;
        const float* zone;       // null: the whole field is one
        std::size_t zone_width;  // floats in a row of it
    };
    bool gather(const Source& source, int x_px, int y_px, HalfKernels::Differences& out) const;
    void copy_block(const Source& source, int from_x, int from_y, int x_px, int y_px,
                    HalfKernels::Differences& out) const;
};

}  // namespace hilcam
