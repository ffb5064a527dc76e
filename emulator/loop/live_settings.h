#pragma once
// The settings of a running camera, and its trigger input. Commands and camera interfaces change them; the
// loop reads them without a lock.

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <limits>
#include <mutex>

#include "emulator/loop/settings_history.h"
#include "emulator/loop/shutter_timing.h"
#include "emulator/world/clock.h"
#include "emulator/world/pose_watch.h"
#include "io/contract/camera_control.h"
#include "io/lines/sequencer.h"
#include "io/system/timed_semaphore.h"
#include "render/vocabulary/latest.h"
#include "render/vocabulary/time.h"
#include "sensor/camera_model.h"

namespace hilcam {

class LiveSettings : public CameraControl {
  public:
    struct Mode {
        bool lockstep = false;
        bool triggered = false;   // at power-up
        bool fixed_size = false;  // true: an output cannot follow a change of binning
    };
    explicit LiveSettings(const CameraModel& camera) : LiveSettings(camera, Mode{}) {}
    LiveSettings(const CameraModel& camera, const Mode& mode);
    // Sets the clock for frames and triggers, and the watch that can stop frames when poses are missing.
    // Without this call, the machine's clock is used, and no watch. Both must outlive the settings. Call
    // before the threads start.
    void follow(const SimulatedClock& clock, const PoseWatch* poses) { clock_ = &clock, poses_ = poses; }

    CameraSettings settings() const override;
    double resulting_frame_rate_hz() const override;
    CameraLimits limits() const override { return limits_; }
    Sequencer* sequencer() override { return limits_.has_sequencer ? &sequencer_ : nullptr; }
    // Changes settings from now on, or from an instant of the camera's time (clock.h), past or near future.
    bool change(const SettingsChange& change) override;
    bool change(const SettingsChange& change, std::int64_t from_camera_ns);
    // True when change() would accept the change now.
    bool takes(const SettingsChange& change) const;
    // Missed: the trigger arrives before the camera, at its highest frame rate, can have finished the
    // previous frame or burst. This never happens once that frame has left the camera (FrameStarter::Start).
    // The loop reports when a running burst will be finished; for a waiting burst, the settings and clock at
    // the trigger's arrival count. In lockstep, a trigger is missed when kMaxWaiting are waiting. Not armed:
    // the camera is stopped or in free-run, or frames wait for poses (pose_watch.h).
    TriggerResult trigger(const TriggerOrder& order) override;
    std::int64_t trigger_ready_ns() const override;
    std::int64_t monotonic_after(std::int64_t from_monotonic_ns, double camera_s) const override {
        return clock_->monotonic_of_camera(clock_->camera_at(from_monotonic_ns) + to_ns(camera_s));
    }
    // Sets a function that is called, with a lock held, for every missed trigger; it must not call back. Set
    // before the threads start.
    void on_missed_trigger(std::function<void(std::int64_t monotonic_ns)> tell) { missed_ = std::move(tell); }

    // Set functions that are called, with a lock held, for every change made and for every trigger with its
    // result. They must not call back. Set before the threads start.
    void on_change(std::function<void(const SettingsChange&)> tell) { changed_ = std::move(tell); }
    void on_trigger(std::function<void(const TriggerOrder&, TriggerResult)> tell) {
        triggered_ = std::move(tell);
    }

    // Sets a function that is called, with a lock held, when a trigger for a single frame is taken: with its
    // exposure on CLOCK_MONOTONIC as far as it is known then, before the loop gets to it. begin_ns = 0:
    // exposures that were reported and have not begun will not. It must not call back. Set before the threads
    // start.
    void on_exposure(std::function<void(std::int64_t begin_ns, std::int64_t end_ns)> tell) {
        exposes_ = std::move(tell);
    }

    // For lockstep, one caller at a time: call order_in_lockstep(), then wait_for_order(). That returns when
    // the loop has sampled the world for the order's last frame or has ended, and at once when the order was
    // refused. False when it takes longer than `patience_s`.
    TriggerResult order_in_lockstep(const TriggerOrder& order);
    bool wait_for_order(double patience_s);

