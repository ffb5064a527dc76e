#include "sensor/published_frame.h"

#include <algorithm>
#include <cmath>

namespace hilcam {
namespace {

struct AxisLayout {
    int frame_px;
    std::int64_t black, binning;
    bool reverse;
};

RasterAxis axis_of(const AxisLayout& a, int oversampling) {
    const double black = static_cast<double>(a.black), binning = static_cast<double>(a.binning);
    if (!a.reverse) return {binning * oversampling, -black * oversampling};
    return {-binning * oversampling, (a.frame_px * binning - black) * oversampling};
}

}  // namespace

FrameRaster raster_of(const CameraModel& camera, int oversampling, const FrameLayout& layout) {
    const auto [width, height] = frame_size(camera, layout.binning_x, layout.binning_y);
    return {width, height,
            axis_of({width, camera.black_columns, layout.binning_x, layout.reverse_x}, oversampling),
            axis_of({height, camera.black_rows, layout.binning_y, layout.reverse_y}, oversampling)};
}

PixelReach reach_of(const RasterAxis& axis, int frame_px) {
    const double a = axis.image_px(frame_px), b = axis.image_px(frame_px + 1);
    return {static_cast<int>(std::lround(std::min(a, b))), static_cast<int>(std::lround(std::max(a, b)))};
}

FrameIntrinsics intrinsics_of(const ImageGeometry& image, const FrameRaster& raster) {
    return {{image.focal_length_px / raster.x.scale, image.focal_length_px / raster.y.scale},
            raster.frame_px(image.center_px())};
}

}  // namespace hilcam
