// `hilcam run`: runs the camera in real time.

#include <spdlog/spdlog.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "emulator/check/scenario_verdict.h"
#include "emulator/progress/progress.h"
#include "emulator/recording/run_seed.h"
#include "emulator/run/emulator.h"
#include "emulator/run/output_summary.h"
#include "emulator/run/report.h"
#include "emulator/run/run_pace.h"
#include "emulator/scenario/initial_world.h"
#include "emulator/scenario/scene_loader.h"
#include "emulator/send/command_examples.h"
#include "emulator/subcommands/arguments.h"
#include "emulator/subcommands/scenario_use.h"

namespace hilcam {
namespace {

struct RunArguments {
    ConfigArguments config;
    std::filesystem::path report;
    RunLimits limits;
    std::uint16_t preview_port = 0;  // 0: as in the scenario
};

void warn_of_dark_pictures(const ScenarioConfig& scenario) {
    for (std::size_t i = 0; i <= scenario.more_cameras.size(); ++i) {
        const ScenarioConfig own = scenario_of_camera(scenario, i);
        if (const auto* files = own.outputs.find<FilesConfig>())
            log_warning(dark_picture_warning(*files, own.camera.frame_bits()));
    }
}

// Judges what each camera sees at the first instant, by the truth's rays. Skips scenes with terrain, because
// that is made for a pose when the first frame asks for it.
void log_run_verdict(Emulator& emulator) {
    const TimeTai start = parse_utc(emulator.first().scenario().time_utc);
    const Pose first_camera = snapshot_at(emulator.first().scenario(), start, start).camera;
    for (const auto& station : emulator.stations()) {
        const LoadedView view{station->scenario(), station->renderer(), station->objects()};
        if (station->number() == 1) log_warnings(verdict_on_objects(view, VerdictOn::kRun));
        if (station->number() == 1) log_warnings(report_scenario_maps(view.scenario).doubts);
        if (view.scenario.terrain) continue;
        station->renderer().place_for_truth(snapshot_at(view.scenario, start, start));
        const CameraReport seen = report_view(view, station->number(), first_camera);
        log_warnings(verdict_on_view(view.scenario, seen));
    }
}

void say_that_it_runs(const ScenarioConfig& scenario) {
    for (std::size_t i = 0; i <= scenario.more_cameras.size(); ++i) {
        const OutputsConfig& outputs = i == 0 ? scenario.outputs : scenario.more_cameras[i - 1].outputs;
        const auto* preview = outputs.find<PreviewConfig>();
        if (!preview) continue;
        const std::string whose = scenario.more_cameras.empty() ? "" : fmt::format(" of camera {}", i + 1);
        spdlog::info("preview{} at http://{}:{}/", whose, preview->address, preview->port);
    }
    spdlog::info("running; Ctrl-C ends it");
}

// Reports in one line for each camera what happened to its frames, and to the recording's.
void say_outputs(const Emulator& emulator) {
    for (const auto& station : emulator.stations()) {
        std::vector<SinkReport> outputs = output_reports(*station);
        if (station->number() == 1 && emulator.recorder())
            outputs.push_back(output_report(emulator.recorder()->report()));
        const std::string line = line_of(outputs);
        if (line.empty()) continue;
        const std::string whose =
            emulator.stations().size() == 1 ? "" : fmt::format(" of camera {}", station->number());
        spdlog::log(any_lost(outputs) ? spdlog::level::warn : spdlog::level::info, "outputs{}: {}", whose,
                    line);
    }
}

std::string waits_text(const Emulator& emulator) {
    constexpr double kWorthTelling_s = 0.05;
    double max_s = 0;
    for (const auto& station : emulator.stations())
        max_s = std::max(max_s,
                         static_cast<double>(station->loop().counters().waited_for_outputs_ns.load()) * 1e-9);
    return max_s < kWorthTelling_s ? "" : fmt::format(", {:.1f} s of it waiting for outputs", max_s);
}

// Returns how late frames went out, which the count of missed exposures does not show. Empty when no frame
// went out, and in lockstep.
std::string lateness(const Emulator& emulator) {
    const DurationHistogram& late = emulator.first().delivery().exposure_to_last;
    if (late.count() == 0 || emulator.first().settings().limits().lockstep) return "";
    return fmt::format(", mid-exposure to last packet p99 {:.1f} ms", late.quantile_ms(0.99));
}

// Writes the report, prints how the run went, and returns the exit status.
int conclude(const Emulator& emulator, const std::filesystem::path& report_file) {
    std::uint64_t outside = 0;
    for (const auto& station : emulator.stations()) outside += station->renderer().rays_outside_air();
    if (outside > 0)
        spdlog::warn("{} rays were outside the atmosphere's table and used its nearest geometry", outside);
    if (!report_file.empty()) write_json(report_file, run_report(emulator));
    const RunOutcome outcome = run_outcome(emulator);
    spdlog::info(
        "{} frames in {:.1f} s{}, {} exposures missed{}: {:.1f} frames/s on {:.1f} of {} cores, limited by "
        "{}",
        outcome.frames, emulator.seconds(), waits_text(emulator), outcome.deadline_misses, lateness(emulator),
        static_cast<double>(outcome.frames) / std::max(1e-9, emulator.seconds()), emulator.used_cores(),
        given_cores(), words_of(pace_limit(emulator.first(), {outcome.frames, outcome.deadline_misses})));
    for (const auto& station : emulator.stations())
        if (const std::string line = quality_line(*station); !line.empty())
            spdlog::info("{}: {}", station->name(), line);
    say_outputs(emulator);
    for (const std::string& fault : outcome.faults) spdlog::error("{}", fault);
    for (const BrokenBound& broken : outcome.broken) spdlog::error("{}", text_of(broken));
    return outcome.faults.empty() && outcome.broken.empty() ? 0 : 1;
}

// Refuses bounds that nothing in this run could break.
void require_measurable(const ScenarioConfig& scenario, const RunLimits& limits) {
    if (!limits.replay.empty()) require_replay(scenario.loop.fail_on);
    for (std::size_t i = 0; i <= scenario.more_cameras.size(); ++i)
        require_timed_output(scenario.loop.fail_on, have_live(scenario_of_camera(scenario, i).outputs));
}

int carry_out(const RunArguments& o) {
    ConfigArguments config = o.config;
    if (o.preview_port > 0)
        config.overrides.push_back(fmt::format("outputs.preview.port={}", o.preview_port));
    ScenarioConfig scenario = load_scenario(config.file, config.overrides);
    const auto threads = limit_threads(scenario);
    RunLimits limits = o.limits;
    require_measurable(scenario, limits);
    // With a limited number of frames, each must have its light. A replay may have frames of any level.
    limits.light_beside = limits.frames == 0;
    scenario.loop.holds_rate = limits.frames == 0 || !limits.replay.empty();
    log_info(settle_seed(scenario, limits.replay));
    log_warnings(limits.replay.empty() ? early_verdict(scenario, VerdictOn::kRun, !limits.record.empty())
                                       : scenario.warnings);
    spdlog::info("loading {}", scenario.name);
    const auto emulator = in_memory(scenario, [&] {
        const Progress progress("loading " + scenario.name);
        return std::make_unique<Emulator>(scenario, limits);
    });
    if (limits.replay.empty()) log_run_verdict(*emulator);
    warn_of_dark_pictures(scenario);
    emulator->run([&] { say_that_it_runs(scenario); });
    return conclude(*emulator, o.report);
}

}  // namespace

void add_run_command(CLI::App& app, Action& action) {
    auto o = std::make_shared<RunArguments>();
    CLI::App* run = app.add_subcommand("run", "be the camera, in real time");
    add_config(run, o->config);
    run->add_option("--duration", o->limits.seconds, "stop after this many seconds")
        ->check(CLI::Range(0.0, 1e9));
    run->add_option("--frames", o->limits.frames, "stop after this many frames");
    run->add_option("--report", o->report, "write a report (JSON) at the end");
    run->add_option("--preview", o->preview_port, "serve a web page with the live picture at this TCP port")
        ->check(CLI::Range(1, 65535));
    CLI::Option* record = run->add_option("--record", o->limits.record,
                                          "record all inputs of the frames, for a bit-exact replay");
    CLI::Option* replay =
        run->add_option("--replay", o->limits.replay, "replay the frames of a recording")->excludes(record);
    run->add_flag("--fast", o->limits.replay_fast, "replay as fast as it goes, not by the recording's times")
        ->needs(replay);
    run->add_flag("--force", o->limits.replay_force, "replay a recording of another scenario or version, too")
        ->needs(replay);
    set_examples(run,
                 {"hilcam run small --frames 3", "hilcam run geo_inspection --preview 8080 --duration 60",
                  "hilcam run small --set outputs.files.folder=/tmp/frames --report run.json"});
    when_named(run, action, o, carry_out);
}

}  // namespace hilcam
