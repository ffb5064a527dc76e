#include "emulator/emulator.h"

#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>

#include "emulator/scene_loader.h"

namespace hilcam {
namespace {

volatile std::sig_atomic_t signalled = 0;
void on_signal(int) { signalled = 1; }

// Stops on SIGINT and SIGTERM while it lives.
class SignalGuard {
  public:
    SignalGuard() {
        signalled = 0;
        struct sigaction action {};
        action.sa_handler = on_signal;
        sigaction(SIGINT, &action, &old_int_);
        sigaction(SIGTERM, &action, &old_term_);
    }
    ~SignalGuard() {
        sigaction(SIGINT, &old_int_, nullptr);
        sigaction(SIGTERM, &old_term_, nullptr);
    }

  private:
    struct sigaction old_int_ {
    }, old_term_{};
};

}  // namespace

std::vector<Motion> initial_motions(const ScenarioConfig& scenario, TimeTai time) {
    const Bodies bodies = bodies_at(time, scenario.origin);
    std::vector<Motion> motions = {initial_motion(scenario.camera_pose, time, bodies)};
    for (const ObjectConfig& object : scenario.objects)
        motions.push_back(initial_motion(object.pose, time, bodies));
    return motions;
}

std::vector<Joint> joints_of(const ScenarioConfig& scenario) {
    std::vector<Joint> joints;
    for (std::size_t i = 0; i < scenario.objects.size(); ++i)
        for (const JointConfig& joint : scenario.objects[i].joints)
            joints.push_back({i, joint.pivot_m, normalized(joint.axis), joint.angle_rad, joint.rate_rad_s});
    return joints;
}

WorldSnapshot snapshot_at(const ScenarioConfig& scenario, TimeTai start, TimeTai time) {
    WorldState state(initial_motions(scenario, start), scenario.origin, joints_of(scenario));
    WorldSnapshot world;
    world.objects.resize(state.placed_objects());
    ShownCommand shown;
    state.sample(time, world, shown);
    return world;
}

Emulator::Emulator(const ScenarioConfig& scenario, const RunLimits& limits)
    : scenario_(scenario),
      limits_(limits),
      grid_(scenario.spectrum_edges_um),
      clock_(parse_utc(scenario.time_utc), monotonic_now_ns()),
      faults_(static_cast<std::uint64_t>(scenario.seed)) {
    // What can be wrong with outputs is said before minutes go into a scene.
    settings_ = std::make_unique<LiveSettings>(
        scenario.camera, LiveSettings::Mode{.lockstep = scenario.mode == CameraMode::kLockstep,
                                            .triggered = scenario.mode == CameraMode::kTriggered,
                                            .fixed_size = scenario.outputs.has_v4l2});
    settings_->on_missed_trigger([this](std::int64_t monotonic_ns) {
        for (const auto& sink : sinks_) sink->happened({CameraEvent::Kind::kTriggerMissed, 0, monotonic_ns});
    });
    if (limits.outputs) make_sinks();
    const ImageGeometry geometry = geometry_of(scenario.camera, static_cast<int>(scenario.quality.guard_px),
                                               static_cast<int>(scenario.quality.oversampling));
    renderer_ = load_renderer(scenario, grid_, geometry);
    chain_ = std::make_unique<SensorChain>(scenario.camera, grid_, sampling_of(scenario.quality),
                                           load_detector_pictures(scenario.camera));
    // Loading took its time; the simulation starts now.
    const TimeTai start = parse_utc(scenario.time_utc);
    clock_ = SimulatedClock(start, monotonic_now_ns(), scenario.mode == CameraMode::kLockstep);
    world_ =
        std::make_unique<WorldState>(initial_motions(scenario, start), scenario.origin, joints_of(scenario));
    renderer_->require_air(snapshot_at(scenario, start, start));
    dispatch_ = std::make_unique<CommandDispatch>(*world_, *settings_, faults_, clock_);
    if (limits.outputs) receivers_ = make_receivers(scenario.commands, *dispatch_, faults_);
    if (limits.outputs) make_telemetry();
    exposures_ = std::make_unique<ExposureRenderer>(*renderer_, scenario, grid_, world_->placed_objects());
    timed_faults_ = scenario.faults;
    std::stable_sort(timed_faults_.begin(), timed_faults_.end(),
                     [](const FaultConfig& a, const FaultConfig& b) { return a.at_s < b.at_s; });
    order_faults(0);
    loop_ = std::make_unique<FrameLoop>(*exposures_, *chain_, scenario.camera, *world_, *settings_, faults_,
                                        clock_, sinks(), static_cast<std::uint64_t>(scenario.seed),
                                        LoopLimits{limits.frames, limits.paced});
}

Emulator::~Emulator() = default;

void Emulator::make_sinks() {
    const OutputsConfig& o = scenario_.outputs;
    const auto [width, height] = array_size(scenario_.camera);  // frames are no larger
    const SinkContext context{*settings_, faults_, &delivery_};
    if (o.has_gige) {
        GigeConfig gige = o.gige;
        if (gige.model == "hilcam" && !scenario_.camera.name.empty()) gige.model = scenario_.camera.name;
        sinks_.push_back(std::make_unique<GigeSink>(gige, context));
    }
    if (o.has_v4l2)
        sinks_.push_back(
            std::make_unique<V4l2Sink>(o.v4l2, width, height, settings_->settings().frame_rate_hz, context));
    if (o.has_files)
        sinks_.push_back(
            std::make_unique<FilesSink>(o.files, width, height, scenario_.camera.pixel_layout()));
}

void Emulator::make_telemetry() {
    if (!scenario_.has_telemetry && receivers_.empty()) return;
    TelemetryConfig config = scenario_.telemetry;
    if (!scenario_.has_telemetry) config.port.port = 0;
    auto sink = std::make_unique<TelemetrySink>(config, [this] { return housekeeping(); });
    std::vector<CommandReceiver*> receivers;
    for (const auto& receiver : receivers_) receivers.push_back(receiver.get());
    sink->serve(std::move(receivers));
    telemetry_ = sink.get();
    sinks_.push_back(std::move(sink));
}

// Called by telemetry's thread, once a second.
HousekeepingFigures Emulator::housekeeping() {
    HousekeepingFigures h;
    const CameraSettings settings = settings_->settings();
    h.mode = settings_->limits().lockstep ? OperatingMode::kLockstep
             : settings.triggered         ? OperatingMode::kTriggered
                                          : OperatingMode::kFreeRun;
    h.running = settings.running;
    h.simulated_time = clock_.now();
    h.monotonic_ns = monotonic_now_ns();
    h.uptime_s = static_cast<double>(h.monotonic_ns - begun_ns_) * 1e-9;
    h.frames = loop_->counters().frames.load();
    h.frame_rate_hz = static_cast<double>(h.frames - housekeeping_before_.frames) /
                      std::max(h.uptime_s - housekeeping_before_.uptime_s, 1e-3);
    h.deadline_misses = loop_->counters().deadline_misses.load();
    const CommandReport commands = command_report();
    h.commands_received = commands.received;
    h.commands_refused = commands.refused;
    h.commands_lost = commands.lost;
    h.latency_p50_s = delivery_.command_to_last.quantile_ms(0.5) * 1e-3;
    h.latency_p99_s = delivery_.command_to_last.quantile_ms(0.99) * 1e-3;
    h.temperature_c = settings_->limits().temperature_c;
    for (const FaultKind kind : kAllFaults) h.active_faults += faults_.order_of(kind) ? 1u : 0u;
    h.clients = static_cast<std::uint32_t>(commands.clients + telemetry_->port_report().clients);
    housekeeping_before_ = h;
    return h;
}

std::vector<FrameSink*> Emulator::sinks() const {
    std::vector<FrameSink*> out;
    for (const auto& sink : sinks_) out.push_back(sink.get());
    return out;
}

CommandReport Emulator::command_report() const { return report_of(receivers_); }

void Emulator::run(const std::function<void()>& on_ready) {
    const SignalGuard guard;
    for (const auto& sink : sinks_) sink->start();
    for (const auto& receiver : receivers_) receiver->start();
    const std::int64_t begun_ns = monotonic_now_ns();
    begun_ns_ = begun_ns;
    loop_->start();
    on_ready();
    const bool terminal = isatty(STDERR_FILENO);
    std::uint64_t frames_before = 0;
    std::int64_t next_line_ns = begun_ns + 1'000'000'000;
    while (!signalled && !loop_->finished()) {
        const std::int64_t now_ns = monotonic_now_ns();
        seconds_ = static_cast<double>(now_ns - begun_ns) * 1e-9;
        if (limits_.seconds > 0 && seconds_ >= limits_.seconds) break;
        order_faults(seconds_);
        log_faults();
        if (terminal && limits_.outputs && now_ns >= next_line_ns) {
            print_line(frames_before);
            next_line_ns += 1'000'000'000;
        }
        sleep_until_monotonic_ns(now_ns + 10'000'000);
    }
    loop_->stop();
    log_faults();
    seconds_ = static_cast<double>(monotonic_now_ns() - begun_ns) * 1e-9;
    for (const auto& receiver : receivers_) receiver->stop();
    for (const auto& sink : sinks_) sink->stop();
}

// What the scenario's own time has come for.
void Emulator::order_faults(double seconds) {
    for (; next_fault_ < timed_faults_.size() && timed_faults_[next_fault_].at_s <= seconds; ++next_fault_)
        faults_.order(order_of(timed_faults_[next_fault_]));
}

void Emulator::log_faults() {
    FaultBoard::Entry entry;
    while (faults_.take_entry(entry)) {
        fault_log_.push_back(entry);
        if (fault_log_.size() > kMostLogged) fault_log_.pop_front();
        if (isatty(STDERR_FILENO)) continue;  // the line of the second says how many
        spdlog::debug("fault {} strikes frame {}, item {}", name_of(entry.kind), entry.frame, entry.index);
    }
}

void Emulator::print_line(std::uint64_t& frames_before) {
    const std::uint64_t frames = loop_->counters().frames.load();
    const CommandReport commands = command_report();
    spdlog::info(
        "{} frames/s, command to last packet p50 {:.1f} ms p99 {:.1f} ms, {} exposures missed, {} commands "
        "({} refused)",
        frames - frames_before, delivery_.command_to_last.quantile_ms(0.5),
        delivery_.command_to_last.quantile_ms(0.99), loop_->counters().deadline_misses.load(),
        commands.received, commands.refused);
    frames_before = frames;
}

}  // namespace hilcam
