#pragma once
// When the next frame begins, by the camera's mode, and with which settings.
//
//   free-run    on an absolute raster of the frame rate that never drifts and never catches up (clock.h)
//   triggered   at each trigger, and for a burst at the frame rate after it; every frame of an order is
//               taken, however late
//   lockstep    as soon as an `expose` has come, at the simulated time it names: no clock is waited for, so
//               the same commands give the same frames on any machine
//
// Settings are those of the instant the exposure begins.

#include <atomic>
#include <cstdint>

#include "emulator/clock.h"
#include "emulator/live_settings.h"
#include "emulator/shutter_timing.h"

namespace hilcam {

class FrameStarter {
  public:
    FrameStarter(const CameraModel& camera, LiveSettings& settings, SimulatedClock& clock, bool paced);

    struct Start {
        CameraSettings settings;
        double exposure_s = 0;      // the settings', or what the camera has set itself
        std::int64_t begin_ns = 0;  // of the exposure, CLOCK_MONOTONIC; in lockstep as if that ran with it
        std::int64_t not_before_ns = 0;  // its end: when it may be published; 0: at any time
        std::uint64_t skipped = 0;       // exposures that could not be taken before it
        bool late = false;               // of a trigger: begun more than a period after its time
        std::uint32_t trigger_sequence = 0;
        bool ends_order = false;
    };
    // Waits for the next frame's begin. own_exposure_s: what automatic exposure has found; 0: nothing yet.
    // False when `stopping`. Loop, one thread.
    bool next(double own_exposure_s, const std::atomic<bool>& stopping, Start& start);

  private:
    bool begin_free_run(const std::atomic<bool>& stopping, Start& start);
    bool begin_ordered(const std::atomic<bool>& stopping, Start& start);
    bool take_order(const CameraSettings& settings, double exposure_s);
    void forget_orders();
    bool sleep_until(std::int64_t ns, const std::atomic<bool>& stopping) const;
    double period_s(const CameraSettings& settings, double exposure_s) const;
    double exposure_of(const CameraSettings& settings) const;

    LiveSettings& settings_;
    SimulatedClock& clock_;
    ShutterTiming timing_;
    bool lockstep_, paced_;
    double longest_step_s_ = 0;  // of the camera's sequence
    double own_exposure_s_ = 0;
    FrameSchedule schedule_;
    bool idle_ = true;
    TriggerOrder order_;
    std::int64_t left_ = 0;     // frames of the order
    std::int64_t next_ns_ = 0;  // begin of the order's next frame
    TimeTai last_mid_;          // lockstep
};

}  // namespace hilcam
