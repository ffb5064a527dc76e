#pragma once
// Maps places in the radiance image to places in the frame that the camera gives out: past black columns and
// rows, binning and mirroring.
//
// Binning begins at the read-out array's corner, with the black columns and rows, and leaves out what does
// not fill a whole pixel at the far sides. A mirrored frame is mirrored after it is binned.

#include <cstdint>

#include "render/frame/frame_raster.h"
#include "sensor/camera_model.h"

namespace hilcam {

// The layout says how a frame is given out.
struct FrameLayout {
    std::int64_t binning_x = 1, binning_y = 1;  // at least 1
    bool reverse_x = false, reverse_y = false;
};

// oversampling: pixels of the radiance image across one of the detector. Loop.
FrameRaster raster_of(const CameraModel& camera, int oversampling, const FrameLayout& layout);

// Pixels of the radiance image, counted from its window's corner, that a pixel of the frame is made of along one axis.
struct PixelReach {
    int first, last;  // the one after it
};
PixelReach reach_of(const RasterAxis& axis, int frame_px);

// The lens as the frame has it [px of the frame]: its focal length along both axes, negative where the frame
// is mirrored, and where the boresight meets it.
struct FrameIntrinsics {
    Vec2d focal_length_px;
    Vec2d principal_point_px;
};
FrameIntrinsics intrinsics_of(const ImageGeometry& image, const FrameRaster& raster);

}  // namespace hilcam
