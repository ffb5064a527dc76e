#pragma once
// Maps pixels of the published frame to the radiance image. The frame is a window of the image with black
// columns and rows around it, binned and possibly mirrored.
//
// Both coordinates count from the corner: the centre of pixel (0, 0) is at (0.5, 0.5). Those in the image are
// the ones that ImageGeometry::project_px() returns, without the guard band.

#include "render/vocabulary/vec.h"

namespace hilcam {

struct RasterAxis {
    double scale = 1;      // image px per frame px; negative if mirrored
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
