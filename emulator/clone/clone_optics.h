#pragma once
// Measures what series of edges, chessboards and lag show: the lens's MTF over the field, focal length and
// distortion, and the persistence of an image in the frames after it.

#include <optional>

#include "emulator/clone/image_lag.h"
#include "emulator/clone/lens_blur.h"
#include "emulator/clone/lens_calibration.h"

namespace hilcam {

struct CloneMeasurement;
struct FrameSet;

struct CloneOptics {
    std::optional<LensBlur> blur;
    std::optional<LensCalibration> lens;
    std::optional<ImageLag> lag;
};

// clone: the measured figures of the pixels, which make the frames linear. Throws InputError, one line, for
// frames that are not such series, DeviceError when the calibration's program is missing.
CloneOptics measure_optics(const FrameSet& frames, const CameraModel& like, const CloneMeasurement& clone);

}  // namespace hilcam
