#pragma once
// A detector's maps as pictures on disk: one number for each pixel.

#include <filesystem>

#include "sensor/camera_model.h"
#include "sensor/fixed_pattern.h"

namespace hilcam {

// TIFF or PNG of one channel, 8 or 16 bits or 32-bit float. InputError when it is missing, does not decode,
// has several channels or a value that is negative or not a number (offsets may be negative: any_sign).
PixelMap read_pixel_map(const std::filesystem::path& file, bool any_sign);

// What the camera's fixed_pattern names.
DetectorPictures load_detector_pictures(const CameraModel& camera);

}  // namespace hilcam
