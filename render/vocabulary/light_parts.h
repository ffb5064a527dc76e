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
    // Makes a picture the sum of its parts, one by one in their order, points apart: they are none of a radiance image's.
    void sum_into(RadianceImage& picture) const;

  private:
    std::vector<RadianceImage> images_;
};

}  // namespace hilcam
