#pragma once
// THE loop: pose -> radiance -> electrons -> DN -> sinks, frame after frame.
//
// Two threads, each a stage: `render` samples the world and traces, `sense` exposes, digitises and publishes.
// Both use oneTBB's threads inside. Frames pass through two slots allocated before the start; hand-over is by
// semaphores. loop.prefer:
//   throughput  while a frame is sensed the next one is rendered: frames come as fast as the longer stage
//               goes
//   latency     the next one waits until it is out: each stage has all threads to itself, so a frame is
//               through sooner; frames come as fast as both stages together go
// Pixels are the same in both.
//
// When frames begin is frame_starter.h's business. Timing in free-run: frame k begins at s_k = s_0 + k period
// in the camera's time (clock.h: at scale 1 that of CLOCK_MONOTONIC); its middle, its end and the period
// follow from exposure, frame rate and shutter (shutter_timing.h). Rendering begins at s_k and shows the pose
// of the middle, propagated; the frame leaves not before its end. Example of a global shutter at 30 Hz and 2
// ms: rendering starts at 0.0, the pose is that of 1.0 ms, a frame computed in 25 ms leaves at 25 ms, the
// next rendering starts at 33.3 ms. A start missed by more than a period is skipped and counted; frame ids
// leave a gap there.
//
// Settings of a frame: exposure and gain are those of the live settings, or of its step of the camera's
// sequence, or with automatic exposure what the frame two before it in the loop asks for: that is the one
// whose slot it takes over, so it does not depend on timing. Faults of a frame are those that are in force
// when it begins.
//
// While simulated time stands, or poses are stale and the world is to be held (pose_watch.h), a frame shows
// the world at one instant, without blur; where the shutter is to be closed then, nothing is rendered.
//
// Quality: with a frame budget the governor (governor.h) chooses each frame's level by what earlier frames
// took: the longer of the two stages, or with latency both, as that is how long the next frame has to wait.
// It is told of a frame when its slot is taken over, two frames later. Off in lockstep, where frames must not
// depend on the machine, and where frames are not paced.
//
// Light: what is made beside the run (Renderer::give_tables) is taken as a frame begins; frames before that
// say so.
//
// Recordings: with a recorder each frame leaves what it depends on (frame_script.h) and which commands it
// shows, right before it is published; with a script it is the script that says when frames begin and what
// they depend on, and clock, live settings, governor and faults do not matter.
//
// After start() both threads neither allocate nor lock nor log, but for what Embree does inside
// rtcCommitScene.

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <semaphore>
#include <thread>
#include <vector>

#include "emulator/loop/exposure_renderer.h"
#include "emulator/loop/frame_recorder.h"
#include "emulator/loop/frame_script.h"
#include "emulator/loop/frame_starter.h"
#include "emulator/loop/governor.h"
#include "emulator/loop/latency.h"
#include "emulator/loop/live_settings.h"
#include "emulator/loop/shutter_timing.h"
#include "emulator/scenario/quality_ladder.h"
#include "emulator/world/clock.h"
#include "emulator/world/frame_watcher.h"
#include "emulator/world/pose_watch.h"
#include "emulator/world/world_state.h"
#include "io/contract/frame_sink.h"
#include "io/system/bounded_queue.h"
#include "io/truth/sink_truth.h"
#include "render/frame/renderer.h"
#include "sensor/chain.h"

namespace hilcam {

// How long each stage took, per frame.
struct StageMeters {
    DurationHistogram setup, trace, stars, collapse, convolve, points, digitise, publish, render, sense;
    DurationHistogram work;      // render, sense and publish: the frame without its waits
    DurationHistogram interval;  // from one frame handed over to the next
    // From the arrival of the newest command that a frame is the first to show to the frame handed over.
    DurationHistogram latency;

    // After warming up.
    void clear() {
        for (DurationHistogram* meter : {&setup, &trace, &stars, &collapse, &convolve, &points, &digitise,
                                         &publish, &render, &sense, &work, &interval, &latency})
            meter->clear();
    }
};

struct LoopCounters {
    std::atomic<std::uint64_t> frames{0};
    // Exposures skipped, or of a trigger begun a period late, because the one before took too long.
    std::atomic<std::uint64_t> deadline_misses{0};
    std::atomic<std::uint64_t> last_id{0};
    std::atomic<std::uint64_t> motion_limited{0};      // frames with more motion than exact motion divides
    std::atomic<std::uint64_t> standing{0}, stale{0};  // frames while time stood; while no poses came
    // Frames before the kept light that they ask for was there: how many, and the newest one.
    std::atomic<std::uint64_t> without_light{0}, last_without_light{0};
    std::atomic<bool> lacks_light{false};  // the newest frame is one
    // Quality levels: that of the newest frame, how often it changed, how many frames each has had.
    std::atomic<std::uint32_t> level{0}, level_changes{0};
    std::array<std::atomic<std::uint64_t>, kMaxLevels> frames_at_level{};
    // With a noise budget: pixels with light, those within it, of all frames; the share in the newest and the
    // worst frame (1 without light).
    std::atomic<std::uint64_t> lit_px{0}, within_budget_px{0};
    std::atomic<double> within_budget{1}, worst_within_budget{1};
};

// The governor's decision, from a frame on.
struct LevelChange {
    std::uint64_t frame = 0;
    std::size_t from = 0, to = 0;
    double mean_ms = 0;  // of the frames before it
};

struct LoopLimits {
    std::uint64_t frames = 0;   // 0: no limit
    std::uint64_t warm_up = 0;  // of them, the first: their times are not kept
    bool paced = true;          // false: as fast as it goes, for benchmarks
    GovernorSettings governor{};
    LoopPreference prefer = LoopPreference::kThroughput;
};

class FrameLoop {
  public:
    FrameLoop(ExposureRenderer& exposures, SensorChain& chain, const CameraModel& camera, WorldState& world,
              LiveSettings& settings, FaultBoard& faults, SimulatedClock& clock,
              std::vector<FrameSink*> sinks, std::uint64_t seed, const LoopLimits& limits,
              const PoseWatch* poses = nullptr);
    ~FrameLoop() { stop(); }

