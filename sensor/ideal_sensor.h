#pragma once
// The numbers that light alone makes: each pixel's electrons as if it stood on the lens' axis, times the gain, above the black level.
// Blur, the lens' falloff and stray light, dark current, noise, patterns and the converter's errors are left out; saturation, binning,
// colour filters and companding are as the camera has them. So a part of a picture's light compares with the picture.

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

    // light: charge rates of the detector's channels (RadianceImage::responses), its border as the sampling says. Gives a frame as it is
    // given out, binned and mirrored by the layout; the exposure's own binning is not looked at. Any thread.
    DnImage take(const RadianceImage& light, Exposure exposure, const FrameLayout& layout) const;

  private:
    // Returns the sum of rates over pixels of the window [px of the image]; black columns and rows are outside it.
    double rate_in(const RadianceImage& light, const PixelReach& x, const PixelReach& y) const;

    CameraModel camera_;
    int oversampling_, guard_px_;             // border [px of the image]
    int window_width_px_, window_height_px_;  // likewise
    Mosaic mosaic_;
    Converter converter_;  // for companding alone
};

}  // namespace hilcam
