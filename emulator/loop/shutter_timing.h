#pragma once
// Computes the begin, middle and end of a camera's frame from its shutter. T: exposure; h: rows of the
// window; l: line time. For a frame that begins at 0:
//
//                     middle                end             shortest period
//     global,
//     frame_transfer  T/2                   T               T
//     rolling         (T + (h-1) l) / 2     T + (h-1) l     the longer of T and h l
//     line_scan       h l / 2               h l             h l: frames join without a gap
//
// Example: rolling, 1000 rows, 20 us, T = 5 ms: the middle row's exposure is centred at 12.49 ms, the frame
// ends at 24.98 ms, and the next one begins at 20 ms at the earliest. A line-scan exposure is always
// tdi_stages x l.

#include "sensor/camera_model.h"

namespace hilcam {

class ShutterTiming {
  public:
    explicit ShutterTiming(const CameraModel& camera);

    // True when the shutter fixes exposure and frame rate.
    bool is_fixed() const { return kind_ == ShutterKind::kLineScan; }
    // Returns the actual exposure for a requested one [s].
    double exposure_s(double asked_s) const { return is_fixed() ? stages_ * line_time_s_ : asked_s; }
    double middle_s(double exposure_s) const;
    double end_s(double exposure_s) const;
    // Returns the exposure that the frame period must allow for; with a sequence of settings, that of its
    // longest step [s].
    double longest_exposure_s(double exposure_s) const;
    // Returns how long a frame occupies the detector [s]. At any frame rate, no other frame begins before
    // that.
    double busy_s(double exposure_s) const;
    // Returns the frame period for a requested frame rate [s].
    double period_s(double frame_rate_hz, double exposure_s) const;
    // Returns the frame period when no exposure begins before the frame before is read out [s]. A global
    // shutter is read out as fast as its highest frame rate permits, a rolling one while its rows end.
    double period_with_readout_s(double max_frame_rate_hz, double exposure_s) const;

  private:
    ShutterKind kind_;
    double rows_, line_time_s_, stages_;
    double longest_step_s_ = 0;  // exposure of the longest step of the camera's sequence
};

}  // namespace hilcam
