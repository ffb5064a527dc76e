#pragma once
// A small scene and the frame loop around it, for tests of timing and modes.

#include <algorithm>
#include <condition_variable>
#include <mutex>
#include <string>
#include <vector>

#include "emulator/run/command_dispatch.h"
#include "emulator/run/emulator.h"
#include "emulator/run/event_director.h"
#include "emulator/run/truth_source.h"
#include "emulator/scenario/initial_world.h"
#include "emulator/scenario/lamp_setup.h"
#include "emulator/scenario/scene_loader.h"
#include "tests/support/files.h"

namespace hilcam {

// A white plate of 10 cm, 4 m before the camera, 16 px across, lit by the Sun of December, 23 degrees to its
// side of the camera.
class PlateTest : public FilesTest {
  protected:
    std::filesystem::path scenario(const std::string& camera = "", const std::string& rest = "") {
        write("plate.obj",
              "v -0.05 -0.05 0\nv 0.05 -0.05 0\nv 0.05 0.05 0\nv -0.05 0.05 0\nf 1 3 2\nf 1 4 3\n");
        return write("scenario.yaml",
                     "time_utc: 2026-12-21T00:00:00Z\n"
                     "camera: {name: test, width_px: 64, height_px: 64, pitch_um: 10, focal_length_mm: 6.4,\n"
                     "  f_number: 8, transmission: 0.01, quantum_efficiency: 0.5, full_well_e: 20000, "
                     "gain_dn_e: 0.2, bits: 12,\n"
                     "  offset_dn: 50, read_noise_e: 5, exposure_ms: 20" +
                         camera +
                         "}\n"
                         "objects:\n  - {name: plate, mesh: plate.obj, pose: {position_m: [0, 0, 4]}}\n"
                         "earth: {visible: false}\nmoon: {visible: false}\n"
                         "spectrum_edges_um: [0.5, 0.7]\n" +
                         rest);
    }
};

// Tests of the loop as a whole stand in a file for each of its concepts.
class FrameLoopTest : public PlateTest {};

// Keeps what the loop publishes and tells.
class Collector : public FrameSink {
  public:
    struct Frame {
        FrameRecord record;
        int width = 0, height = 0;
        std::vector<std::uint16_t> dn;
    };
    std::vector<Frame> frames;
    std::vector<CameraEvent> events;

    void start() override {}
    void publish(const DnImage& frame, const FrameRecord& record) noexcept override {
        const std::lock_guard lock(mutex_);
        frames.push_back({record, frame.width(), frame.height(), {frame.all().begin(), frame.all().end()}});
        more_.notify_all();
    }
    void on_event(const CameraEvent& event) noexcept override {
        const std::lock_guard lock(mutex_);
        events.push_back(event);
    }
    void stop() noexcept override {}
    SinkReport report() const override { return {}; }
    std::size_t count() {
        const std::lock_guard lock(mutex_);
        return frames.size();
    }
    bool has_event(CameraEvent::Kind kind) {
        const std::lock_guard lock(mutex_);
        return std::any_of(events.begin(), events.end(), [&](auto& e) { return e.kind == kind; });
    }
    // False when they do not come within a minute.
    bool wait_for(std::size_t count) {
        std::unique_lock lock(mutex_);
        return more_.wait_for(lock, std::chrono::minutes(1), [&] { return frames.size() >= count; });
    }

