#include "emulator/run/emulator.h"

#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <csignal>

#include "emulator/progress/progress_line.h"
#include "emulator/recording/recording_header.h"
#include "emulator/recording/run_seed.h"
#include "emulator/run/run_pace.h"
#include "io/system/service_manager.h"

namespace hilcam {
namespace {

constexpr std::int64_t kBetweenMissedLines_ns = 10'000'000'000;

volatile std::sig_atomic_t signalled = 0;
std::atomic<std::int64_t> signalled_ns{0};
static_assert(std::atomic<std::int64_t>::is_always_lock_free);  // used in a signal handler

// The first signal stops the run. A terminal and a program that wraps this one may each send a signal at the
// same time; these count as one. A later signal means that someone does not want to wait for the end of
// outputs and report.
void on_signal(int number) {
    constexpr std::int64_t kAtOnce_ns = 1'000'000'000;
    if (!signalled) {
        signalled_ns.store(monotonic_ns());
        signalled = 1;
    } else if (monotonic_ns() - signalled_ns.load() > kAtOnce_ns) {
        std::signal(number, SIG_DFL);
        std::raise(number);
    }
}

// While it exists, stops the run on every signal by which a person, a shell or a job scheduler ends a program
// (SIGUSR1 and SIGUSR2 announce the end of a batch job's time), and on SIGHUP (the terminal closes) unless
// that is ignored, as with nohup. After a signal the program is about to end, and the guard continues to
// listen.
class SignalGuard {
  public:
    SignalGuard() {
        signalled = 0;
        struct sigaction action {};
        action.sa_handler = on_signal;
        for (std::size_t i = 0; i < kSignals.size(); ++i) sigaction(kSignals[i], &action, &before_[i]);
        if (before_[kHangUp].sa_handler == SIG_IGN) sigaction(SIGHUP, &before_[kHangUp], nullptr);
    }
    ~SignalGuard() {
        if (signalled) return;
        for (std::size_t i = 0; i < kSignals.size(); ++i) sigaction(kSignals[i], &before_[i], nullptr);
    }

