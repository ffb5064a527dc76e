#pragma once
// Computes from its shutter when a camera's frame begins, is in its middle and ends. With T the exposure, h
// the rows of the window and l the line time, a frame that begins at 0:
//
//                     middle                end             shortest period
//     global,
//     frame_transfer  T/2                   T               T
//     rolling         (T + (h-1) l) / 2     T + (h-1) l     the longer of T and h l
//     line_scan       h l / 2               h l             h l: frames join without a gap
//
// Example: rolling, 1000 rows, 20 us, T = 5 ms: the middle row's exposure is centred at 12.49 ms, the frame
// ends at 24.98 ms and the next begins at 20 ms at the earliest. Line-scan exposures are tdi_stages x l,
// whatever is asked for.

#include "sensor/camera_model.h"

namespace hilcam {

class ShutterTiming {
  public:
    explicit ShutterTiming(const CameraModel& camera);

    // The shutter leaves no choice of exposure and frame rate.
    bool is_fixed() const { return kind_ == ShutterKind::kLineScan; }
    // Returns the exposure that is made where one is asked for [s].
    double exposure_s(double asked_s) const { return is_fixed() ? stages_ * line_time_s_ : asked_s; }
    double middle_s(double exposure_s) const;
    double end_s(double exposure_s) const;
    // Returns the exposure that frames leave time for: a camera with a sequence of settings has that of its longest
    // step [s].
    double longest_exposure_s(double exposure_s) const;
    // Returns how long a frame keeps the detector: none begins before that is over, at any frame rate [s].
    double busy_s(double exposure_s) const;
    // Returns the time from frame to frame at a frame rate that is asked for [s].
    double period_s(double frame_rate_hz, double exposure_s) const;

  private:
    ShutterKind kind_;
    double rows_, line_time_s_, stages_;
    double longest_step_s_ = 0;  // Exposure of the longest step of the camera's sequence.
};

}  // namespace hilcam
