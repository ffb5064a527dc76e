#pragma once
// Automatic exposure: the camera sets its exposure time from the frames it has taken.
//
// It brings a percentile of the frame, above the black level, to a share of full scale. Full scale is where
// the camera saturates: the converter's end or the full well, whichever comes first. Each measurement changes
// the exposure, starting from the one at which it was measured, by `speed` of the missing stops. In a scene
// that does not change, the remaining error after n measurements is (1 - speed)^n. A saturated percentile
// only shows that the frame is too bright, so the exposure is at least halved.

#include <cstdint>
#include <vector>

#include "render/vocabulary/config_field.h"
#include "render/vocabulary/image.h"
#include "render/vocabulary/table.h"

namespace hilcam {

struct CameraModel;  // camera_model.h
struct Exposure;     // exposure.h

struct AutoExposureConfig {
    bool on = false;
    double target_fraction = 0.5;  // wanted share of full scale for the percentile
    double percentile = 99;        // over the frame's pixels
    double speed = 0.5;            // share of the missing stops that each frame corrects; 1: all at once
    double tolerance_stops = 0.1;  // errors up to this change nothing
};
Fields fields(AutoExposureConfig& config);

// The percentile of a frame as a share of full scale above black. Noise can make it negative.
struct Brightness {
    double fraction = 0;
    bool saturated = false;
};

// [s]
struct ExposureLimits {
    double min_s = 0, max_s = 0;
};
// Returns the next exposure after a frame with an exposure of present_s had this brightness.
double next_exposure_s(const AutoExposureConfig& config, Brightness seen, double present_s,
                       const ExposureLimits& limits);

// The meaning of a frame's digital numbers.
struct DnScale {
    double black_dn = 0;
    double full_dn = 4095;              // number at which the camera saturates
    double max_dn = 4095;               // largest number of the converter
    bool square_root = false;           // true: 8-bit numbers are 255 sqrt(dn / max_dn)
    const Table* companding = nullptr;  // or 8-bit codes of this table of the camera
};

// Returns the scale of a camera's frames taken with that exposure.
DnScale dn_scale_of(const CameraModel& camera, const Exposure& exposure);

// Counts a frame's numbers, in memory allocated at construction.
class FrameHistogram {
  public:
    FrameHistogram() = default;
    explicit FrameHistogram(int frame_bits) : counts_(std::size_t{1} << frame_bits) {}

    // Returns the percentile, ignoring the first black_columns and black_rows of the frame. Loop.
    Brightness measure(const DnImage& frame, int black_columns, int black_rows, double percentile,
                       const DnScale& scale);

  private:
    std::vector<std::uint32_t> counts_;
};

}  // namespace hilcam
