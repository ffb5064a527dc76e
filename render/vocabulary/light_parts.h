#pragma once
// A radiance image taken apart: an image of each part of its light (light_part.h), with the same planes.

#include <optional>
#include <vector>

#include "render/vocabulary/light_part.h"
#include "render/vocabulary/radiance_image.h"

namespace hilcam {

class LightParts {
  public:
    // like: an image of the size, planes and channels that each part gets. only: the one part that is wanted; none: all are.
    explicit LightParts(const RadianceImage& like, std::optional<LightPart> only = std::nullopt);

    RadianceImage& of(LightPart part) { return images_[static_cast<std::size_t>(part)]; }
    const RadianceImage& of(LightPart part) const { return images_[static_cast<std::size_t>(part)]; }

    // False: it is not wanted, and its image has no pixels.
    bool has(LightPart part) const { return of(part).width() > 0; }

    void clear();
    // Returns the picture as the sum of its parts, one by one in their order, points apart, which are none of a radiance image's. It is
    // the picture that was rendered but for single precision's rounding, as that adds light in another order. All parts are there.
    RadianceImage sum() const;

  private:
    std::vector<RadianceImage> images_;
};

}  // namespace hilcam
