#pragma once
// One camera of the bench with all that is its own: settings, faults, picture of the world, renderer, sensor,
// outputs, loop. A bench has one, or several that share commands and clock.

#include <deque>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "emulator/loop/exposure_renderer.h"
#include "emulator/loop/frame_loop.h"
#include "emulator/loop/light_part_orders.h"
#include "emulator/run/level_costs.h"
#include "emulator/run/status.h"
#include "emulator/scenario/app_config.h"
#include "emulator/scenario/scene_loader.h"
#include "io/contract/command_receiver.h"
#include "io/contract/frame_fates.h"

namespace hilcam {

class Recorder;

struct RunLimits {
    double seconds = 0;         // 0: until a signal
    std::uint64_t frames = 0;   // frames of each camera; 0: no limit
    std::uint64_t warm_up = 0;  // first frames, whose times are not kept
    bool paced = true;
    bool outputs = true;  // false: frames go nowhere, for benchmarks
    // A file to record to, or one whose frames to show once more; empty: none.
    std::filesystem::path record{}, replay{};
    // Frames may come before the light between surfaces that they ask for is kept, where the scenario says
    // so, too.
    bool light_beside = false;
    bool replay_fast = false;   // true: as fast as can be; false: by the recording's times
    bool replay_force = false;  // true: also a recording of another program or scenario
    std::string run_id{};       // label of its frames' truth; empty: the emulator draws it
};

class LightMaker;

// The parts that the cameras of a bench share, and those that dictate, watch and keep what this one's loop does.
// All that is referred to outlives the station; pointers may be null.
struct StationLinks {
    SimulatedClock& clock;
    const PoseWatch& poses;
    const std::vector<std::unique_ptr<CommandReceiver>>& receivers;
    std::vector<CameraPage> pages{};          // the pages of all cameras, by number
    const LightMaker* light_maker = nullptr;  // null: nothing is made beside the run
    FrameScript* script = nullptr;            // a replay's
    FrameWatcher* watcher = nullptr;
    Recorder* recorder = nullptr;  // gets what the loop and the settings do
};

// It is built in three steps, as the bench's parts need each other: constructed (settings and outputs are
// there), loaded (world, renderer and sensor, too), prepared (and the loop).
class CameraStation {
  public:
    // Makes settings and outputs, so that what can be wrong with them is said before minutes go into a scene.
    // `scenario`: camera and outputs are this camera's; number: from 1. Throws InputError.
    CameraStation(const ScenarioConfig& scenario, std::size_t number, const RunLimits& limits);
    ~CameraStation();

    // Loads the scene and allocates all the loop needs; may take seconds. Throws InputError.
    void load(const SpectralGrid& grid);
    // Makes the loop, after load() and when all outputs are there. Throws InputError.
    void prepare(const StationLinks& links);

    // Opens the outputs. Throws DeviceError.
    void start_outputs();
    void start_loop() { loop_->start(); }
    void stop_loop() noexcept { loop_->stop(); }
    void stop_outputs() noexcept;

    // Is called now and then while the loop runs: orders the scenario's own faults, keeps the log.
    void serve_faults(double seconds_since_start);

    const ScenarioConfig& scenario() const { return scenario_; }
    const std::string& name() const { return scenario_.camera.name; }
    std::size_t number() const { return number_; }
    FrameLoop& loop() { return *loop_; }
    const FrameLoop& loop() const { return *loop_; }
    Renderer& renderer() { return *renderer_; }
    const Renderer& renderer() const { return *renderer_; }
    // Returns what was found when they were loaded, in the scenario's order.
    const std::vector<LoadedObject>& objects() const { return objects_; }
    // Says how it got its transfer tables; orders: those that it is still without.
    LightLoading& light() { return light_; }
    SensorChain& chain() { return *chain_; }
    WorldState& world() { return *world_; }
    LiveSettings& settings() { return settings_; }
    const LiveSettings& settings() const { return settings_; }
    FaultBoard& faults() { return faults_; }
    const FaultBoard& faults() const { return faults_; }
    // The newest strikes, the first of each frame and kind.
    const std::deque<FaultBoard::Entry>& fault_log() const { return fault_log_; }
    const DeliveryMeter& delivery() const { return delivery_; }
    // Returns what frames of each quality level cost before the run; none where no governor chooses one.
    const std::vector<LevelCost>& level_costs() const { return level_costs_; }
    // Returns how long after an exposure the next one is due, by the settings of now [s of the machine].
    double period_s() const;
    std::vector<FrameSink*> sinks() const;
    // Why outputs cannot deliver, of each of them once. Allocates nothing while there is nothing to tell.
    // Owner thread.
    std::vector<std::string> new_faults();
    // An output that others feed too (telemetry); before prepare().
    void add_sink(std::unique_ptr<FrameSink> sink) { sinks_.push_back(std::move(sink)); }
    SinkContext sink_context() { return {settings_, faults_, &delivery_, &fates_, &light_parts_}; }

  private:
    void make_sinks();
    void find_level_costs();
    void serve_light_parts();
    GovernorSettings governor() const;
    void record_changes(Recorder& recorder);
    std::string status() const;

    static constexpr std::size_t kMaxLogged = 100'000;

    ScenarioConfig scenario_;
    std::size_t number_;
    RunLimits limits_;
    LiveSettings settings_;
    FaultBoard faults_;
    DeliveryMeter delivery_;
    FrameFates fates_;
    LightPartOrders light_parts_;
    std::vector<std::unique_ptr<FrameSink>> sinks_;
    std::set<const FrameSink*> reported_faults_;
    bool reported_render_fault_ = false;
    std::vector<LoadedObject> objects_;
    LightLoading light_;
    std::unique_ptr<Renderer> renderer_;
    std::unique_ptr<SensorChain> chain_;
    std::unique_ptr<WorldState> world_;
    std::unique_ptr<ExposureRenderer> exposures_;
    std::vector<LevelCost> level_costs_;
    TruthListener* truth_listener_ = nullptr;  // one of the sinks, as is the next; may be null
    TruthSink* truth_ = nullptr;
    std::optional<StationLinks> links_;  // once it is prepared
    std::unique_ptr<FrameLoop> loop_;
    std::vector<FaultConfig> timed_faults_;  // by time
    std::size_t next_fault_ = 0;
    std::deque<FaultBoard::Entry> fault_log_;
};

}  // namespace hilcam
