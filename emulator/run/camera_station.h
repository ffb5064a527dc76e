#pragma once
// One camera of the bench with everything of its own: settings, faults, copy of the world, renderer, sensor,
// outputs, loop. A bench has one camera, or several that share commands and clock.

#include <deque>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "emulator/loop/delivery_meter.h"
#include "emulator/loop/exposure_renderer.h"
#include "emulator/loop/frame_loop.h"
#include "emulator/loop/light_part_orders.h"
#include "emulator/run/level_costs.h"
#include "emulator/run/status.h"
#include "emulator/scenario/app_config.h"
#include "emulator/scenario/scene_loader.h"
#include "io/contract/command_receiver.h"
#include "io/contract/frame_fates.h"
#include "io/lines/camera_lines.h"

namespace hilcam {

class Recorder;

struct RunLimits {
    double seconds = 0;         // 0: until a signal
    std::uint64_t frames = 0;   // frames of each camera; 0: no limit
    std::uint64_t warm_up = 0;  // first frames, for which times are not kept
    bool paced = true;
    bool outputs = true;  // false: frames are discarded, for benchmarks
    // A file to record to, and a recording to replay; empty: none.
    std::filesystem::path record{}, replay{};
    // True: frames may come before the cached light that they need is ready, if the scenario allows it as
    // well.
    bool light_beside = false;
    bool replay_fast = false;   // true: as fast as possible; false: at the recording's times
    bool replay_force = false;  // true: replays a recording of another program or scenario, too
    std::string run_id{};       // name of the run in its truth; empty: the emulator draws one
};

class LightMaker;

// Parts that the cameras of a bench share, and parts that dictate, watch or record this camera's loop.
// Everything referred to must outlive the station; pointers may be null.
struct StationLinks {
    SimulatedClock& clock;
    const PoseWatch& poses;
    const std::vector<std::unique_ptr<CommandReceiver>>& receivers;
    std::vector<CameraPage> pages{};          // pages of all cameras, by number
    const LightMaker* light_maker = nullptr;  // null: no tables are made during the run
    FrameScript* script = nullptr;            // for a replay
    FrameWatcher* watcher = nullptr;
    Recorder* recorder = nullptr;  // records the loop's frames and changes of settings
};

// A station is built in three steps, because the bench's parts need each other: the constructor makes
// settings and outputs, load() the world, renderer and sensor, prepare() the loop.
class CameraStation {
  public:
    // Makes settings and outputs, so that their errors show before minutes go into loading a scene. scenario:
    // with the camera and outputs of this station. number: from 1. Throws InputError.
    CameraStation(const ScenarioConfig& scenario, std::size_t number, const RunLimits& limits);
    ~CameraStation();

    // Loads the scene and allocates everything that the loop needs; may take seconds. Throws InputError.
    void load(const SpectralGrid& grid);
    // Makes the loop. Call after load(), when all outputs exist. Throws InputError.
    void prepare(const StationLinks& links);

    // Opens the outputs. Throws DeviceError.
    void start_outputs();
    void start_loop() { loop_->start(); }
    void stop_loop() noexcept { loop_->stop(); }
    void stop_outputs() noexcept;

    // Called periodically while the loop runs: applies the scenario's timed faults and keeps their log.
    void serve_faults(double seconds_since_start);

    const ScenarioConfig& scenario() const { return scenario_; }
    const std::string& name() const { return scenario_.camera.name; }
    std::size_t number() const { return number_; }
    FrameLoop& loop() { return *loop_; }
    const FrameLoop& loop() const { return *loop_; }
    Renderer& renderer() { return *renderer_; }
    const Renderer& renderer() const { return *renderer_; }
    // Returns what was found when the objects were loaded, in the scenario's order.
    const std::vector<LoadedObject>& objects() const { return objects_; }
    // Returns how the station got its transfer tables, and which are still to be made.
    LightLoading& light() { return light_; }
    SensorChain& chain() { return *chain_; }
    WorldState& world() { return *world_; }
    LiveSettings& settings() { return settings_; }
    const LiveSettings& settings() const { return settings_; }
    FaultBoard& faults() { return faults_; }
    const FaultBoard& faults() const { return faults_; }
    // Returns the newest strikes of faults; the first of each frame and kind.
    const std::deque<FaultBoard::Entry>& fault_log() const { return fault_log_; }
    const DeliveryMeter& delivery() const { return delivery_; }
    // Returns an OutputMeter for each output, in their order; read them when the outputs are stopped.
    const std::deque<OutputMeter>& output_meters() const { return output_meters_; }
    // Returns what frames of each quality level cost before the run; empty without a governor.
    const std::vector<LevelCost>& level_costs() const { return level_costs_; }
    // Returns the time between exposures by the present settings [s of the machine].
    double period_s() const;
    std::vector<FrameSink*> sinks() const;
    // Returns why outputs cannot deliver, once for each output. Allocates nothing while there is nothing to
    // report. Owner thread.
    std::vector<std::string> new_faults();
    // Returns what happened at the outputs since the last call.
    std::vector<SinkNote> new_notes();
    // Adds an output that other stations also feed (telemetry). Before prepare().
    void add_sink(std::unique_ptr<FrameSink> sink) { sinks_.push_back(std::move(sink)); }
    // Returns what one more output works with, an OutputMeter of its own included.
    SinkContext sink_context();
    CameraLines& lines() { return lines_; }

  private:
    void make_sinks();
    void connect_lines();
    void find_level_costs();
    void serve_light_parts();
    GovernorSettings governor() const;
    void tell_of_changes(Recorder* recorder);
    std::string status() const;

    static constexpr std::size_t kMaxLogged = 100'000;

    ScenarioConfig scenario_;
    std::size_t number_;
    RunLimits limits_;
    LiveSettings settings_;
    CameraLines lines_;
    LineWatch line_watch_{lines_};
    FaultBoard faults_;
    DeliveryMeter delivery_;
    std::deque<OutputMeter> output_meters_;
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
    std::optional<StationLinks> links_;  // set by prepare()
    std::unique_ptr<FrameLoop> loop_;
    std::vector<FaultConfig> timed_faults_;  // in order of time
    std::size_t next_fault_ = 0;
    std::deque<FaultBoard::Entry> fault_log_;
};

}  // namespace hilcam
