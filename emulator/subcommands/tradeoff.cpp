// `hilcam tradeoff`: measures speed against accuracy.

#include <spdlog/spdlog.h>

#include "emulator/run/report.h"
#include "emulator/send/command_examples.h"
#include "emulator/subcommands/arguments.h"
#include "emulator/subcommands/scenario_use.h"
#include "emulator/tradeoff/tradeoff_report.h"

namespace hilcam {
namespace {

struct TradeoffArguments {
    ConfigArguments config;
    std::filesystem::path out;
    TradeoffOptions options;
};

int carry_out(const TradeoffArguments& o) {
    const ScenarioSource source{o.config.file, o.config.overrides};
    const ScenarioConfig scenario = load_and_warn(o.config);
    const auto threads = limit_threads(scenario);
    make_folder(o.out);
    const Tradeoff result = measure_tradeoff(source, o.options, log_info);
    fmt::print("{}", tradeoff_text(result));
    write_tradeoff(result, o.out);
    return 0;
}

}  // namespace

void add_tradeoff_command(CLI::App& app, Action& action) {
    auto o = std::make_shared<TradeoffArguments>();
    CLI::App* tradeoff =
        app.add_subcommand("tradeoff", "measure speed against accuracy over the choices of a scenario");
    add_config(tradeoff, o->config);
    tradeoff->add_option("--out", o->out, "folder for CSV, JSON, presets and a page with plots")->required();
    tradeoff
        ->add_option("--frame-ms", o->options.frame_ms,
                     "recommend a setting for this frame time (default: the camera's frame period)")
        ->check(CLI::PositiveNumber);
    tradeoff
        ->add_option("--error-sigma", o->options.error_sigma,
                     "recommend a setting for this error of 99 % of the lit pixels, in their sensor noise")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    tradeoff
        ->add_option("--budget-s", o->options.budget_s,
                     "seconds for the sweep; the reference, which comes before it, takes its own")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    tradeoff
        ->add_option("--combinations", o->options.combinations, "number of combinations to measure, at most")
        ->check(CLI::Range(0, 100000))
        ->capture_default_str();
    tradeoff->add_option("--runs", o->options.runs, "frames of a setting, of which the median is taken")
        ->check(CLI::Range(5, 1000))
        ->capture_default_str();
    tradeoff
        ->add_option(
            "--reference-frames", o->options.reference.max_frames,
            "most frames of the reference, a power of two; fewer where its standard error is small before")
        ->check(CLI::Range(4, 65536))
        ->capture_default_str();
    tradeoff
        ->add_option("--reference-set", o->options.reference_set,
                     "KEY=VALUE replaces a value of the reference; may be repeated")
        ->allow_extra_args(false);
    set_examples(tradeoff, {"hilcam tradeoff small --out small_tradeoff --budget-s 120"});
    when_named(tradeoff, action, o, carry_out);
}

}  // namespace hilcam
