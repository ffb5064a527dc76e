#pragma once
// The camera's live settings, as commands and camera interfaces (GenICam) see them.

#include <string>

namespace hilcam {

struct CameraSettings {
    double exposure_s = 0;
    double gain_db = 0;        // over the camera file's gain
    double frame_rate_hz = 0;  // free-run
    bool running = true;       // false between stop and start
};

struct CameraLimits {
    int width = 0;  // sensor
    int height = 0;
    int bits = 0;
    double least_exposure_s = 0, most_exposure_s = 0;
    double least_gain_db = 0, most_gain_db = 0;
    double least_frame_rate_hz = 0, most_frame_rate_hz = 0;
    // The camera sets them itself (automatic exposure, a sequence, a line-scan shutter): any change is
    // refused.
    bool exposure_is_own = false, gain_is_own = false, frame_rate_is_own = false;
};

// Changes take effect with the next frame whose exposure has not begun. A value outside the limits changes
// nothing and gives false. All functions: any thread, never from the loop (they may take a lock).
class CameraControl {
  public:
    virtual ~CameraControl() = default;
    virtual CameraSettings settings() const = 0;
    virtual CameraLimits limits() const = 0;
    virtual bool set_exposure_s(double value) = 0;
    virtual bool set_gain_db(double value) = 0;
    virtual bool set_frame_rate_hz(double value) = 0;
    virtual void set_running(bool running) = 0;
};

}  // namespace hilcam
