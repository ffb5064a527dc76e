#pragma once
// Maps places in the radiance image to places in the published frame: past black columns and rows, binning
// and mirroring.
//
// Binning begins at the read-out array's corner, with the black columns and rows, and drops what does not
// fill a whole pixel at the far sides. Mirroring follows binning.

#include <cstdint>

#include "render/frame/frame_raster.h"
#include "sensor/camera_model.h"

namespace hilcam {

// The layout of a published frame.
struct FrameLayout {
    std::int64_t binning_x = 1, binning_y = 1;  // at least 1
    bool reverse_x = false, reverse_y = false;
};

// oversampling: radiance image pixels across one detector pixel. Loop.
FrameRaster raster_of(const CameraModel& camera, int oversampling, const FrameLayout& layout);

// Range of radiance image pixels, counted from the window's corner, that contribute to a pixel of the frame
// along one axis.
struct PixelReach {
    int first, last;  // last is one past the end
};
PixelReach reach_of(const RasterAxis& axis, int frame_px);

// The lens in px of the frame: its focal length along both axes, negative where the frame is mirrored, and
// the place of the boresight.
struct FrameIntrinsics {
    Vec2d focal_length_px;
    Vec2d principal_point_px;
};
FrameIntrinsics intrinsics_of(const ImageGeometry& image, const FrameRaster& raster);

}  // namespace hilcam
