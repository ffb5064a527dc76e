// `hilcam prepare`: makes what a run would otherwise make during its first frames.

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <charconv>
#include <string>
#include <vector>

#include "emulator/run/camera_station.h"
#include "emulator/run/probe_report.h"
#include "emulator/send/command_examples.h"
#include "emulator/subcommands/arguments.h"
#include "emulator/subcommands/scenario_use.h"
#include "render/vocabulary/stopwatch.h"

namespace hilcam {
namespace {

struct PrepareArguments {
    ConfigArguments config;
    std::vector<std::string> probe;  // an object's name and a number; empty: not requested
};

ProbeChoice probe_of(const std::vector<std::string>& words) {
    ProbeChoice choice{words[0]};
    const char* const end = words[1].data() + words[1].size();
    const auto [rest, error] = std::from_chars(words[1].data(), end, choice.number);
    if (error != std::errc() || rest != end)
        throw InputError("--probe " + words[0] + ": found '" + words[1] +
                         "'; accepted: an object's name and a whole number");
    return choice;
}

// Loads what a camera loads for a run, and makes the parts that are not on disk.
LightLoading prepare_camera(const ScenarioConfig& bench, std::size_t index, const SpectralGrid& grid) {
    ScenarioConfig own = scenario_of_camera(bench, index);
    own.loop.holds_rate = true;  // includes all quality levels that a run may have
    RunLimits limits;
    limits.outputs = limits.paced = false;
    CameraStation station(own, index + 1, limits);
    station.load(grid);
    return std::move(station.light());
}

int carry_out(const PrepareArguments& o) {
    const ScenarioConfig scenario = load_and_warn(o.config);
    const auto threads = limit_threads(scenario);
    if (!o.probe.empty()) {
        const ProbeChoice probe = probe_of(o.probe);
        fmt::print("{}", in_memory(scenario, [&] { return probe_report(scenario, probe); }));
        return 0;
    }
    const SpectralGrid grid(scenario.spectrum_edges_um);
    const Stopwatch watch;
    std::size_t made = 0, found = 0;
    // One camera after the other, because each scene is large.
    for (std::size_t i = 0; i <= scenario.more_cameras.size(); ++i) {
        const LightLoading light = in_memory(scenario, [&] { return prepare_camera(scenario, i, grid); });
        made += light.made, found += light.found;
    }
    fmt::print("{} is ready: {} tables of light made, {} were on disk; {:.1f} s\n", scenario.name, made,
               found, watch.seconds());
    return 0;
}

}  // namespace

void add_prepare_command(CLI::App& app, Action& action) {
    auto o = std::make_shared<PrepareArguments>();
    CLI::App* prepare = app.add_subcommand(
        "prepare", "make what a run needs and keeps on disk, so that its first frame has the best light");
    add_config(prepare, o->config);
    prepare
        ->add_option("--probe", o->probe,
                     "OBJECT N: print what this probe of an object sees, as JSON; render --pixel names a "
                     "pixel's probe")
        ->expected(2)
        ->type_name("OBJECT N");
    set_examples(prepare,
                 {"hilcam prepare geo_inspection", "hilcam prepare leo_inspection --probe target 4523"});
    when_named(prepare, action, o, carry_out);
}

}  // namespace hilcam
