#pragma once
// The emulator as a whole: builds every part of a scenario, runs it, tears it down.

#include <csignal>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <memory>

#include "emulator/app_config.h"
#include "emulator/command_dispatch.h"
#include "emulator/command_receivers.h"
#include "emulator/exposure_renderer.h"
#include "emulator/frame_loop.h"

namespace hilcam {

struct RunLimits {
    double seconds = 0;        // 0: until a signal
    std::uint64_t frames = 0;  // 0: no limit
    bool paced = true;
    bool outputs = true;  // false: frames go nowhere, for benchmarks
};

class Emulator {
  public:
    // Loads the scene and allocates everything; may take seconds. Throws InputError, DeviceError.
    Emulator(const ScenarioConfig& scenario, const RunLimits& limits);
    ~Emulator();

    // Opens sockets and devices, then runs until a limit is reached or SIGINT or SIGTERM comes. Throws
    // DeviceError while starting. `on_ready` is called once the camera can be used.
    void run(const std::function<void()>& on_ready);

    FrameLoop& loop() { return *loop_; }
    Renderer& renderer() { return *renderer_; }
    SensorChain& chain() { return *chain_; }
    WorldState& world() { return *world_; }
    const SimulatedClock& clock() const { return clock_; }
    double seconds() const { return seconds_; }
    CommandReport command_report() const;
    const DeliveryMeter& delivery() const { return delivery_; }
    FaultBoard& faults() { return faults_; }
    // The newest strikes, the first of each frame and kind.
    const std::deque<FaultBoard::Entry>& fault_log() const { return fault_log_; }
    std::vector<FrameSink*> sinks() const;

  private:
    void make_sinks();
    void make_telemetry();
    HousekeepingFigures housekeeping();
    void print_line(std::uint64_t& frames_before);
    void order_faults(double seconds);
    void log_faults();

    ScenarioConfig scenario_;
    RunLimits limits_;
    SpectralGrid grid_;
    SimulatedClock clock_;
    FaultBoard faults_;
    DeliveryMeter delivery_;
    std::unique_ptr<Renderer> renderer_;
    std::unique_ptr<SensorChain> chain_;
    std::unique_ptr<WorldState> world_;
    std::unique_ptr<LiveSettings> settings_;
    std::unique_ptr<CommandDispatch> dispatch_;
    std::vector<std::unique_ptr<CommandReceiver>> receivers_;
    TelemetrySink* telemetry_ = nullptr;  // one of sinks_, if there is any telemetry
    std::vector<std::unique_ptr<FrameSink>> sinks_;
    std::unique_ptr<ExposureRenderer> exposures_;
    std::unique_ptr<FrameLoop> loop_;
    double seconds_ = 0;
    std::vector<FaultConfig> timed_faults_;  // by time
    std::size_t next_fault_ = 0;
    static constexpr std::size_t kMostLogged = 100'000;
    std::deque<FaultBoard::Entry> fault_log_;
    std::atomic<std::int64_t> begun_ns_{0};
    HousekeepingFigures housekeeping_before_;  // telemetry's thread
};

// The motions of camera and objects as the scenario begins them.
std::vector<Motion> initial_motions(const ScenarioConfig& scenario, TimeTai time);
// All objects' turning parts, object by object.
std::vector<Joint> joints_of(const ScenarioConfig& scenario);
// What the scenario says of an instant, if no command comes.
WorldSnapshot snapshot_at(const ScenarioConfig& scenario, TimeTai start, TimeTai time);

}  // namespace hilcam
