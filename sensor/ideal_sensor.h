#pragma once
// Computes the numbers that light alone would make: each pixel's electrons as if it were on the lens's axis,
// times the gain, above the black level. Blur, the lens's falloff and stray light, dark current, noise,
// patterns and converter errors are left out. Saturation, binning, colour filters and companding are the
// camera's, so that a part of a picture's light can be compared with the picture.

#include "render/vocabulary/image.h"
#include "render/vocabulary/radiance_image.h"
#include "sensor/auto_exposure.h"
#include "sensor/camera_model.h"
#include "sensor/electronics.h"
#include "sensor/exposure.h"
#include "sensor/mosaic.h"
#include "sensor/published_frame.h"

namespace hilcam {

class IdealSensor {
  public:
    IdealSensor(const CameraModel& camera, const SensorSampling& sampling);

    // light: charge rates of the detector's channels (RadianceImage::responses), with the border that the
    // sampling says. Returns a frame that is binned and mirrored by the layout; the exposure's own binning is
    // ignored. Any thread.
    DnImage take(const RadianceImage& light, Exposure exposure, const FrameLayout& layout) const;

  private:
    // Returns the sum of rates over pixels of the window [px of the image]. Black columns and rows are
    // outside it.
    double rate_in(const RadianceImage& light, const PixelReach& x, const PixelReach& y) const;

    CameraModel camera_;
    int oversampling_, guard_px_;             // border [px of the image]
    int window_width_px_, window_height_px_;  // without guard border [px of the image]
    Mosaic mosaic_;
    Converter converter_;  // only compands
};

}  // namespace hilcam
