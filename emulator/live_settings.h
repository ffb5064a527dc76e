#pragma once
// The camera's settings while it runs: changed by commands and camera interfaces, read by the loop without a
// lock.

#include <atomic>
#include <mutex>

#include "io/camera_control.h"
#include "render/latest.h"
#include "sensor/camera_model.h"

namespace hilcam {

class LiveSettings : public CameraControl {
  public:
    explicit LiveSettings(const CameraModel& camera);

    CameraSettings settings() const override;
    CameraLimits limits() const override { return limits_; }
    bool set_exposure_s(double value) override;
    bool set_gain_db(double value) override;
    bool set_frame_rate_hz(double value) override;
    void set_running(bool running) override;

    // Loop, one thread. No lock.
    const CameraSettings& read_in_loop() { return latest_.read(); }
    // Loop: what a camera that sets them itself has set; settings() tells it.
    void tell_own(double exposure_s, double gain_db) {
        if (limits_.exposure_is_own) own_exposure_s_.store(exposure_s, std::memory_order_relaxed);
        if (limits_.gain_is_own) own_gain_db_.store(gain_db, std::memory_order_relaxed);
    }

  private:
    bool set(double CameraSettings::*member, double value, double least, double most);

    CameraLimits limits_;
    mutable std::mutex mutex_;
    CameraSettings settings_;
    Latest<CameraSettings> latest_;
    std::atomic<double> own_exposure_s_, own_gain_db_;
};

}  // namespace hilcam
