#pragma once
// Says when the next frame begins, by the camera's mode, and with which settings.
//
//   free-run    on an absolute raster of the frame rate that never drifts and never catches up
//               (frame_schedule.h); with loop.prefer `latency` an exposure that is late begins when it can, and shows the
//               newest pose
//   triggered   at each trigger, and for a burst at the frame rate after it; every frame of an order is
//               taken, however late
//   lockstep    as soon as an `expose` has come, at the simulated time it names: no clock is waited for, so
//               the same commands give the same frames on any machine
//
// No exposure begins before the detector is over with the one before, whatever has changed meanwhile: settings, mode, or
// whether it runs at all.
//
// All of it is in the camera's time (clock.h), which goes with the simulated one: slower, faster, or, where a
// camera waits while time stands, not at all. A scheduled trigger waits for its instant on the machine's
// clock or in simulated time, whichever it names. Where frames stop without poses (pose_watch.h), none begins
// and orders that wait are dropped, as are those that came before a stop, or before a change to free-run.
//
// Settings are those of the instant the exposure begins, also of one that is late: what came after that instant is for
// the next (settings_history.h). In lockstep they are the newest.

#include <atomic>
#include <cstdint>
#include <limits>

#include "emulator/loop/frame_schedule.h"
#include "emulator/loop/live_settings.h"
#include "emulator/loop/shutter_timing.h"
#include "emulator/world/clock.h"
#include "emulator/world/pose_watch.h"

namespace hilcam {

struct LoopLimits;  // loop_parts.h

class FrameStarter {
  public:
    // Makes `settings` go by that clock. poses: null: nobody watches them.
    FrameStarter(const CameraModel& camera, LiveSettings& settings, SimulatedClock& clock,
                 const LoopLimits& limits, const PoseWatch* poses = nullptr);

    struct Start {
        CameraSettings settings;
        double exposure_s = 0;  // the settings', or what the camera has set itself
        // Begin of the exposure, CLOCK_MONOTONIC; in lockstep as if that ran with it.
        std::int64_t begin_ns = 0;
        std::int64_t camera_ns = 0;  // the same in the camera's time
        bool until_end = false;      // it may not be published before the exposure's end
        // Nor, if it was triggered, before the camera is ready again, camera's time: who triggers the next frame
        // when this one has come shall not be too early.
        std::int64_t ready_camera_ns = std::numeric_limits<std::int64_t>::min();
        std::int64_t period_ns = 0;  // until the next exposure is due, camera's time; 0: nothing says when
        std::uint64_t skipped = 0;   // exposures that could not be taken before it
        bool late = false;           // a triggered frame began more than a period after its time
        std::uint32_t trigger_sequence = 0;
        bool ends_order = false;
        PoseWatch::Silence silence;  // when it begins
    };
    // Waits for the next frame's begin. own_exposure_s: what automatic exposure has found; 0: nothing yet.
    // False when `stopping`. Loop, one thread.
    bool next(double own_exposure_s, const std::atomic<bool>& stopping, Start& start);

  private:
    bool begin_free_run(const std::atomic<bool>& stopping, Start& start);
    FrameSchedule::Slot take_slot(std::int64_t arrived_ns);
    FrameSchedule::Slot take_slot_by(const CameraSettings& settings, std::int64_t arrived_ns,
                                     FrameSchedule& schedule) const;
    bool begin_ordered(const std::atomic<bool>& stopping, Start& start);
    bool take_order(const CameraSettings& settings, double exposure_s);
    std::int64_t begin_of_order() const;
    bool wait_for_order(const std::atomic<bool>& stopping);
    void forget_orders();
    void forget_dropped();
    bool waits_for_poses() const { return poses_ && !lockstep_ && poses_->stops(clock_.now()); }
    bool sleep_until(std::int64_t camera_ns, const std::atomic<bool>& stopping) const;
    std::int64_t camera_now() const { return clock_.camera_at(monotonic_ns()); }
    double exposure_of(const CameraSettings& settings) const;

    LiveSettings& settings_;
    SimulatedClock& clock_;
    const PoseWatch* poses_;
    ShutterTiming timing_;
    bool lockstep_, paced_;
    bool prefers_newest_;  // late exposures begin when they can, not where the raster has them
    double own_exposure_s_ = 0;
    FrameSchedule schedule_;
    bool idle_ = true;
    LiveSettings::WaitingOrder order_;
    std::int64_t left_ = 0;     // frames of the order
    bool order_begun_ = false;  // the first of them has
    std::int64_t next_ns_ = 0;  // begin of the order's next frame, camera's time
    // When the detector is over with the newest frame, and the camera with the newest one of an order: its time.
    std::int64_t over_ns_ = std::numeric_limits<std::int64_t>::min();
    std::int64_t ready_ns_ = std::numeric_limits<std::int64_t>::min();
    TimeTai last_mid_;  // lockstep
};

}  // namespace hilcam
