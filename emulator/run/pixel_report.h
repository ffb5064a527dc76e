#pragma once
// `hilcam render --pixel X Y`: what a pixel of the frame is made of, as text.

#include <string>

#include "render/shading/pixel_record.h"
#include "render/vocabulary/vec.h"

namespace hilcam {

class StillCamera;

// A pixel of the published frame, from 0 at its upper left.
struct FramePixel {
    int x = 0, y = 0;
};

// Returns the pixels of the padded radiance image that a pixel of the frame is made of. InputError where the frame has no such pixel, where
// no light reaches it, and where it is binned of pixels under several filters.
PixelBox radiance_pixels(const StillCamera& camera, FramePixel pixel);

// Says what the light of the picture that was rendered last is made of: parts with their sums, then entry by entry the surface that sends
// it, brightest first. Electrons are those that the pixel's own light makes on the axis, before the lens blurs it.
std::string pixel_report(const StillCamera& camera, FramePixel pixel, const PixelRecord& record);

}  // namespace hilcam
