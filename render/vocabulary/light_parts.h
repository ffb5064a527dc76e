#pragma once
// A radiance image taken apart: one image for each part of its light (light_part.h), with the same planes.

#include <optional>
#include <vector>

#include "render/vocabulary/light_part.h"
#include "render/vocabulary/radiance_image.h"

namespace hilcam {

class LightParts {
  public:
    // like: gives size, planes and channels of each image. only: the one part that is wanted; none: all
    // parts.
    explicit LightParts(const RadianceImage& like, std::optional<LightPart> only = std::nullopt);

    RadianceImage& of(LightPart part) { return images_[static_cast<std::size_t>(part)]; }
    const RadianceImage& of(LightPart part) const { return images_[static_cast<std::size_t>(part)]; }

    // False when the part is not wanted; its image then has no pixels.
    bool has(LightPart part) const { return of(part).width() > 0; }

    void clear();
    // Returns the sum of the parts in their order, without points, which are not in the radiance image. The
    // sum equals the rendered picture up to single-precision rounding, because rendering adds light in
    // another order. Needs all parts.
    RadianceImage sum() const;

  private:
    std::vector<RadianceImage> images_;
};

}  // namespace hilcam
