// `hilcam bench`: how fast a scenario runs on this machine, or how large the errors of its frames are.

#include <spdlog/spdlog.h>

#include <bit>
#include <nlohmann/json.hpp>

#include "emulator/bench/bench_report.h"
#include "emulator/bench/soak_report.h"
#include "emulator/progress/user_cache.h"
#include "emulator/run/report.h"
#include "emulator/send/command_examples.h"
#include "emulator/subcommands/arguments.h"
#include "emulator/subcommands/scenario_use.h"
#include "emulator/tradeoff/error_bench.h"
#include "emulator/zoo/zoo_bench.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {
namespace {

struct BenchArguments {
    ConfigArguments config;
    bool json = false, sensor = false, error = false;
    BenchOptions speed;
    std::vector<std::string> variants;  // each "KEY=VALUE; KEY=VALUE"
    SoakOptions soak;
    std::filesystem::path out;  // folder for the results of the soak
    ErrorBenchOptions errors;
    ZooOptions zoo;
    int reference_frames = 0;  // 0: the default of each kind of measurement
};

void print_lines(const std::string& text, const nlohmann::json& report, bool as_json) {
    fmt::print("{}", as_json ? report.dump(2) + "\n" : text);
}

int soak_and_write(const BenchArguments& o, const ScenarioConfig& scenario) {
    make_folder(o.out);
    spdlog::info("soaking {} for {:.0f} s", scenario.name, o.soak.seconds);
    const Soak result = soak(scenario, o.soak);
    if (result.slices.empty()) throw DeviceError("ended before the first slice: there is nothing to write");
    const nlohmann::json report = soak_json(scenario, o.soak, result);
    print_lines(soak_text(result) + "\n", report, o.json);
    write_soak(result, report, o.out);
    for (const BrokenBound& broken : result.broken) spdlog::error("{}", text_of(broken));
    return result.broken.empty() ? 0 : 1;
}

// Returns the scenario and its variants.
std::vector<NamedScenario> variants_of(const BenchArguments& o, const ScenarioConfig& scenario) {
    std::vector<NamedScenario> out{{"(as it is)", scenario}};
    for (const std::string& variant : o.variants) {
        ConfigArguments config = o.config;
        for (const std::string& change : CLI::detail::split(variant, ';'))
            config.overrides.push_back(CLI::detail::trim_copy(change));
        out.push_back({variant, load_and_warn(config)});
    }
    return out;
}

int measure_zoo(const BenchArguments& o) {
    ZooOptions zoo = o.zoo;
    zoo.entries.overrides = o.config.overrides;
    zoo.reference_set = o.errors.reference_set;
    if (o.reference_frames > 0) zoo.reference.max_frames = o.reference_frames;
    const ZooBench result = zoo_bench(zoo, user_cache(), log_info);
    print_lines(zoo_bench_text(result), zoo_bench_json(result), o.json);
    return 0;
}

int carry_out(const BenchArguments& o) {
    if (!o.zoo.folder.empty()) return measure_zoo(o);
    if (o.config.file.empty())
        throw InputError("config is required: a scenario, or --zoo with a folder of them");
    const ScenarioConfig scenario = load_and_warn(o.config);
    const auto threads = limit_threads(scenario);
    if (o.error) {
        ErrorBenchOptions errors = o.errors;
        if (o.reference_frames > 0) errors.reference.max_frames = o.reference_frames;
        const ErrorBench result =
            error_bench({o.config.file, o.config.overrides}, errors, user_cache(), log_info);
        print_lines(error_bench_text(result), error_bench_json(result), o.json);
    } else if (o.soak.seconds > 0) {
        return soak_and_write(o, scenario);
    } else if (o.sensor) {
        const SensorBench result = bench_sensor(scenario, static_cast<int>(o.speed.frames));
        print_lines(bench_text(result), bench_json(result), o.json);
    } else if (!o.variants.empty()) {
        const std::vector<BenchVariant> result = bench_variants(variants_of(o, scenario), o.speed);
        print_lines(bench_text(result), bench_json(result), o.json);
    } else {
        const Bench result = bench(scenario, o.speed);
        print_lines(bench_text(result), bench_json(result), o.json);
    }
    return 0;
}

// The frames of a reference form halves, and halves of halves.
CLI::Validator power_of_two_from_4() {
    return {[](std::string& text) {
                int value = 0;
                const bool ok = CLI::detail::lexical_cast(text, value) && value >= 4 && value <= 65536 &&
                                std::has_single_bit(static_cast<unsigned>(value));
                return ok ? std::string()
                          : "found " + in_quotes(text) + "; accepted: a power of two from 4 to 65536";
            },
            "a power of two from 4 to 65536"};
}

CLI::Option* add_soak_options(CLI::App* bench, BenchArguments& o) {
    CLI::Option* soak =
        bench
            ->add_option(
                "--soak", o.soak.seconds,
                "run for this many seconds at the camera's frame rate, and write changes over time to --out")
            ->check(CLI::PositiveNumber);
    CLI::Option* out =
        bench->add_option("--out", o.out, "with --soak: folder for CSV, JSON and a page with a plot");
    soak->needs(out)->excludes("--sensor", "--path-models");
    out->needs(soak);
    bench
        ->add_option("--slice-s", o.soak.slice_s,
                     "with --soak: seconds of a slice (default: a sixtieth of the soak, at least 10)")
        ->check(CLI::PositiveNumber)
        ->needs(soak);
    bench
        ->add_flag("--outputs", o.soak.outputs,
                   "with --soak: run the scenario's outputs and command ports, too")
        ->needs(soak);
    return soak;
}

void add_zoo_options(CLI::App* bench, BenchArguments& o, CLI::Option* errors, CLI::Option* views) {
    CLI::Option* config = bench->get_option("config")->required(false);
    CLI::Option* zoo =
        bench
            ->add_option(
                "--zoo", o.zoo.folder,
                "with --error: measure every scenario (*.yaml) and mesh of this folder, from several "
                "sides and distances and by several lights")
            ->needs(errors)
            ->excludes(config, views);
    bench->add_option("--zoo-px", o.zoo.entries.picture_px, "with --zoo: longer side of the pictures")
        ->check(CLI::Range(16, 4096))
        ->capture_default_str()
        ->needs(zoo);
    bench
        ->add_option_function<std::string>(
            "--zoo-views", [&o](const std::string& which) { o.zoo.all_views = which == "all"; },
            "with --zoo: few (6 views of a member that can be turned) or all (72)")
        ->check(CLI::IsMember({"few", "all"}))
        ->default_str("few")
        ->needs(zoo);
}

CLI::Option* add_error_options(CLI::App* bench, BenchArguments& o, CLI::Option* soak, CLI::Option*& views) {
    CLI::Option* errors =
        bench
            ->add_flag("--error", o.error,
                       "measure errors in place of speed: views around the first object against references, "
                       "which are kept in the cache folder")
            ->excludes(soak)
            ->excludes("--sensor", "--path-models", "--frames", "--runs");
    views = bench->add_option("--views", o.errors.views, "with --error: number of views, evenly around")
                ->check(CLI::Range(1, 1000))
                ->capture_default_str()
                ->needs(errors);
    bench
        ->add_option("--reference-frames", o.reference_frames,
                     "with --error: most frames for each view's reference (default: 4, of a zoo 64 with a "
                     "quarter of the rays); fewer "
                     "are taken where its standard error is small before")
        ->check(power_of_two_from_4())
        ->needs(errors);
    bench
        ->add_option("--reference-set", o.errors.reference_set,
                     "with --error: KEY=VALUE replaces a value of the references; may be repeated")
        ->allow_extra_args(false)
        ->needs(errors);
    return errors;
}

}  // namespace

