#pragma once
// The whole emulator: builds every part of a scenario, runs it, and tears it down.

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include <tbb/global_control.h>

#include "emulator/recording/recorder.h"
#include "emulator/recording/replay.h"
#include "emulator/run/camera_station.h"
#include "emulator/run/command_dispatch.h"
#include "emulator/run/command_receivers.h"
#include "emulator/run/event_director.h"
#include "emulator/run/light_maker.h"
#include "emulator/run/silence_log.h"
#include "emulator/scenario/app_config.h"
#include "io/lines/line_bench.h"

namespace hilcam {

class Emulator {
  public:
    // Loads the scene and allocates everything; may take seconds. Throws InputError, DeviceError.
    Emulator(const ScenarioConfig& scenario, const RunLimits& limits);
    ~Emulator();

    // Opens sockets and devices, then runs until a limit is reached or SIGINT, SIGTERM or SIGHUP arrives.
    // on_ready: called once the camera can be used. Throws DeviceError while starting.
    void run(const std::function<void()>& on_ready);

    // Returns the cameras in the scenario's order; there is at least one.
    const std::vector<std::unique_ptr<CameraStation>>& stations() const { return stations_; }
    CameraStation& first() const { return *stations_.front(); }
    FrameLoop& loop() { return first().loop(); }
    Renderer& renderer() { return first().renderer(); }
    SensorChain& chain() { return first().chain(); }
    WorldState& world() { return first().world(); }
    const DeliveryMeter& delivery() const { return first().delivery(); }
    const SimulatedClock& clock() const { return clock_; }
    const PoseWatch& poses() const { return poses_; }
    double seconds() const { return seconds_; }
    // Returns how many cores the program has used on average since the loops began.
    double used_cores() const { return used_cores_; }
    // Returns the run's unique name in truth and report.
    const std::string& run_id() const { return limits_.run_id; }
    CommandReport command_report() const;
    // Null: nothing is recorded.
    const Recorder* recorder() const { return recorder_.get(); }
    // Returns the replays by camera; empty: not a replay.
    const std::vector<std::unique_ptr<Replay>>& replays() const { return replays_; }

  private:
    void prepare_recording();
    void load_stations();
    std::vector<CommandedCamera> commanded_cameras() const;
    void make_replays();
    void make_recorder();
    void make_events();
    void make_lines();
    void make_light_maker();
    void prepare_stations();
    void print_replays() const;
    void print_lines() const;
    void make_telemetry();
    HousekeepingFigures housekeeping();
    void print_missed(std::int64_t now_ns);
    void print_line();
    void print_level_changes();
    void print_held_motion();
    void print_impossible_motion();
    void print_light(std::int64_t now_ns);
    void print_light_left(std::int64_t now_ns);
    void note_time(std::int64_t begun_ns);
    void print_output_faults(std::int64_t now_ns);
    bool finished() const;

    ScenarioConfig scenario_;
    RunLimits limits_;
    // Limits the number of threads to the loop's own cores.
    std::optional<tbb::global_control> threads_;
    SpectralGrid grid_;
    SimulatedClock clock_;
    std::int64_t clock_start_ns_ = 0;  // CLOCK_MONOTONIC
    PoseWatch poses_;
    SilenceLog silence_log_{clock_, poses_};
    std::unique_ptr<TelemetrySender> telemetry_;  // outlives the sinks that stations have of it; may be null
    RecordingHeader recording_;                   // used with a recorder
    std::unique_ptr<Recorder> recorder_;          // outlives everything that records; may be null
    std::vector<std::unique_ptr<Replay>> replays_;  // outlive the loops that follow them
    std::unique_ptr<EventDirector> events_;         // outlives the loop that it watches; may be null
    // Outlives the loops that wake it; null: without outputs, in a replay and in lockstep.
    std::unique_ptr<LineBench> lines_;
    std::vector<std::unique_ptr<CameraStation>> stations_;
    // Gives tables to renderers; null: no table is made during the run.
    std::unique_ptr<LightMaker> light_maker_;
    std::unique_ptr<CommandDispatch> dispatch_;
    std::vector<std::unique_ptr<CommandReceiver>> receivers_;
    double seconds_ = 0, used_cores_ = 0;
    std::int64_t begun_processor_ns_ = 0;
    std::uint64_t frames_printed_ = 0, misses_printed_ = 0;
    std::int64_t processor_printed_ns_ = 0;
    bool reported_held_motion_ = false, reported_impossible_motion_ = false, reported_light_ = false;
    std::int64_t next_fault_look_ns_ = 0;
    std::int64_t next_missed_line_ns_ = 0;
    std::int64_t next_light_line_ns_ = 0;
    std::uint64_t missed_told_ = 0;
    std::atomic<std::int64_t> begun_ns_{0};
    HousekeepingFigures housekeeping_before_;  // used by telemetry's thread
};

}  // namespace hilcam
