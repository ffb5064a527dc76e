#pragma once
// Automatic exposure: the camera sets its own exposure time from the frames it has taken.
//
// A percentile of the frame, its black level taken off, is brought to a share of full scale, which is where
// the camera saturates: the converter's end or the full well, whichever comes first. Each measurement moves
// the exposure by `speed` of the missing stops, from the exposure that it was measured at; so a scene that
// stays is approached from one side, (1 - speed)^n of the way being left after n measurements. A percentile
// that is saturated says only that it is too bright: the exposure is halved at least.

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
    double target_fraction = 0.5;  // share of full scale, for the percentile below
    double percentile = 99;        // percentile of the frame's pixels
    double speed = 0.5;            // share of the way, in stops, that each frame goes; 1: at once
    double tolerance_stops = 0.1;  // nothing is changed within this
};
Fields fields(AutoExposureConfig& config);

// The percentile of a frame, as a share of full scale above black; it may be below 0 with noise.
struct Brightness {
    double fraction = 0;
    bool saturated = false;
};

// [s]
struct ExposureLimits {
    double min_s = 0, max_s = 0;
};
// The exposure to set after a frame of present_s showed that brightness.
double next_exposure_s(const AutoExposureConfig& config, Brightness seen, double present_s,
                       const ExposureLimits& limits);

// The scale tells what a frame's digital numbers stand for.
struct DnScale {
    double black_dn = 0;
    double full_dn = 4095;              // number at which the camera saturates
    double max_dn = 4095;               // greatest number of the converter
    bool square_root = false;           // 8-bit numbers are 255 sqrt(dn / max_dn)
    const Table* companding = nullptr;  // or codes of this table, the camera's
};

// Returns the scale of a camera's frames, taken as the exposure says.
DnScale dn_scale_of(const CameraModel& camera, const Exposure& exposure);

// Counts a frame's numbers. Memory for them is taken at construction.
class FrameHistogram {
  public:
    FrameHistogram() = default;
    explicit FrameHistogram(int frame_bits) : counts_(std::size_t{1} << frame_bits) {}

    // Leaves out the first black_columns and black_rows of the frame. Loop.
    Brightness measure(const DnImage& frame, int black_columns, int black_rows, double percentile,
                       const DnScale& scale);

  private:
    std::vector<std::uint32_t> counts_;
};

}  // namespace hilcam
