#pragma once
// The lines of one camera: what its inputs do, and what its outputs show.
//
//     wire -> LineInverter -> level -> trigger (trigger_input.h), counters, timers
//     exposures, frames, triggers -> counters, timers -> LineSource -> LineInverter -> wire
//
// Edges of inputs come with their times, also with times to come; those of outputs are taken with
// take_output(), in order. An output shows an exposure from its nominal begin to its nominal end: it changes
// when tick() is called then, and each edge carries the nominal instant.
//
// The loop posts its events without a lock; tick() takes them, at wake_ns() or when on_wake()'s function was
// called. With nothing to follow them, posts are dropped at once. Exposures of triggers are posted when the
// trigger is taken, so that outputs do not wait for the loop. Right after a change to triggered mode the loop
// may begin such a frame later, once the exposure under way is over; an output then shows both begins.
//
// Threads: post() loop; all other functions any thread but the loop.

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <mutex>
#include <vector>

#include "io/contract/camera_control.h"
#include "io/contract/frame_sink.h"
#include "io/lines/line_counter.h"
#include "io/lines/line_edge.h"
#include "io/lines/line_timer.h"
#include "io/lines/line_words.h"
#include "io/lines/trigger_input.h"
#include "io/system/bounded_queue.h"

namespace hilcam {

// The lines that a camera has. They do not change.
struct LinePlan {
    std::array<bool, kLines> is_there{true}, is_output{};
    std::array<bool, kLines> has_pin{};       // true: a pin of the machine is behind it
    std::array<LineSignal, kLines> source{};  // at power-up
    std::array<bool, kLines> inverted{};
};

// The settings of clients, which user sets keep.
struct LineSettings {
    std::array<LineSignal, kLines> source{};
    std::array<bool, kLines> inverted{};
    std::uint32_t user_outputs = 0;  // bits
    std::array<LineCounter::Settings, kCounters> counters{};
    std::array<LineTimer::Settings, kTimers> timers{};
};

class CameraLines {
  public:
    static constexpr std::int64_t kNever_ns = CameraControl::kNeverReady_ns;
    static constexpr std::size_t kMaxEdgesToCome = 64;

    explicit CameraLines(CameraControl& camera, const LinePlan& plan = {});

    const LinePlan& plan() const { return plan_; }

    // --- inputs
    // Takes an edge of a wire, at once or at its time if that is to come. False for a line that is no input,
    // and when too many edges wait. An edge to the level that a wire has is none.
    bool edge(const LineEdge& edge, std::int64_t now_ns);
    // Gives Line0 a pulse without length, as the command `expose` does, and the camera the trigger that it
    // makes.
    TriggerResult pulse(const TriggerOrder& order);

    // --- events of the camera
    struct Happening {
        LineEvent event = LineEvent::kOff;
        std::int64_t at_ns = 0, end_ns = 0;  // end: when an exposure that begins will end
    };
    // An exposure may be posted twice, when its trigger is taken and when the loop begins it, in any order:
    // the second post says no more than its end.
    void post(const Happening& happening) noexcept;
    // Exposures that were posted to come, and have not begun, will not.
    void drop_exposures() noexcept { post({}); }

    // --- time
    void tick(std::int64_t now_ns);
    std::int64_t wake_ns() const;
    // Sets the function that asks for a tick() soon; called by any thread, the loop too: it must not lock.
    // Call this before the threads start.
    void on_wake(std::function<void()> wake) { wake_ = std::move(wake); }
    // Takes the oldest edge of an output that has not been taken; false when there is none.
    bool take_output(LineEdge& edge);
    // Sets the function that takes edges of inputs as the camera sees them, with a lock held: it must not
    // call back. Call this before the threads start.
    void on_edge(std::function<void(const LineEdge&)> tell) { tell_ = std::move(tell); }

    // The camera's settings have changed: asks for a tick() soon.
    void camera_changed() {
        if (wake_) wake_();
    }

    // --- registers
    LineSettings settings() const;
    void change(const LineSettings& settings, std::int64_t now_ns);
    std::uint32_t levels() const;  // bits by line: the camera's levels of inputs, the wires' of outputs
    LineCounter counter(std::size_t i) const;
    LineTimer timer(std::size_t i) const;
    void reset_counter(std::size_t i, std::int64_t now_ns);
    void set_counter(std::size_t i, std::uint32_t value);
    void start_timer(std::size_t i, std::int64_t now_ns);
    // Returns how many posts were lost because tick() came too late.
    std::uint64_t lost() const { return lost_.load(std::memory_order_relaxed); }

  private:
    static constexpr std::int64_t kPoll_ns = 5'000'000;  // for FrameTriggerWait and levels
    static constexpr std::size_t kMaxOut = 256;

    struct Span {
        std::int64_t begin_ns = 0, end_ns = 0;  // end: kNever_ns while it is not known
    };
    void take_edge(const LineEdge& edge);
    void take(const Happening& happening);
    void expect_exposure(const Span& exposure);
    bool know_end(const Span& exposure);
    void fire(LineEvent event, bool rises, std::int64_t at_ns);
    bool step(std::int64_t now_ns);
    void step_until(std::int64_t now_ns);
    void settle(std::int64_t at_ns);
    bool level_of(LineSignal signal, std::int64_t at_ns) const;
    bool uses(LineSignal signal) const;
    void know_listening();
    std::int64_t next_ns() const;

    CameraControl& camera_;
    Sequencer* const sequencer_;  // may be null
    const LinePlan plan_;
    mutable std::mutex mutex_;
    LineSettings settings_;
    std::array<bool, kLines> wire_{}, level_{};
    TriggerInput trigger_;
    std::array<LineCounter, kCounters> counters_{};
    std::array<LineTimer, kTimers> timers_{};
    std::vector<LineEdge> to_come_;         // in order of time
    std::vector<Span> exposures_to_come_;   // in order of their begin
    Span exposure_;                         // the one that lasts, if exposing_; the last one otherwise
    std::array<std::int64_t, 16> known_{};  // begins of the newest exposures
    std::size_t known_count_ = 0;
    bool exposing_ = false, frame_active_ = false;
    std::int64_t ticked_ns_ = 0;
    std::vector<LineEdge> out_;
    BoundedQueue<Happening, 256> posts_;
    std::atomic<bool> listening_{false};
    std::atomic<std::uint64_t> lost_{0};
    std::function<void()> wake_;
    std::function<void(const LineEdge&)> tell_;
};

// Passes the loop's events on to a camera's lines.
class LineWatch final : public FrameSink {
  public:
    explicit LineWatch(CameraLines& lines) : lines_(lines) {}
    void start() override {}
    void publish(const DnImage& frame, const FrameRecord& record) noexcept override;
    void on_event(const CameraEvent& event) noexcept override;
    void stop() noexcept override {}
    SinkReport report() const override { return {}; }

  private:
    CameraLines& lines_;
};

}  // namespace hilcam
