#pragma once
// `hilcam render --pixel X Y`: describes what a pixel of the frame consists of, as text.

#include <string>

#include "render/shading/pixel_record.h"
#include "render/vocabulary/vec.h"

namespace hilcam {

class StillCamera;

// A pixel of the published frame, counted from 0 at the upper left.
struct FramePixel {
    int x = 0, y = 0;
};

// Returns the pixels of the padded radiance image that contribute to a pixel of the frame. Throws InputError
// when the frame has no such pixel, when no light reaches it, or when it bins pixels under different filters.
PixelBox radiance_pixels(const StillCamera& camera, FramePixel pixel);

// Describes the light of the last rendered picture: parts with their sums, then each surface that sends
// light, brightest first. Electrons are those of the pixel's own light on the axis, before the lens blurs it.
std::string pixel_report(const StillCamera& camera, FramePixel pixel, const PixelRecord& record);

}  // namespace hilcam
