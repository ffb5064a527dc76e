#pragma once
// A radiance image taken apart: an image of each part of its light (light_part.h), with the same planes.

#include <vector>

#include "render/vocabulary/light_part.h"
#include "render/vocabulary/radiance_image.h"

namespace hilcam {

class LightParts {
  public:
    // like: an image of the size, planes and channels that each part gets.
    explicit LightParts(const RadianceImage& like);

    RadianceImage& of(LightPart part) { return images_[static_cast<std::size_t>(part)]; }
    const RadianceImage& of(LightPart part) const { return images_[static_cast<std::size_t>(part)]; }

    void clear();
    // Returns the picture as the sum of its parts, one by one in their order, points apart, which are none of a radiance image's. It is
    // the picture that was rendered but for single precision's rounding, as that adds light in another order.
    RadianceImage sum() const;

  private:
    std::vector<RadianceImage> images_;
};

}  // namespace hilcam