  private:
    static constexpr std::array kSignals = {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGUSR1, SIGUSR2, SIGALRM};
    static constexpr std::size_t kHangUp = 2;
    std::array<struct sigaction, kSignals.size()> before_{};
};

}  // namespace

Emulator::Emulator(const ScenarioConfig& scenario, const RunLimits& limits)
    : scenario_(scenario),
      limits_(limits),
      grid_(scenario.spectrum_edges_um),
      clock_(parse_utc(scenario.time_utc), monotonic_ns(), scenario.mode == CameraMode::kLockstep,
             scenario.clock),
      poses_(scenario.commands.poses, scenario.mode == CameraMode::kLockstep) {
    if (limits_.run_id.empty()) limits_.run_id = drawn_run_id();
    prepare_recording();
    const RealTime& wishes = scenario.loop.real_time;
    require_rights(wishes);
    if (!wishes.cores.empty())
        threads_.emplace(tbb::global_control::max_allowed_parallelism, wishes.cores.size());
    load_stations();
    // Loading took some time; the simulation starts now.
    clock_start_ns_ = monotonic_ns();
    clock_.restart(parse_utc(scenario.time_utc), clock_start_ns_);
    dispatch_ = std::make_unique<CommandDispatch>(commanded_cameras(), clock_, &poses_);
    if (limits.outputs && limits.replay.empty()) {
        receivers_ = make_receivers(scenario.commands, *dispatch_, first().faults());
        if (scenario.commands.has_vizard) receivers_.push_back(make_vizard(scenario, stations_, *dispatch_));
        if (scenario.commands.has_ip42) receivers_.push_back(make_ip42(scenario, stations_, *dispatch_));
    }
    if (limits.outputs) make_telemetry();
    make_replays();
    make_recorder();
    make_events();
    make_lines();
    make_light_maker();
    prepare_stations();
}

// Called before minutes go into loading a scene.
void Emulator::prepare_recording() {
    if (!limits_.record.empty() || !limits_.replay.empty()) recording_ = recording_header(scenario_);
    if (limits_.replay.empty()) return;
    const RecordingReader recording(limits_.replay);
    for (const std::string& warning :
         check_recording(recording.header(), limits_.replay.string(), recording_, limits_.replay_force))
        spdlog::warn("{}", warning);
}

// Errors of any camera are reported before the first scene is loaded.
void Emulator::load_stations() {
    for (std::size_t i = 0; i <= scenario_.more_cameras.size(); ++i)
        stations_.push_back(
            std::make_unique<CameraStation>(scenario_of_camera(scenario_, i), i + 1, limits_));
    for (const auto& station : stations_) station->load(grid_);
}

std::vector<CommandedCamera> Emulator::commanded_cameras() const {
    std::vector<CommandedCamera> cameras;
    for (const auto& station : stations_)
        cameras.push_back({&station->world(), &station->settings(), &station->faults(), &station->lines()});
    return cameras;
}

void Emulator::make_replays() {
    if (limits_.replay.empty()) return;
    for (const auto& station : stations_) {
        const ScenarioConfig& own = station->scenario();
        const ReplayedCamera camera{static_cast<std::uint16_t>(station->number()),
                                    &station->world(),
                                    &station->faults(),
                                    station->settings().limits(),
                                    station->settings().settings(),
                                    1 + lower_levels(own).size()};
        replays_.push_back(std::make_unique<Replay>(limits_.replay, camera, limits_.replay_fast));
    }
}

void Emulator::make_recorder() {
    if (limits_.record.empty()) return;
    for (const std::string& warning : recording_warnings(scenario_)) spdlog::warn("{}", warning);
    recording_.monotonic_start_ns = clock_start_ns_;
    recorder_ = std::make_unique<Recorder>(limits_.record, recording_);
    dispatch_->record_to(*recorder_);
}

// In a replay, the recording contains what events did.
void Emulator::make_events() {
    if (scenario_.events.empty() || !limits_.replay.empty()) return;
    const EventDirector::Bench bench{*dispatch_,
                                     first().settings(),
                                     clock_,
                                     ShutterTiming(first().scenario().camera),
                                     world().placed_objects(),
                                     receivers_.empty()};
    events_ = std::make_unique<EventDirector>(
        EventSequence(scenario_.events, event_world(scenario_), clock_.start()), bench);
    if (clock_.lockstep()) dispatch_->ask_events(*events_);
}

// Lines work in real time. Without a scenario's lines, GigE Vision has counters, timers and Line0; without
// either, nothing would follow or make an edge.
void Emulator::make_lines() {
    if (!limits_.outputs || !limits_.replay.empty() || clock_.lockstep()) return;
    const bool has_gige = std::any_of(stations_.begin(), stations_.end(), [](const auto& station) {
        return station->scenario().outputs.template find<GigeConfig>() != nullptr;
    });
    if (!scenario_.lines.any() && !has_gige) return;
    std::vector<CameraLines*> cameras;
    for (const auto& station : stations_) cameras.push_back(&station->lines());
    lines_ = std::make_unique<LineBench>(scenario_.lines, std::move(cameras));
}

void Emulator::make_light_maker() {
    std::vector<LightMaker::Job> jobs;
    for (const auto& station : stations_)
        if (LightLoading& light = station->light(); !light.orders.empty())
            jobs.push_back({&station->renderer(), std::move(light.orders)});
    if (jobs.empty()) return;
    light_maker_ = std::make_unique<LightMaker>(std::move(jobs));
}

void Emulator::prepare_stations() {
    std::vector<CameraPage> pages;
    for (const auto& station : stations_) {
        const auto* preview = station->scenario().outputs.find<PreviewConfig>();
        pages.push_back({station->name(), preview ? preview->port : 0});
    }
    for (std::size_t i = 0; i < stations_.size(); ++i)
        stations_[i]->prepare({
            .clock = clock_,
            .poses = poses_,
            .receivers = receivers_,
            .pages = pages,
            .light_maker = light_maker_.get(),
            .script = replays_.empty() ? nullptr : replays_[i].get(),
            .watcher = i == 0 ? events_.get() : nullptr,
            .recorder = recorder_.get(),
        });
}

// Also called when starting failed half-way. Outputs' threads use figures of members that are destroyed
// before them.
Emulator::~Emulator() {
    if (telemetry_) telemetry_->stop();
    if (lines_) lines_->stop();
    for (const auto& station : stations_) station->stop_outputs();
    if (events_) events_->stop();
    for (const auto& replay : replays_) replay->stop();
}

void Emulator::make_telemetry() {
    if (!scenario_.telemetry && receivers_.empty()) return;
    TelemetryConfig config = scenario_.telemetry.value_or(TelemetryConfig{});
    if (!scenario_.telemetry) config.port.port = 0;
    telemetry_ = std::make_unique<TelemetrySender>(config, [this] { return housekeeping(); });
    std::vector<CommandReceiver*> receivers;
    for (const auto& receiver : receivers_) receivers.push_back(receiver.get());
    telemetry_->serve(std::move(receivers));
    for (const auto& station : stations_)
        station->add_sink(telemetry_->sink(static_cast<std::uint8_t>(station->number())));
}

// Called by telemetry's thread once a second. Figures that cannot be added up are the first camera's.
HousekeepingFigures Emulator::housekeeping() {
    HousekeepingFigures h;
    const CameraSettings settings = first().settings().settings();
    h.mode = first().settings().limits().lockstep ? OperatingMode::kLockstep
             : settings.triggered                 ? OperatingMode::kTriggered
                                                  : OperatingMode::kFreeRun;
    h.running = settings.running;
    h.simulated_time = clock_.now();
    h.monotonic_ns = monotonic_ns();
    h.uptime_s = static_cast<double>(h.monotonic_ns - begun_ns_) * 1e-9;
    for (const auto& station : stations_) {
        h.frames += station->loop().counters().frames.load();
        h.deadline_misses += station->loop().counters().deadline_misses.load();
    }
    h.frame_rate_hz = static_cast<double>(h.frames - housekeeping_before_.frames) /
                      std::max(h.uptime_s - housekeeping_before_.uptime_s, 1e-3);
    const CommandReport commands = command_report();
    h.commands_received = commands.received;
    h.commands_refused = commands.refused;
    h.commands_lost = commands.lost;
    h.latency_p50_s = delivery().command_to_last.quantile_ms(0.5) * 1e-3;
    h.latency_p99_s = delivery().command_to_last.quantile_ms(0.99) * 1e-3;
    h.temperature_c = first().settings().limits().temperature_c;
    for (const FaultKind kind : kAllFaults)
        h.active_faults += std::any_of(stations_.begin(), stations_.end(), [kind](const auto& s) {
            return s->faults().order_of(kind).has_value();
        });
    h.clients = static_cast<std::uint32_t>(commands.clients + telemetry_->port_report().clients);
    housekeeping_before_ = h;
    return h;
}

CommandReport Emulator::command_report() const { return report_of(receivers_); }

bool Emulator::finished() const {
    const auto asks = [](const auto& receiver) { return receiver->asks_to_end(); };
    return std::any_of(receivers_.begin(), receivers_.end(), asks) || (events_ && events_->asks_to_end()) ||
           std::all_of(stations_.begin(), stations_.end(),
                       [](const auto& s) { return s->loop().finished(); });
}

void Emulator::run(const std::function<void()>& on_ready) {
    const SignalGuard guard;
    lock_memory(scenario_.loop.real_time);
    for (const auto& station : stations_) station->start_outputs();
    if (telemetry_) telemetry_->start();
    for (const auto& receiver : receivers_) receiver->start();
    if (lines_) lines_->start();
    const std::int64_t begun_ns = monotonic_ns();
    begun_ns_ = begun_ns;
    begun_processor_ns_ = processor_printed_ns_ = processor_ns();
    if (recorder_) recorder_->start();
    for (const auto& replay : replays_) replay->start(clock_start_ns_);
    if (events_) events_->start();
    for (const auto& station : stations_) station->start_loop();
    raise_threads(scenario_.loop.real_time);
    // The light maker's thread is not raised with the others.
    if (light_maker_) {
        spdlog::info(
            "light between surfaces is made beside the run: until then frames have random paths and the flag "
            "no_kept_light; `hilcam prepare` makes it before a run");
        light_maker_->start();
        next_light_line_ns_ = begun_ns + 3'000'000'000;
    }
    on_ready();
    notify_service_manager("READY=1");
    const bool terminal = isatty(STDERR_FILENO);
    std::int64_t next_line_ns = begun_ns + 1'000'000'000;
    next_missed_line_ns_ = begun_ns + kBetweenMissedLines_ns;  // the first frames are late on every machine
    while (!signalled && !finished()) {
        const std::int64_t now_ns = monotonic_ns();
        note_time(begun_ns);
        if (limits_.seconds > 0 && seconds_ >= limits_.seconds) break;
        for (const auto& station : stations_) station->serve_faults(seconds_);
        print_level_changes();
        print_held_motion();
        print_impossible_motion();
        print_light(now_ns);
        silence_log_.look();
        print_output_faults(now_ns);
        if (terminal && limits_.outputs && now_ns >= next_line_ns) {
            print_line();
            next_line_ns += 1'000'000'000;
        }
        if (!terminal) print_missed(now_ns);
        sleep_until_monotonic_ns(now_ns + 10'000'000);
    }
    notify_service_manager("STOPPING=1");
    // Loops stop first, because they answer what waits for a frame.
    if (events_) events_->ask_to_stop();
    for (const auto& station : stations_) station->stop_loop();
    if (light_maker_) light_maker_->stop();
    if (events_) events_->stop();
    for (const auto& replay : replays_) replay->stop();
    print_level_changes();
    note_time(begun_ns);
    for (const auto& receiver : receivers_) receiver->stop();
    if (lines_) lines_->stop();
    if (telemetry_) telemetry_->stop();
    for (const auto& station : stations_) {
        station->stop_outputs();
        station->serve_faults(seconds_);
    }
    if (recorder_) recorder_->stop();
    print_replays();
    print_lines();
}

void Emulator::note_time(std::int64_t begun_ns) {
    const std::int64_t ns = monotonic_ns() - begun_ns;
    seconds_ = static_cast<double>(ns) * 1e-9;
    if (ns > 0)
        used_cores_ = static_cast<double>(processor_ns() - begun_processor_ns_) / static_cast<double>(ns);
}

void Emulator::print_lines() const {
    if (!lines_ || !scenario_.lines.any()) return;
    const LineReport r = lines_->report();
    spdlog::info(
        "lines: {} edges in ({} refused, {} from strangers), {} out ({} lost), at most {:.0f} us after their "
        "instant",
        r.edges_in, r.edges_refused, r.strangers, r.edges_out, r.edges_lost, r.worst_late_us);
}

void Emulator::print_replays() const {
    for (const auto& replay : replays_) {
        const Replay::Outcome outcome = replay->outcome();
        if (outcome.text.empty())
            spdlog::info("the replay was ended after {} frames", outcome.frames);
        else if (outcome.whole)
            spdlog::info("replayed all {} frames", outcome.frames);
        else
            spdlog::warn("replayed {} frames, up to {}", outcome.frames, outcome.text);
    }
}

// Allocates nothing, because it runs while frames are made.
void Emulator::print_level_changes() {
    LevelChange change;
    for (const auto& station : stations_)
        while (station->loop().take_level_change(change))
            if (change.budget_ms > 0)
                spdlog::info(
                    "{}: from frame {} on quality level {} instead of {}, at which frames took {:.2f} ms "
                    "({:.2f} ms are allowed)",
                    station->name(), change.frame, change.to, change.from, change.mean_ms, change.budget_ms);
            else
                spdlog::info(
                    "{}: from frame {} on quality level {} instead of {}, as frames have no time limit",
                    station->name(), change.frame, change.to, change.from);
}

// Logs once that simulated time has left the span of a motion file.
void Emulator::print_held_motion() {
    if (reported_held_motion_ || first().world().held() == 0) return;
    reported_held_motion_ = true;
    spdlog::warn("simulated time is outside a motion's data: {}; the thing that it moves stands still",
                 first().world().first_gap());
}

// Logs once that a motion source or a command leads to an impossible value.
void Emulator::print_impossible_motion() {
    if (reported_impossible_motion_ || first().world().impossible() == 0) return;
    reported_impossible_motion_ = true;
    spdlog::warn(
        "the motion of {} is not a number or exceeds its limits (docs/motion.md): it keeps its last value, "
        "and frames have the flag impossible_motion",
        first().world().first_impossible());
}

// Logs how long making light will still take, soon after the begin and then twice a minute.
void Emulator::print_light_left(std::int64_t now_ns) {
    if (now_ns < next_light_line_ns_) return;
    constexpr std::int64_t kBetweenLines_ns = 30'000'000'000;
    next_light_line_ns_ = now_ns + kBetweenLines_ns;
    const double share = light_maker_->share();
    if (const std::optional<double> left = left_s({"", share, seconds_}))
        spdlog::info("light between surfaces: {:.0f} % made, about {} left", std::floor(100 * share),
                     duration_text(*left));
    else
        spdlog::info("light between surfaces: {:.0f} % made", std::floor(100 * share));
}

// Logs once that all cameras have the light that was made during the run.
void Emulator::print_light(std::int64_t now_ns) {
    if (reported_light_ || !light_maker_) return;
    if (!light_maker_->is_done()) return print_light_left(now_ns);
    for (const auto& station : stations_)
        if (station->loop().counters().lacks_light.load()) return;
    reported_light_ = true;
    for (const auto& station : stations_)
        spdlog::info("{}: light between surfaces is kept after frame {}; its tables took {:.1f} s",
                     station->name(), station->loop().counters().last_without_light.load(),
                     light_maker_->seconds());
}

// Logs once, not for each frame, that an output can no longer deliver. The report at the end has all of it.
void Emulator::print_output_faults(std::int64_t now_ns) {
    constexpr std::int64_t kBetweenLooks_ns = 250'000'000;
    if (now_ns < next_fault_look_ns_) return;
    next_fault_look_ns_ = now_ns + kBetweenLooks_ns;
    for (const auto& station : stations_) {
        for (const std::string& fault : station->new_faults()) spdlog::error("{}", fault);
        for (const SinkNote& note : station->new_notes())
            spdlog::log(note.warning ? spdlog::level::warn : spdlog::level::info, "{}", note.text);
    }
}

// In a log, without the line of rates, reports missed exposures, at a readable rate.
void Emulator::print_missed(std::int64_t now_ns) {
    if (now_ns < next_missed_line_ns_) return;
    std::uint64_t missed = 0;
    for (const auto& station : stations_) missed += station->loop().counters().deadline_misses.load();
    if (missed == missed_told_) return;
    if (missed_told_ == 0)
        spdlog::warn("{} exposures missed in {:.0f} s: frames take longer than their period", missed,
                     seconds_);
    else
        spdlog::warn("{} exposures missed in {:.0f} s, {} of them new: frames take longer than their period",
                     missed, seconds_, missed - missed_told_);
    missed_told_ = missed;
    next_missed_line_ns_ = now_ns + kBetweenMissedLines_ns;
}

// Prints the line of the first camera.
void Emulator::print_line() {
    const LoopCounters& counters = loop().counters();
    const std::uint64_t frames = counters.frames.load(), missed = counters.deadline_misses.load();
    const std::int64_t processor = processor_ns();
    const PaceLimit limit = pace_limit(first(), {frames - frames_printed_, missed - misses_printed_});
    const CommandReport commands = command_report();
    const std::uint64_t faults = first().faults().all_strikes();
    const std::uint32_t level = counters.level.load();
    spdlog::info(
        "{} frames/s on {:.1f} cores, limited by {}{}, command to last packet p50 {:.1f} ms p99 {:.1f} ms, "
        "{} "
        "exposures missed, {} commands ({} refused){}",
        frames - frames_printed_, static_cast<double>(processor - processor_printed_ns_) * 1e-9,
        words_of(limit), level == 0 ? "" : fmt::format(", quality level {}", level),
        delivery().command_to_last.quantile_ms(0.5), delivery().command_to_last.quantile_ms(0.99), missed,
        commands.received, commands.refused, faults == 0 ? "" : fmt::format(", {} fault strikes", faults));
    frames_printed_ = frames, misses_printed_ = missed, processor_printed_ns_ = processor;
}

}  // namespace hilcam
