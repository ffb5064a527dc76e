#pragma once
// The camera's settings while it runs, and its trigger input: changed by commands and camera interfaces, read
// by the loop without a lock.

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
        bool fixed_size = false;  // an output cannot follow a change of binning
    };
    explicit LiveSettings(const CameraModel& camera) : LiveSettings(camera, Mode{}) {}
    LiveSettings(const CameraModel& camera, const Mode& mode);
    // Sets the clock that frames and triggers go by, and the watch that may say that there shall be none;
    // without this call it is the machine's clock, and no watch. Both outlive the settings. Is called before
    // the threads start.
    void follow(const SimulatedClock& clock, const PoseWatch* poses) { clock_ = &clock, poses_ = poses; }

    CameraSettings settings() const override;
    double resulting_frame_rate_hz() const override;
    CameraLimits limits() const override { return limits_; }
    // From now on; or from an instant of the camera's time (clock.h) on that may have passed, or be about to come.
    bool change(const SettingsChange& change) override;
    bool change(const SettingsChange& change, std::int64_t from_camera_ns);
    // True where change() would make it now.
    bool takes(const SettingsChange& change) const;
    // A trigger is missed when it comes before the frame or burst before it can be over, at the camera's
    // highest frame rate: never when that frame has left the camera (FrameStarter::Start). When a burst that
    // has begun is over says the loop; one that waits goes by what holds when the trigger comes, settings and
    // clock. Or, in lockstep, when kMaxWaiting are waiting. Not armed: also where frames wait for poses
    // (pose_watch.h).
    TriggerResult trigger(const TriggerOrder& order) override;
    // Called with a lock held for every trigger that is missed; must not call back. Before the threads start.
    void on_missed_trigger(std::function<void(std::int64_t monotonic_ns)> tell) { missed_ = std::move(tell); }

    // Called with a lock held for every change that is made, and for every trigger with what became of it;
    // must not call back. Before the threads start.
    void on_change(std::function<void(const SettingsChange&)> tell) { changed_ = std::move(tell); }
    void on_trigger(std::function<void(const TriggerOrder&, TriggerResult)> tell) {
        triggered_ = std::move(tell);
    }

    // Lockstep, one caller at a time: trigger(), to be followed by wait_for_order(), which returns when the
    // loop has seen the world for the order's last frame or has ended, or at once when it was not taken.
    // False when that takes longer than `patience_s`.
    TriggerResult order_in_lockstep(const TriggerOrder& order);
    bool wait_for_order(double patience_s);

    // --- Loop, one thread. No lock.
    const CameraSettings& read_in_loop() { return history_in_loop().newest(); }
    // The settings over time. In lockstep frames have the newest, as orders and changes come in turn.
    const SettingsHistory& history_in_loop() { return latest_.read(); }
    // The next trigger in its order of arrival; false when there is none.
    struct WaitingOrder : TriggerOrder {
        std::int64_t delay_ns = 0;  // after its time, of the camera's time
        std::uint64_t number = 0;   // its place among those that were taken, from 0
    };
    bool take_trigger(WaitingOrder& order);
    // True for an order that came before the camera was last stopped, or switched to free-run: it is dropped, also where
    // the loop was busy until all was as before. Not in lockstep.
    bool is_dropped(const WaitingOrder& order) const {
        return order.number < dropped_below_.load(std::memory_order_acquire);
    }
    // Takes the next trigger if it is dropped; false when there is none or it is not.
    bool take_dropped();
    // Returns after a change or a trigger, or after 50 ms.
    void wait_for_news() {
        static_cast<void>(news_.try_acquire_for(kLongestWait_ns));
        news_.take_all();
    }
    // Any thread: the loop shall look anew at what it waits for.
    void wake() { news_.release(); }
    // No order will be looked at any more.
    void close() { closed_.store(true); }
    bool is_closed() const { return closed_.load(); }
    // All frames of an order are rendered, or the order is dropped.
    void order_done() { done_.release(); }
    // True at once when there is a change or a trigger, or after 50 ms; false when the instant has come.
    bool wait_for_news_until(std::int64_t until_ns);
    // Takes over what a camera that sets them itself has set; settings() tells it.
    void report_own(double exposure_s, double gain_db) {
        own_exposure_s_.store(exposure_s, std::memory_order_relaxed);
        own_gain_db_.store(gain_db, std::memory_order_relaxed);
    }

    // Returns how long the camera is busy with a frame at the least, in its own time.
    std::int64_t shortest_period_ns(double exposure_s) const {
        return to_ns(timing_.period_s(limits_.max_frame_rate_hz, exposure_s));
    }

    // No order waits: all that were taken have begun, or are dropped. The camera is over with the newest frame, and with
    // what is left of its order, at those instants of its time.
    void report_ready(std::int64_t frame_ns, std::int64_t order_ns) {
        frame_ready_ns_.store(frame_ns, std::memory_order_relaxed);
        order_ready_ns_.store(order_ns, std::memory_order_relaxed);
        orders_begun_.store(triggers_out_.load(std::memory_order_relaxed), std::memory_order_release);
    }

    // Lockstep: the middle of the newest frame; none is ordered for an instant that is not after it.
    void report_middle(TimeTai middle) { newest_middle_ns_.store(middle.ns, std::memory_order_relaxed); }

    static constexpr std::size_t kMaxWaiting = 64;

  private:
    static constexpr std::int64_t kLongestWait_ns = 50'000'000;

    double exposure_now_s() const;
    bool fits(const CameraSettings& wanted, const SettingsChange& change) const;
    TriggerResult take_order(const TriggerOrder& asked);
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
    // Writers under the mutex, one reader.
    std::array<WaitingOrder, kMaxWaiting> triggers_;
    std::atomic<std::uint64_t> triggers_in_{0}, triggers_out_{0};
    WaitingOrder newest_order_;
    std::atomic<std::uint64_t> dropped_below_{0};
    // The loop's: how many of triggers_in_ no longer wait, and when the camera is over with them, in its time.
    std::atomic<std::uint64_t> orders_begun_{0};
    std::atomic<std::int64_t> frame_ready_ns_{std::numeric_limits<std::int64_t>::min()};
    std::atomic<std::int64_t> order_ready_ns_{std::numeric_limits<std::int64_t>::min()};
    TimedSemaphore news_, done_;
    std::atomic<bool> closed_{false};
    bool ordered_ = false;
    std::atomic<std::int64_t> newest_middle_ns_{0};  // 0: no frame yet
    std::function<void(std::int64_t)> missed_;
    std::function<void(const SettingsChange&)> changed_;
    std::function<void(const TriggerOrder&, TriggerResult)> triggered_;
};

}  // namespace hilcam
