#pragma once
// Decides when the next frame begins, by the camera's mode, and with which settings.
//
//   free-run    on an absolute raster of the frame rate that never drifts and never catches up
//               (frame_schedule.h); with loop.prefer `latency` a late exposure begins when it can and shows
//               the newest pose
//   triggered   at each trigger, and for a burst at the frame rate after it; every frame of an order is
//               taken, however late
//               With ExposureMode TriggerWidth an order comes at the end of its exposure and says how long
//               that was: the frame is rendered then, for the instants of the pulse
//   lockstep    as soon as an `expose` has arrived, at the simulated time it names; no clock is involved, so
//               the same commands give the same frames on any machine
//
// No exposure begins before the detector has finished the one before, even if settings or mode have changed,
// or the camera has been stopped and started.
//
// All times are the camera's (clock.h). It runs with simulated time: slower, faster, or not at all while a
// camera waits for time to go on. A scheduled trigger waits for its instant on the machine's clock or in
// simulated time, whichever it names. Where frames stop for lack of poses (pose_watch.h), no frame begins,
// and waiting orders are dropped. Orders from before a stop, or before a change to free-run, are dropped as
// well.
//
// A frame uses the settings of the instant at which its exposure begins, even if it is late: later changes
// apply to the next frame (settings_history.h). In lockstep it uses the newest settings. While the sequencer
// is on (io/lines/sequencer.h), it uses the set that is active then.

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
    // Makes `settings` use this clock. poses: null: poses are not watched.
    FrameStarter(const CameraModel& camera, LiveSettings& settings, SimulatedClock& clock,
                 const LoopLimits& limits, const PoseWatch* poses = nullptr);

    struct Start {
        CameraSettings settings;
        double exposure_s = 0;  // from the settings, or set by the camera itself
        // Begin of the exposure on CLOCK_MONOTONIC; in lockstep, as if that clock ran with simulated time.
        std::int64_t begin_ns = 0;
        std::int64_t camera_ns = 0;  // begin in the camera's time
        bool until_end = false;      // true: the frame must not be published before the exposure's end
        // A triggered frame must not be published before this instant of the camera's time, at which the
        // camera is ready again: a client that triggers the next frame on arrival of this one would be too
        // early otherwise.
        std::int64_t ready_camera_ns = std::numeric_limits<std::int64_t>::min();
        std::int64_t period_ns = 0;  // time until the next exposure is due, camera's time; 0: unknown
        std::uint64_t skipped = 0;   // exposures before it that were skipped
        bool late = false;           // true: a triggered frame that began more than a period after its time
        std::uint32_t trigger_sequence = 0;
        bool ends_order = false;
        std::int64_t sequencer_set = Sequencer::kNone;
        PoseWatch::Silence silence;  // state of the poses at its begin
    };
    // Waits for the next frame's begin. own_exposure_s: result of automatic exposure; 0: none yet. Returns
    // false when `stopping`. Loop, one thread.
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
    void use_sequencer(Start& start);
    void report_begun(const Start& start);

    LiveSettings& settings_;
    SimulatedClock& clock_;
    const PoseWatch* poses_;
    ShutterTiming timing_;
    bool lockstep_, paced_;
    bool prefers_newest_;  // true: late exposures begin when they can, not on the raster
    double own_exposure_s_ = 0;
    FrameSchedule schedule_;
    bool idle_ = true;
    LiveSettings::WaitingOrder order_;
    std::int64_t left_ = 0;     // frames left of the order
    bool order_begun_ = false;  // true: its first frame has begun
    std::int64_t next_ns_ = 0;  // begin of the order's next frame, camera's time
    // When the detector has finished the newest frame, and the camera the newest frame of an order, camera's
    // time.
    std::int64_t over_ns_ = std::numeric_limits<std::int64_t>::min();
    std::int64_t ready_ns_ = std::numeric_limits<std::int64_t>::min();
    TimeTai last_mid_;  // in lockstep
};

}  // namespace hilcam