void add_bench_command(CLI::App& app, Action& action) {
    auto o = std::make_shared<BenchArguments>();
    CLI::App* bench =
        app.add_subcommand("bench", "measure how fast a scenario runs here, or how far off its frames are");
    add_config(bench, o->config);
    bench->add_flag("--json", o->json, "machine-readable");
    bench->add_flag("--path-models", o->speed.path_models,
                    "measure each path model, too, against bare Embree on the same rays");
    bench->add_flag("--sensor", o->sensor,
                    "measure the sensor stage alone, and what each of its effects costs");
    bench->add_option("--frames", o->speed.frames, "number of frames in a run")
        ->check(CLI::Range(1, 1000000));
    bench->add_option("--runs", o->speed.runs, "number of runs, of which the median is taken")
        ->check(CLI::Range(1, 1000));
    CLI::Option* variant =
        bench
            ->add_option("--variant", o->variants,
                         "measure the scenario beside one in which 'KEY=VALUE; KEY=VALUE' differ, in turns; "
                         "may be repeated")
            ->allow_extra_args(false)
            ->excludes("--sensor", "--path-models");
    CLI::Option* views = nullptr;
    CLI::Option* errors = add_error_options(bench, *o, add_soak_options(bench, *o), views);
    add_zoo_options(bench, *o, errors, views);
    variant->excludes(errors, bench->get_option("--soak"));
    set_examples(bench,
                 {"hilcam bench small", "hilcam bench geo_inspection --variant quality=fast",
                  "hilcam bench geo_inspection --soak 3600 --out soak",
                  "hilcam bench geo_inspection --error --views 4", "hilcam bench --error --zoo meshes"});
    when_named(bench, action, o, carry_out);
}

}  // namespace hilcam