    // --- Loop, one thread. No lock.
    const CameraSettings& read_in_loop() { return history_in_loop().newest(); }
    // Returns the settings over time. In lockstep, frames use the newest, because orders and changes come in
    // sequence.
    const SettingsHistory& history_in_loop() { return latest_.read(); }
    Sequencer& sequencer_in_loop() { return sequencer_; }
    // Takes the next trigger in order of arrival; false when there is none.
    struct WaitingOrder : TriggerOrder {
        std::int64_t delay_ns = 0;  // delay after its time, in the camera's time
        double exposure_s = 0;      // from its until_monotonic_ns; 0: that of the settings
        std::uint64_t number = 0;   // sequence number among accepted triggers, from 0
    };
    bool take_trigger(WaitingOrder& order);
    // True for an order that came before the camera was last stopped or switched to free-run. It is dropped
    // even if the loop was busy until everything was as before. Not in lockstep.
    bool is_dropped(const WaitingOrder& order) const {
        return order.number < dropped_below_.load(std::memory_order_acquire);
    }
    // Takes the next trigger if it is dropped; false otherwise.
    bool take_dropped();
    // Returns after a change or a trigger, at the latest after 50 ms.
    void wait_for_news() {
        static_cast<void>(news_.try_acquire_for(kLongestWait_ns));
        news_.take_all();
    }
    // Makes the loop check again what it waits for. Any thread.
    void wake() { news_.release(); }
    // Ends the handling of orders.
    void close() { closed_.store(true); }
    bool is_closed() const { return closed_.load(); }
    // Call when all frames of an order are rendered, or the order is dropped.
    void order_done() { done_.release(); }
    // True after a change or a trigger, at the latest after 50 ms; false when the instant has come.
    bool wait_for_news_until(std::int64_t until_ns);
    // Takes over the values that automatic exposure has set; settings() then returns them.
    void report_own(double exposure_s, double gain_db) {
        own_exposure_s_.store(exposure_s, std::memory_order_relaxed);
        own_gain_db_.store(gain_db, std::memory_order_relaxed);
    }

    // Returns the shortest time from a trigger to the next, in the camera's time.
    std::int64_t shortest_period_ns(TriggerOverlap overlap, double exposure_s) const {
        const double period_s = overlap == TriggerOverlap::kOff
                                    ? timing_.period_with_readout_s(limits_.max_frame_rate_hz, exposure_s)
                                    : timing_.period_s(limits_.max_frame_rate_hz, exposure_s);
        return to_ns(period_s);
    }

    // Call when all accepted orders have begun or are dropped. frame_ns, order_ns: instants of the camera's
    // time at which it will have finished the newest frame and the rest of that frame's order.
    void report_ready(std::int64_t frame_ns, std::int64_t order_ns) {
        frame_ready_ns_.store(frame_ns, std::memory_order_relaxed);
        order_ready_ns_.store(order_ns, std::memory_order_relaxed);
        orders_begun_.store(triggers_out_.load(std::memory_order_relaxed), std::memory_order_release);
    }

    // Lockstep: sets the middle of the newest frame. Orders for that instant or an earlier one are refused.
    void report_middle(TimeTai middle) { newest_middle_ns_.store(middle.ns, std::memory_order_relaxed); }

    static constexpr std::size_t kMaxWaiting = 64;

  private:
    static constexpr std::int64_t kLongestWait_ns = 50'000'000;

    double exposure_now_s() const;
    double longest_exposure_s() const;
    bool fits(const CameraSettings& wanted, const SettingsChange& change) const;
    TriggerResult take_order(const TriggerOrder& asked);
    double exposure_of(const TriggerOrder& order) const;
    void tell_exposure(const WaitingOrder& order, std::int64_t now_ns) const;
    std::int64_t camera_time_of(const TriggerOrder& order, std::int64_t now_ns) const;
    std::int64_t ready_ns(std::uint64_t orders, std::int64_t now_ns) const;

    CameraLimits limits_;
    ShutterTiming timing_;
    const SimulatedClock* clock_;
    const PoseWatch* poses_ = nullptr;
    mutable std::mutex mutex_;
    CameraSettings settings_;
    SettingsHistory history_;
    Latest<SettingsHistory> latest_;
    std::atomic<double> own_exposure_s_, own_gain_db_;
    // Written under the mutex, with one reader.
    std::array<WaitingOrder, kMaxWaiting> triggers_;
    std::atomic<std::uint64_t> triggers_in_{0}, triggers_out_{0};
    WaitingOrder newest_order_;
    std::atomic<std::uint64_t> dropped_below_{0};
    // Written by the loop: how many of triggers_in_ no longer wait, and when the camera finishes those, in
    // its time.
    std::atomic<std::uint64_t> orders_begun_{0};
    std::atomic<std::int64_t> frame_ready_ns_{std::numeric_limits<std::int64_t>::min()};
    std::atomic<std::int64_t> order_ready_ns_{std::numeric_limits<std::int64_t>::min()};
    Sequencer sequencer_;
    TimedSemaphore news_, done_;
    std::atomic<bool> closed_{false};
    bool ordered_ = false;
    std::atomic<std::int64_t> newest_middle_ns_{0};  // 0: no frame yet
    std::function<void(std::int64_t)> missed_;
    std::function<void(const SettingsChange&)> changed_;
    std::function<void(const TriggerOrder&, TriggerResult)> triggered_;
    std::function<void(std::int64_t, std::int64_t)> exposes_;
};

}  // namespace hilcam
