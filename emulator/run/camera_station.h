#pragma once
// One camera of the bench with all that is its own: settings, faults, picture of the world, renderer, sensor,
// outputs, loop. A bench has one, or several that share commands and clock.

#include <deque>
#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "emulator/loop/exposure_renderer.h"
#include "emulator/loop/frame_loop.h"
#include "emulator/run/status.h"
#include "emulator/scenario/app_config.h"
#include "emulator/scenario/scene_loader.h"
#include "io/contract/command_receiver.h"

namespace hilcam {

class Recorder;

struct RunLimits {
    double seconds = 0;         // 0: until a signal
    std::uint64_t frames = 0;   // of each camera; 0: no limit
    std::uint64_t warm_up = 0;  // of them, the first: their times are not kept
    bool paced = true;
    bool outputs = true;  // false: frames go nowhere, for benchmarks
    // A file to record to, or one whose frames to show once more; empty: none.
    std::filesystem::path record{}, replay{};
    // Frames may come before the light between surfaces that they ask for is kept, where the scenario says
    // so, too.
    bool light_beside = false;
    bool replay_fast = false;   // not by the recording's times
    bool replay_force = false;  // of another program or scenario
    std::string run_id{};       // what the truth of its frames is labelled with; empty: the emulator draws it
};

class LightMaker;

class CameraStation {
  public:
    // Makes settings and outputs, so that what can be wrong with them is said before minutes go into a scene.
    // `scenario`: camera and outputs are this camera's; number: from 1. Throws InputError.
    CameraStation(const ScenarioConfig& scenario, std::size_t number, const RunLimits& limits);
    ~CameraStation();

    // Loads the scene and allocates all the loop needs; may take seconds. Throws InputError.
    void load(const SpectralGrid& grid);
    // After all stations have loaded: the simulation's time begins. Both outlive the station. Throws
    // InputError.
    void prepare(SimulatedClock& clock, const PoseWatch& poses);
    // What the preview tells of the bench's commands.
    void set_receivers(const std::vector<std::unique_ptr<CommandReceiver>>& all) { receivers_ = &all; }
    void set_cameras(const std::vector<CameraPage>& all) { cameras_ = all; }
    void set_light_maker(const LightMaker& maker) { light_maker_ = &maker; }

    // What the loop and the settings do goes into a recording. After prepare().
    void record_to(Recorder& recorder);

    // Opens the outputs. Throws DeviceError.
    void start_outputs();
    void start_loop() { loop_->start(); }
    void stop_loop() noexcept { loop_->stop(); }
    void stop_outputs() noexcept;

    // To be called now and then while the loop runs: orders the scenario's own faults, keeps the log.
    void serve_faults(double seconds_since_start);

    const ScenarioConfig& scenario() const { return scenario_; }
    const std::string& name() const { return scenario_.camera.name; }
    std::size_t number() const { return number_; }
    FrameLoop& loop() { return *loop_; }
    const FrameLoop& loop() const { return *loop_; }
    Renderer& renderer() { return *renderer_; }
    // What was found when they were loaded, in the scenario's order.
    const std::vector<LoadedObject>& objects() const { return objects_; }
    // How it got its tables of directions; orders: those that it is still without.
    LightLoading& light() { return light_; }
    SensorChain& chain() { return *chain_; }
    WorldState& world() { return *world_; }
    LiveSettings& settings() { return settings_; }
    FaultBoard& faults() { return faults_; }
    const FaultBoard& faults() const { return faults_; }
    // The newest strikes, the first of each frame and kind.
    const std::deque<FaultBoard::Entry>& fault_log() const { return fault_log_; }
    const DeliveryMeter& delivery() const { return delivery_; }
    std::vector<FrameSink*> sinks() const;
    // Why outputs cannot deliver, of each of them once. Allocates nothing while there is nothing to tell.
    // Owner thread.
    std::vector<std::string> new_faults();
    // An output that others feed too (telemetry); before start_outputs().
    void add_sink(std::unique_ptr<FrameSink> sink) { sinks_.push_back(std::move(sink)); }
    SinkContext sink_context() { return {settings_, faults_, &delivery_}; }

  private:
    void make_sinks();
    std::string status() const;

    static constexpr std::size_t kMaxLogged = 100'000;

    ScenarioConfig scenario_;
    std::size_t number_;
    RunLimits limits_;
    LiveSettings settings_;
    FaultBoard faults_;
    DeliveryMeter delivery_;
    const std::vector<std::unique_ptr<CommandReceiver>>* receivers_ = nullptr;  // the bench's
    std::vector<CameraPage> cameras_;
    std::vector<std::unique_ptr<FrameSink>> sinks_;
    std::set<const FrameSink*> told_faults_;
    std::vector<LoadedObject> objects_;
    LightLoading light_;
    const LightMaker* light_maker_ = nullptr;  // the bench's; null: nothing is made beside the run
    std::unique_ptr<Renderer> renderer_;
    std::unique_ptr<SensorChain> chain_;
    std::unique_ptr<WorldState> world_;
    std::unique_ptr<ExposureRenderer> exposures_;
    PreviewSink* preview_ = nullptr;  // of the sinks, as is the next; may be null
    TruthSink* truth_ = nullptr;
    std::unique_ptr<FrameLoop> loop_;
    std::vector<FaultConfig> timed_faults_;  // by time
    std::size_t next_fault_ = 0;
    std::deque<FaultBoard::Entry> fault_log_;
};

}  // namespace hilcam
