#pragma once
// Maps the pixels of a published frame to the radiance image: the frame is the image's window with black
// columns and rows beside it, binned and perhaps mirrored.
//
// Places in both count from the corner: the centre of pixel (0, 0) is at (0.5, 0.5). Those in the image are
// what ImageGeometry::project_px() gives, without the guard band.

#include "render/vocabulary/vec.h"

namespace hilcam {

struct RasterAxis {
    double scale = 1;      // image px per px of the frame; negative when mirrored
    double offset_px = 0;  // the frame's corner in the image

    double image_px(double frame_px) const { return offset_px + scale * frame_px; }
    double frame_px(double image_px) const { return (image_px - offset_px) / scale; }
};

struct FrameRaster {
    int width_px = 0, height_px = 0;  // size of the frame
    RasterAxis x, y;

    Vec2d image_px(Vec2d frame_px) const { return {x.image_px(frame_px.x), y.image_px(frame_px.y)}; }
    Vec2d frame_px(Vec2d image_px) const { return {x.frame_px(image_px.x), y.frame_px(image_px.y)}; }
};

}  // namespace hilcam
