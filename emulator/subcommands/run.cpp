// `hilcam run`: the camera, in real time.

#include <spdlog/spdlog.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "emulator/recording/run_seed.h"
#include "emulator/run/emulator.h"
#include "emulator/run/report.h"
#include "emulator/scenario/scenario_warnings.h"
#include "emulator/scenario/scene_loader.h"
#include "emulator/subcommands/arguments.h"
#include "emulator/subcommands/scenario_use.h"

namespace hilcam {
namespace {

struct RunArguments {
    ConfigArguments config;
    std::filesystem::path report;
    RunLimits limits;
    std::uint16_t preview_port = 0;  // 0: as the scenario says
};

void warn_of_dark_pictures(const ScenarioConfig& scenario) {
    for (std::size_t i = 0; i <= scenario.more_cameras.size(); ++i) {
        const ScenarioConfig own = scenario_of_camera(scenario, i);
        if (const auto* files = own.outputs.find<FilesConfig>())
            log_warning(dark_picture_warning(*files, own.camera.frame_bits()));
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

// Says how late frames went out, which a count of missed exposures does not tell; nothing where none went out, or where
// frames have no time to be late for.
std::string lateness(const Emulator& emulator) {
    const DurationHistogram& late = emulator.first().delivery().exposure_to_last;
    if (late.count() == 0 || emulator.first().settings().limits().lockstep) return "";
    return fmt::format(", mid-exposure to last packet p99 {:.1f} ms", late.quantile_ms(0.99));
}

// Writes and says how the run went; returns the exit status.
int conclude(const Emulator& emulator, const std::filesystem::path& report_file) {
    std::uint64_t outside = 0;
    for (const auto& station : emulator.stations()) outside += station->renderer().rays_outside_air();
    if (outside > 0)
        spdlog::warn("{} rays left the atmosphere's table and were given its nearest geometry", outside);
    if (!report_file.empty()) write_json(report_file, run_report(emulator));
    const RunOutcome outcome = run_outcome(emulator);
    spdlog::info("{} frames in {:.1f} s, {} exposures missed{}", outcome.frames, emulator.seconds(),
                 outcome.deadline_misses, lateness(emulator));
    for (const std::string& fault : outcome.faults) spdlog::error("{}", fault);
    return outcome.faults.empty() ? 0 : 1;
}

int carry_out(const RunArguments& o) {
    ConfigArguments config = o.config;
    if (o.preview_port > 0)
        config.overrides.push_back(fmt::format("outputs.preview.port={}", o.preview_port));
    ScenarioConfig scenario = load_and_warn(config);
    const auto threads = limit_threads(scenario);
    RunLimits limits = o.limits;
    limits.light_beside = limits.frames == 0;  // a limited number of frames is wanted for what they show
    log_info(settle_seed(scenario, limits.replay));
    if (limits.replay.empty()) {
        log_warnings(idle_warnings(scenario));
        log_warnings(place_warnings(scenario));
    }
    spdlog::info("loading {}", scenario.name);
    const auto emulator = in_memory(scenario, [&] { return std::make_unique<Emulator>(scenario, limits); });
    warn_of_dark_pictures(scenario);
    emulator->run([&] { say_that_it_runs(scenario); });
    return conclude(*emulator, o.report);
}

}  // namespace

void add_run_command(CLI::App& app, Action& action) {
    auto o = std::make_shared<RunArguments>();
    CLI::App* run = app.add_subcommand("run", "be the camera, in real time");
    add_config(run, o->config);
    run->add_option("--duration", o->limits.seconds, "stop after so many seconds")
        ->check(CLI::Range(0.0, 1e9));
    run->add_option("--frames", o->limits.frames, "stop after so many frames");
    run->add_option("--report", o->report, "write a report (JSON) at the end");
    run->add_option("--preview", o->preview_port, "serve a web page with the live picture at this TCP port")
        ->check(CLI::Range(1, 65535));
    CLI::Option* record = run->add_option("--record", o->limits.record,
                                          "keep what the frames depend on, to replay them bit by bit");
    CLI::Option* replay =
        run->add_option("--replay", o->limits.replay, "give the frames of such a recording once more")
            ->excludes(record);
    run->add_flag("--fast", o->limits.replay_fast, "replay as fast as it goes, not by the recording's times")
        ->needs(replay);
    run->add_flag("--force", o->limits.replay_force, "replay a recording of another scenario or version, too")
        ->needs(replay);
    when_named(run, action, o, carry_out);
}

}  // namespace hilcam