  private:
    std::mutex mutex_;
    std::condition_variable more_;
};

inline PoseCommand camera_pose_at(TimeTai time, double x_m, double velocity_m_s = 0) {
    PoseCommand command;
    command.motion.time = time;
    command.motion.pose.position_world_m = {x_m, 0, 0};
    command.motion.velocity_world_m_s = {velocity_m_s, 0, 0};
    return command;
}

inline ExposeCommand expose(TimeTai time = {}, std::uint16_t frames = 0) { return {time, frames}; }

// The middle of the plate's light. 10 mm of the camera's way are 1.6 px of it, the other way.
inline double plate_x_px(const Collector::Frame& f) {
    double sum = 0, light = 0;
    for (std::size_t i = 0; i < f.dn.size(); ++i) {
        const double dn = std::max(0.0, f.dn[i] - 100.0);  // above noise
        light += dn, sum += dn * (static_cast<double>(i % static_cast<std::size_t>(f.width)) + 0.5);
    }
    return sum / light;
}

// The loop with all it needs; nothing runs before loop.start().
struct LoopRig {
    ScenarioConfig scenario;
    SpectralGrid grid;
    std::unique_ptr<Renderer> renderer;
    SensorChain chain;
    TimeTai start;
    WorldState world;
    LiveSettings settings;
    FaultBoard faults;
    SimulatedClock clock;
    PoseWatch poses;
    ExposureRenderer exposures;
    CommandDispatch dispatch;
    Collector collector;
    std::unique_ptr<TruthSink> truth;  // with outputs.truth
    FrameLoop loop;

    LoopRig(const std::filesystem::path& file, const LoopLimits& limits,
            const std::vector<std::string>& overrides = {})
        : scenario(load_scenario(file, overrides)),
          grid(scenario.spectrum_edges_um),
          renderer(load_renderer(scenario, grid,
                                 geometry_of(scenario.camera, static_cast<int>(scenario.quality.guard_px)))),
          chain(scenario.camera, grid, sampling_of(scenario)),
          start(parse_utc(scenario.time_utc)),
          world(initial_motions(scenario, start), scenario.origin, joints_of(scenario), {}, {},
                lamp_mounts(scenario)),
          settings(scenario.camera, {.lockstep = scenario.mode == CameraMode::kLockstep,
                                     .triggered = scenario.mode == CameraMode::kTriggered}),
          faults(1),
          clock(start, monotonic_ns(), scenario.mode == CameraMode::kLockstep, scenario.clock),
          poses(scenario.commands.poses, scenario.mode == CameraMode::kLockstep),
          exposures(*renderer, exposure_config_of(scenario), scenario.camera, grid, world.placed_objects()),
          dispatch({{&world, &settings, &faults}}, clock, &poses),
          truth(scenario.outputs.find<TruthConfig>() ? make_truth_sink(scenario, grid, 1, *renderer)
                                                     : nullptr),
          loop(parts(limits)) {
        if (truth) truth->start();
    }
    ~LoopRig() {
        loop.stop();
        if (truth) truth->stop();
    }

    // What its loop is made of; another loop may be made of it, with other sinks or observers.
    LoopParts parts(const LoopLimits& limits) {
        LoopParts parts{.exposures = exposures,
                        .chain = chain,
                        .camera = scenario.camera,
                        .world = world,
                        .settings = settings,
                        .faults = faults,
                        .clock = clock,
                        .poses = &poses,
                        .sinks = {&collector},
                        .limits = limits,
                        .observers = {.truth = truth.get()}};
        if (truth) parts.sinks.push_back(truth.get());
        return parts;
    }

    CommandStatus send(const Command& command) {
        return dispatch.handle(command, {++sequence_, monotonic_ns()});
    }

  private:
    std::uint32_t sequence_ = 0;
};

// A rig in lockstep whose scenario's events happen between the frames that a sender orders.
struct EventRig {
    LoopRig rig;
    EventDirector events;
    FrameLoop loop;

    explicit EventRig(const std::filesystem::path& file)
        : rig(file, {}, {"mode=lockstep"}),
          events(EventSequence(rig.scenario.events, event_world(rig.scenario), rig.start),
                 {rig.dispatch, rig.settings, rig.clock, ShutterTiming(rig.scenario.camera),
                  rig.world.placed_objects(), false}),
          loop(watched_parts()) {
        rig.dispatch.ask_events(events);
        events.start();
        loop.start();
    }
    ~EventRig() { stop(); }

    void stop() {
        events.ask_to_stop();
        loop.stop();
        events.stop();
    }

  private:
    LoopParts watched_parts() {
        LoopParts parts = rig.parts({});
        parts.observers.watcher = &events;
        return parts;
    }
};

}  // namespace hilcam