    // Before start(); they outlive the loop. Cameras count from 1.
    void record_to(FrameRecorder& recorder, std::uint16_t camera);
    void follow(FrameScript& script) { script_ = &script; }
    void notify(FrameWatcher& watcher) { watcher_ = &watcher; }
    // One of the sinks, which is told what frames show while they are rendered. Before start().
    void report_truth_to(TruthSink& sink) { truth_ = &sink; }

    void start();
    void stop() noexcept;
    bool finished() const { return finished_.load(); }

    const SimulatedClock& clock() const { return clock_; }
    const LoopCounters& counters() const { return counters_; }
    const StageMeters& meters() const { return meters_; }
    // One thread. False: there is none that was not taken yet.
    bool take_level_change(LevelChange& change) noexcept { return level_changes_.pop(change); }
    // Of the frame rendered last; for benchmarks, when the loop is stopped.
    const RenderStats& render_stats() const { return stats_; }
    // What processor_ns() was after the last frame of warming up; likewise.
    std::int64_t warm_processor_ns() const { return warm_processor_ns_; }

  private:
    struct Slot {
        RadianceImage radiance;
        std::vector<PointSource> points;
        std::vector<SideLight> beside;
        FrameUse use;
        FrameRecord record;
        std::vector<std::uint64_t> shown_numbers;  // for the recorder: the newest command of each thing
        Exposure exposure;
        std::int64_t not_before_ns = 0;  // of a script's frame: may be published; 0: at any time
        std::int64_t middle_camera_ns = 0, end_camera_ns = 0;  // of the exposure, camera's time
        bool until_end = false;                                // not to be published before
        double next_exposure_s = 0;  // automatic: of the slot's next frame; 0: not measured yet
        bool automatic = false;
        bool ends_order = false;
        std::int64_t render_ns = 0, sense_ns = 0;  // how long its last frame took; 0: there was none
    };

    void render_frames();
    void sense_frames();
    bool begin(Slot& slot);
    void take_settings(const FrameStarter::Start& start, Slot& slot);
    void latch(Slot& slot);
    void place_in_time(const FrameStarter::Start& start, Slot& slot);
    double frame_ms(const Slot& slot) const;
    std::uint32_t choose_level(const Slot& slot, std::uint64_t frame);
    void use_level(std::uint32_t level);
    void take_light(FrameUse& use);
    void render_into(Slot& slot);
    void count_budget();
    void notify_watcher(const Slot& slot);
    void sense(Slot& slot);
    void keep(const Slot& slot);
    void finish_picture(const Slot& slot);
    void wait_to_publish(const Slot& slot) const;
    void know_machine_times(Slot& slot) const;
    void notify(CameraEvent::Kind kind, std::uint64_t frame, std::int64_t monotonic_ns) const;
    void measure_exposure(Slot& slot);

    ExposureRenderer& exposures_;
    SensorChain& chain_;
    const CameraModel camera_;
    ShutterTiming timing_;
    WorldState& world_;
    LiveSettings& settings_;
    FaultBoard& faults_;
    SimulatedClock& clock_;
    const PoseWatch* poses_;
    FrameStarter starter_;
    std::vector<FrameSink*> sinks_;
    TruthSink* truth_ = nullptr;  // may be null
    std::uint64_t seed_;
    LoopLimits limits_;
    bool lockstep_;
    Governor governor_;
    BoundedQueue<LevelChange, 64> level_changes_;
    FrameScript* script_ = nullptr;  // may be null, as the next two
    FrameWatcher* watcher_ = nullptr;
    FrameRecorder* recorder_ = nullptr;
    std::uint16_t recorded_camera_ = 0;
    std::vector<std::uint64_t> recorded_shown_;  // the sensing thread's
    std::uint64_t last_id_ = 0;                  // the rendering thread's, as the next
    std::uint32_t level_ = 0;

    std::array<Slot, 2> slots_;
    std::counting_semaphore<> free_, rendered_{0};
    RenderStats stats_;
    std::int64_t shown_arrival_ns_ = 0;
    std::uint64_t flagged_ = 0;  // of the time tags that went back, how many frames have told
    ElectronImage electrons_;
    DnImage frame_, before_;    // the one being finished, and the one published before it
    FrameHistogram histogram_;  // for automatic exposure
    std::int64_t last_published_ns_ = 0, warm_processor_ns_ = 0;

    LoopCounters counters_;
    StageMeters meters_;
    std::atomic<bool> stopping_{false}, finished_{false};
    std::thread render_thread_, sense_thread_;
};

}  // namespace hilcam
