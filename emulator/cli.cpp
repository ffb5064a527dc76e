#include "emulator/cli.h"

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>
#include <tbb/global_control.h>

#include <CLI/CLI.hpp>
#include <bit>
#include <new>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>

#include "emulator/bench/bench.h"
#include "emulator/bench/sensor_bench.h"
#include "emulator/bench/soak_report.h"
#include "emulator/characterise/characterise_report.h"
#include "emulator/check/calibration.h"
#include "emulator/check/check_command.h"
#include "emulator/check/doctor.h"
#include "emulator/check/doctor_facts.h"
#include "emulator/check/mesh_survey.h"
#include "emulator/commit.h"
#include "emulator/manual_command.h"
#include "emulator/recording/program_version.h"
#include "emulator/recording/recording_text.h"
#include "emulator/recording/run_seed.h"
#include "emulator/run/emulator.h"
#include "emulator/run/log_setup.h"
#include "emulator/run/render_command.h"
#include "emulator/run/report.h"
#include "emulator/scenario/scenario_warnings.h"
#include "emulator/scenario/scene_loader.h"
#include "emulator/send/choice_option.h"
#include "emulator/send/send_command.h"
#include "emulator/tradeoff/error_bench.h"
#include "emulator/tradeoff/tradeoff_report.h"
#include "io/config/config_advice.h"
#include "io/config/config_yaml.h"
#include "io/files/mesh_cache.h"
#include "io/system/program_files.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {
namespace {

struct Options {
    std::filesystem::path config, out, report;
    RenderFiles files;
    std::vector<std::string> overrides;
    double duration_s = 0, time_offset_s = 0;
    std::uint64_t frames = 0;
    BenchOptions bench;
    SoakOptions soak;
    ErrorBenchOptions error_bench;
    TradeoffOptions tradeoff;
    bool json = false, sensor = false, error = false, overwrite = false, clear_cache = false;
    std::size_t camera = 0;  // from 1; 0: not told
    RunLimits run;
    std::uint16_t preview_port = 0;  // 0: as the scenario says
    RenderStage stage = RenderStage::kFrame;
    CalibrationFormat calibration = CalibrationFormat::kNone;
};

// Threads of oneTBB, for as long as it lives.
std::optional<tbb::global_control> limit_threads(const ScenarioConfig& scenario) {
    std::optional<tbb::global_control> limit;
    if (scenario.threads > 0)
        limit.emplace(tbb::global_control::max_allowed_parallelism,
                      static_cast<std::size_t>(scenario.threads));
    return limit;
}

void warn_if_said(const std::string& line) {
    if (!line.empty()) spdlog::warn("{}", line);
}

void warn_of_dark_pictures(const ScenarioConfig& scenario) {
    for (std::size_t i = 0; i <= scenario.more_cameras.size(); ++i) {
        const ScenarioConfig own = scenario_of_camera(scenario, i);
        if (own.outputs.has_files)
            warn_if_said(dark_picture_warning(own.outputs.files, own.camera.frame_bits()));
    }
}

void tell(const std::vector<std::string>& warnings) {
    for (const std::string& warning : warnings) spdlog::warn("{}", warning);
}

void tell_seed(const std::string& line) {
    if (!line.empty()) spdlog::info("{}", line);
}

// What a command does with a scenario; when memory does not suffice, who needs most of it is said.
template <class Action>
auto in_memory(const ScenarioConfig& s, const Action& action) {
    try {
        return action();
    } catch (const std::bad_alloc&) {
        const auto oversampling = static_cast<int>(s.quality.oversampling);
        const ImageGeometry image = geometry_of(s.camera, static_cast<int>(s.quality.guard_px), oversampling);
        const std::size_t bins = s.spectrum_edges_um.size() - 1;
        const double bytes = 4.0 * image.padded_width() * image.padded_height() * static_cast<double>(bins);
        throw DeviceError(fmt::format(
            "there is not enough memory for the scenario: its camera of {} x {} px has radiance images of {} "
            "x {} px in {} bins, {:.3g} GB each (camera.width_px, height_px, quality.oversampling, guard_px, "
            "spectrum_edges_um)",
            s.camera.width_px, s.camera.height_px, image.padded_width(), image.padded_height(), bins,
            bytes * 1e-9));
    }
}

int run(const Options& o) {
    std::vector<std::string> overrides = o.overrides;
    if (o.preview_port > 0) overrides.push_back(fmt::format("outputs.preview.port={}", o.preview_port));
    ScenarioConfig scenario = load_scenario(o.config, overrides);
    const auto threads = limit_threads(scenario);
    RunLimits limits = o.run;
    limits.seconds = o.duration_s;
    limits.frames = o.frames;
    limits.light_beside = o.frames == 0;  // so many frames are wanted for what they show
    tell_seed(settle_seed(scenario, limits.replay));
    if (limits.replay.empty()) {
        tell(idle_warnings(scenario));
        tell(place_warnings(scenario));
    }
    spdlog::info("loading {}", scenario.name);
    const auto whole = in_memory(scenario, [&] { return std::make_unique<Emulator>(scenario, limits); });
    Emulator& emulator = *whole;
    warn_of_dark_pictures(scenario);
    emulator.run([&] {
        for (std::size_t i = 0; i <= scenario.more_cameras.size(); ++i) {
            const OutputsConfig& outputs = i == 0 ? scenario.outputs : scenario.more_cameras[i - 1].outputs;
            if (!outputs.has_preview) continue;
            const std::string whose =
                scenario.more_cameras.empty() ? "" : fmt::format(" of camera {}", i + 1);
            spdlog::info("preview{} at http://{}:{}/", whose, outputs.preview.address, outputs.preview.port);
        }
        spdlog::info("running; Ctrl-C ends it");
    });
    const nlohmann::json report = run_report(emulator);
    std::uint64_t outside = 0;
    for (const auto& station : emulator.stations()) outside += station->renderer().rays_outside_air();
    if (outside > 0)
        spdlog::warn("{} rays left the atmosphere's table and were given its nearest geometry", outside);
    if (!o.report.empty()) write_json(o.report, report);
    spdlog::info("{} frames in {:.1f} s, {} exposures missed", report["frames"].get<std::uint64_t>(),
                 emulator.seconds(), report["deadline_misses"].get<std::uint64_t>());
    for (const nlohmann::json& fault : report["faults"]) spdlog::error("{}", fault.get<std::string>());
    return report["faults"].empty() ? 0 : 1;
}

int list_of_recording(const Options& o) {
    RecordingReader recording(o.config);
    list_recording(recording, [](const std::string& line) { fmt::print("{}\n", line); });
    return 0;
}

void require_camera(const Options& o, const ScenarioConfig& scenario) {
    const std::size_t cameras = 1 + scenario.more_cameras.size();
    if (o.camera > cameras)
        throw InputError(fmt::format("--camera: found {}; accepted: 1 to {}", o.camera, cameras));
}

int render(const Options& o) {
    ScenarioConfig scenario = load_scenario(o.config, o.overrides);
    const auto threads = limit_threads(scenario);
    require_camera(o, scenario);
    tell_seed(settle_seed(scenario));
    tell(place_warnings(scenario));
    if (o.camera == 0 && !scenario.more_cameras.empty())
        spdlog::info("camera 1 of {}; --camera N for another", 1 + scenario.more_cameras.size());
    return in_memory(scenario, [&] {
        const std::size_t camera = std::max<std::size_t>(1, o.camera);
        RenderFiles files = o.files;
        files.overwrite = o.overwrite;
        render_to_files(scenario, o.stage, o.time_offset_s, files, camera);
        if (o.stage == RenderStage::kFrame && files.view.empty())
            warn_if_said(dark_picture_warning(files.out,
                                              scenario_of_camera(scenario, camera - 1).camera.frame_bits(),
                                              "--view FILE.png writes one to look at"));
        return 0;
    });
}

int print_calibration(const Options& o) {
    if (is_camera_file(o.config)) {
        CameraModel camera;
        read_config(o.config, section_of(camera), o.overrides);
        fmt::print("{}", calibration_text(std::array{calibration_of(camera)}, o.calibration));
        return 0;
    }
    const ScenarioConfig scenario = load_scenario(o.config, o.overrides);
    require_camera(o, scenario);
    fmt::print("{}", calibration_text(calibrations_of(scenario, o.camera), o.calibration));
    return 0;
}

int check(const Options& o) {
    if (o.calibration != CalibrationFormat::kNone) return print_calibration(o);
    if (is_camera_file(o.config)) {
        fmt::print("{}", check_camera(o.config, o.overrides, o.json));
        return 0;
    }
    const ScenarioConfig scenario = load_scenario(o.config, o.overrides);
    require_camera(o, scenario);
    const CheckReport report = in_memory(scenario, [&] { return check_scenario(scenario, o.camera); });
    fmt::print("{}", o.json ? to_json(report) : to_text(report));
    return 0;
}

int survey(const Options& o) {
    const MeshSurvey found = survey_mesh(load_mesh_contents(o.config), o.config.string());
    fmt::print("{}", o.json ? to_json(found) : to_text(found));
    return 0;
}

int run_sensor_bench(const Options& o, const ScenarioConfig& scenario) {
    const nlohmann::json result = bench_sensor(scenario, static_cast<int>(o.bench.frames));
    if (o.json) {
        fmt::print("{}\n", result.dump(2));
        return 0;
    }
    fmt::print("{}: {} x {} px, sensor stage {:.2f} ms, FFT pair and copy {:.2f} ms, ratio {:.2f}\n",
               result["camera"].get<std::string>(), result["width"].get<int>(), result["height"].get<int>(),
               result["sensor_ms"].get<double>(), result["floor_ms"].get<double>(),
               result["ratio_to_floor"].get<double>());
    for (const auto& [stage, ms] : result["stages_ms"].items())
        fmt::print("  {:<22} {:7.2f} ms\n", stage, ms.get<double>());
    for (const nlohmann::json& effect : result["effects"])
        fmt::print("  with {:<22} {:+7.2f} ms\n", effect["name"].get<std::string>(),
                   effect["extra_ms"].get<double>());
    return 0;
}

int run_soak(const Options& o, const ScenarioConfig& scenario) {
    make_folder(o.out);
    spdlog::info("soaking {} for {:.0f} s", scenario.name, o.soak.seconds);
    const Soak result = soak(scenario, o.soak);
    if (result.slices.empty()) throw DeviceError("ended before the first slice: there is nothing to write");
    const nlohmann::json report = soak_json(scenario, o.soak, result);
    fmt::print("{}\n", o.json ? report.dump(2) : soak_text(result));
    write_soak(result, report, o.out);
    return 0;
}

int run_error_bench(const Options& o) {
    const nlohmann::json result = error_bench({o.config, o.overrides}, o.error_bench, cache_folder(),
                                              [](const std::string& line) { spdlog::info("{}", line); });
    fmt::print("{}", o.json ? result.dump(2) + "\n" : error_bench_text(result));
    return 0;
}

int run_bench(const Options& o) {
    const ScenarioConfig scenario = load_scenario(o.config, o.overrides);
    const auto threads = limit_threads(scenario);
    if (o.error) return run_error_bench(o);
    if (o.soak.seconds > 0) return run_soak(o, scenario);
    if (o.sensor) return run_sensor_bench(o, scenario);
    const nlohmann::json result = bench(scenario, o.bench);
    if (o.json) {
        fmt::print("{}\n", result.dump(2));
        return 0;
    }
    fmt::print("{}: {}x{}, {} triangles, {:.1f} % covered\n", scenario.name, scenario.camera.width_px,
               scenario.camera.height_px, result["triangles"].get<std::size_t>(),
               100 * result["coverage"].get<double>());
    fmt::print("{:.1f} frames/s; frame p50 {:.2f} ms, p99 {:.2f} ms; floor {:.2f} ms; ratio {:.2f}\n",
               result["frame_rate_hz"].get<double>(), result["frame_ms"]["p50"].get<double>(),
               result["frame_ms"]["p99"].get<double>(), result["floor_ms"].get<double>(),
               result["ratio_to_floor"].get<double>());
    fmt::print("{:.2f} core-ms a frame, of all threads\n", result["core_ms_per_frame"].get<double>());
    const nlohmann::json& rays = result["rays"];
    fmt::print(
        "rays of the last frame: {} primary, {} shadow, {} shadow behind a bounce, {} to lamps and "
        "bodies, {} of paths\n",
        rays["primary"].get<std::uint64_t>(), rays["shadow"].get<std::uint64_t>(),
        rays["bounce_shadow"].get<std::uint64_t>(), rays["lamp"].get<std::uint64_t>(),
        rays["path"].get<std::uint64_t>());
    for (const auto& [stage, times] : result["stages_ms"].items())
        fmt::print("  {:<10} p50 {:7.3f} ms  p99 {:7.3f} ms\n", stage, times["p50"].get<double>(),
                   times["p99"].get<double>());
    for (const auto& [name, speed] : result["path_models"].items())
        fmt::print(
            "  path model {:<10} {:9} rays  {:8.1f} ms  {:6.2f} Mrays/s, bare Embree {:6.2f} Mrays/s, ratio "
            "{:.2f}\n",
            name, speed["rays"].get<std::uint64_t>(), speed["frame_ms"].get<double>(),
            speed["mrays_s"].get<double>(), speed["bare_mrays_s"].get<double>(),
            speed["ratio_to_bare"].get<double>());
    return 0;
}

int run_characterise(const Options& o) {
    CameraModel camera;
    if (has_top_level_key(o.config, "time_utc"))
        throw InputError(o.config.string() +
                         ": is a scenario; accepted: a camera's data sheet, as cameras/lorri.yaml");
    read_config(o.config, section_of(camera), o.overrides);
    const DetectorPictures pictures = load_detector_pictures(camera);
    const nlohmann::json report = characterisation_json(characterise(camera, pictures), pictures);
    fmt::print("{}\n", o.json ? report.dump(2) : characterisation_table(report));
    if (!o.out.empty()) write_characterisation(report, o.out);
    return 0;
}

int run_tradeoff(const Options& o) {
    const ScenarioSource source{o.config, o.overrides};
    const ScenarioConfig scenario = source.load();
    const auto threads = limit_threads(scenario);
    make_folder(o.out);
    const Tradeoff result =
        measure_tradeoff(source, o.tradeoff, [](const std::string& line) { spdlog::info("{}", line); });
    fmt::print("{}", tradeoff_text(result));
    write_tradeoff(result, o.out);
    return 0;
}

int run_doctor(const Options& o) {
    if (o.clear_cache) {
        const CacheSize gone = clear_cache();
        fmt::print("{}: {} files removed, {:.0f} MB\n", harmless(cache_folder().string()), gone.files,
                   static_cast<double>(gone.bytes) * 1e-6);
        return 0;
    }
    const BenchNeeds needs = o.config.empty() ? BenchNeeds{} : needs_of(load_scenario(o.config, o.overrides));
    const std::vector<Finding> findings = diagnose(needs, look_at_machine(needs));
    fmt::print("{}", o.json ? findings_json(findings) : findings_text(findings));
    return all_there(findings) ? 0 : 1;
}

// Halves and halves of halves: frames of a reference.
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

// Puts a shipped file's path in the place of its name.
CLI::Validator name_of_shipped() {
    return {
        [](std::string& name) {
            const std::filesystem::path file = named_config(name);
            std::error_code error;
            // A path is told when it is read.
            if (!std::filesystem::exists(file, error) && !file.has_parent_path() && !file.has_extension()) {
                const std::string nearest = nearest_of(name, shipped_names());
                return "found " + in_quotes(name) +
                       ", which is neither a file nor a shipped scenario or camera" +
                       (nearest.empty() ? "" : "; nearest: " + nearest);
            }
            name = file.string();
            return std::string();
        },
        ""};
}

void add_config(CLI::App* command, Options& o) {
    command->add_option("config", o.config, "scenario file (YAML), or the name of a shipped one")
        ->required()
        ->transform(name_of_shipped());
    command->add_option("--set", o.overrides, "KEY=VALUE, replaces a value of the scenario; may be repeated")
        ->allow_extra_args(false);
}

void add_camera(CLI::App* command, Options& o) {
    command->add_option("--camera", o.camera, "which of the scenario's cameras, from 1")
        ->check(CLI::Range(std::size_t{1}, kMostCameras));
}

}  // namespace

int run_command_line(int argc, char** argv) {
    set_up_log();
    Options o;
    std::function<int()> action;
    CLI::App app{"hilcam: a spacecraft's camera for the test bench"};
    app.set_version_flag("--version", fmt::format("{} ({})", kProgramVersion, program_commit()));
    app.require_subcommand(1);

    CLI::App* run_app = app.add_subcommand("run", "be the camera, in real time");
    add_config(run_app, o);
    run_app->add_option("--duration", o.duration_s, "stop after so many seconds")
        ->check(CLI::Range(0.0, 1e9));
    run_app->add_option("--frames", o.frames, "stop after so many frames");
    run_app->add_option("--report", o.report, "write a report (JSON) at the end");
    run_app
        ->add_option("--preview", o.preview_port, "serve a web page with the live picture at this TCP port")
        ->check(CLI::Range(1, 65535));
    CLI::Option* record = run_app->add_option("--record", o.run.record,
                                              "keep what the frames depend on, to replay them bit by bit");
    CLI::Option* replay =
        run_app->add_option("--replay", o.run.replay, "the frames of such a recording once more")
            ->excludes(record);
    run_app->add_flag("--fast", o.run.replay_fast, "replay as fast as it goes, not by the recording's times")
        ->needs(replay);
    run_app->add_flag("--force", o.run.replay_force, "replay a recording of another scenario or version, too")
        ->needs(replay);
    run_app->callback([&] { action = [&] { return run(o); }; });

    CLI::App* recording_app = app.add_subcommand("recording", "what is in a recording, as JSON lines");
    recording_app->add_option("file", o.config, "made by run --record")->required();
    recording_app->callback([&] { action = [&] { return list_of_recording(o); }; });

    CLI::App* render_app = app.add_subcommand("render", "one picture of the first instant");
    add_config(render_app, o);
    add_choice<RenderStage>(*render_app, "--stage", o.stage,
                            {{"radiance", RenderStage::kRadiance},
                             {"electrons", RenderStage::kElectrons},
                             {"frame", RenderStage::kFrame}},
                            "how far light goes: to the lens, into the pixels, out of the converter");
    render_app
        ->add_option("--out", o.files.out,
                     "FILE.exr for radiance and electrons (.fits, too), FILE.png, .tiff, .fits or .raw for a "
                     "frame")
        ->required();
    render_app->add_option("--view", o.files.view,
                           "also write the frame as an 8-bit PNG to look at (docs/pictures.md)");
    render_app->add_option("--time-offset-s", o.time_offset_s, "seconds after the scenario's start");
    render_app->add_option(
        "--truth", o.files.truth,
        "also write what the picture shows to this folder, named after it (docs/truth.md)");
    add_camera(render_app, o);
    render_app->add_flag("--overwrite", o.overwrite,
                         "replace a run's frame, or a truth that is there already");
    render_app->callback([&] { action = [&] { return render(o); }; });

    CLI::App* check_app = app.add_subcommand(
        "check", "validate a scenario and say what it needs; of a camera's file, print its data sheet");
    add_config(check_app, o);
    add_camera(check_app, o);
    auto* const check_json = check_app->add_flag("--json", o.json, "machine-readable");
    add_choice<CalibrationFormat>(*check_app, "--calibration", o.calibration,
                                  {{"opencv", CalibrationFormat::kOpencv},
                                   {"ros", CalibrationFormat::kRos},
                                   {"kalibr", CalibrationFormat::kKalibr}},
                                  "print the cameras' calibration instead (YAML; docs/check.md)")
        ->excludes(check_json);
    check_app->callback([&] { action = [&] { return check(o); }; });

    CLI::App* mesh_app =
        app.add_subcommand("mesh", "how large a mesh file is, what it is made of, what is wrong with it");
    mesh_app->add_option("file", o.config, "GLB, glTF, OBJ, STL or PLY file")->required();
    mesh_app->add_flag("--json", o.json, "machine-readable");
    mesh_app->callback([&] { action = [&] { return survey(o); }; });

    CLI::App* bench_app =
        app.add_subcommand("bench", "measure how fast a scenario runs here, or how far off its frames are");
    add_config(bench_app, o);
    bench_app->add_flag("--json", o.json, "machine-readable");
    bench_app->add_flag("--path-models", o.bench.path_models,
                        "also each path model against bare Embree on the same rays");
    bench_app->add_flag("--sensor", o.sensor, "the sensor stage alone, and what each of its effects costs");
    bench_app->add_option("--frames", o.bench.frames, "frames of a run")->check(CLI::Range(1, 1000000));
    bench_app->add_option("--runs", o.bench.runs, "runs to take the median of")->check(CLI::Range(1, 1000));
    CLI::Option* soak =
        bench_app
            ->add_option("--soak", o.soak.seconds,
                         "for so many seconds at the camera's frame rate: what changes with time, to --out")
            ->check(CLI::PositiveNumber);
    CLI::Option* out =
        bench_app->add_option("--out", o.out, "of --soak: folder for CSV, JSON and a page with a plot");
    soak->needs(out)->excludes("--sensor", "--path-models");
    out->needs(soak);
    bench_app
        ->add_option("--slice-s", o.soak.slice_s,
                     "of --soak: seconds of a slice (default: a sixtieth of the soak, at least 10)")
        ->check(CLI::PositiveNumber)
        ->needs(soak);
    bench_app
        ->add_flag("--outputs", o.soak.outputs, "of --soak: also the scenario's outputs and command ports")
        ->needs(soak);
    CLI::Option* errors =
        bench_app
            ->add_flag(
                "--error", o.error,
                "not how fast but how far off: views around the first object against references, which "
                "are kept in the cache folder")
            ->excludes(soak)
            ->excludes("--sensor", "--path-models", "--frames", "--runs");
    bench_app->add_option("--views", o.error_bench.views, "of --error: how many, evenly around")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str()
        ->needs(errors);
    bench_app
        ->add_option(
            "--reference-frames", o.error_bench.reference.most_frames,
            "of --error, for each view's reference, at most; fewer where its standard error is small "
            "before")
        ->check(power_of_two_from_4())
        ->capture_default_str()
        ->needs(errors);
    bench_app
        ->add_option("--reference-set", o.error_bench.reference_set,
                     "of --error: KEY=VALUE, replaces a value of the references; may be repeated")
        ->allow_extra_args(false)
        ->needs(errors);
    bench_app->callback([&] { action = [&] { return run_bench(o); }; });

    CLI::App* tradeoff_app =
        app.add_subcommand("tradeoff", "measure speed against accuracy over the choices of a scenario");
    add_config(tradeoff_app, o);
    tradeoff_app->add_option("--out", o.out, "folder for CSV, JSON, presets and a page with plots")
        ->required();
    tradeoff_app
        ->add_option("--frame-ms", o.tradeoff.frame_ms,
                     "recommend a setting for this frame time (default: the camera's frame period)")
        ->check(CLI::PositiveNumber);
    tradeoff_app
        ->add_option("--error-sigma", o.tradeoff.error_sigma,
                     "recommend a setting for this error of 99 % of the lit pixels, in their sensor noise")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    tradeoff_app
        ->add_option("--budget-s", o.tradeoff.budget_s,
                     "seconds for the sweep; the reference, which comes before it, takes its own")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    tradeoff_app->add_option("--combinations", o.tradeoff.combinations, "how many to measure, at most")
        ->check(CLI::Range(0, 100000))
        ->capture_default_str();
    tradeoff_app->add_option("--runs", o.tradeoff.runs, "frames of a setting to take the median of")
        ->check(CLI::Range(5, 1000))
        ->capture_default_str();
    tradeoff_app
        ->add_option(
            "--reference-frames", o.tradeoff.reference.most_frames,
            "of the reference: a power of two, this at most; fewer where its standard error is small before")
        ->check(CLI::Range(4, 65536))
        ->capture_default_str();
    tradeoff_app
        ->add_option("--reference-set", o.tradeoff.reference_set,
                     "KEY=VALUE, replaces a value of the reference; may be repeated")
        ->allow_extra_args(false);
    tradeoff_app->callback([&] { action = [&] { return run_tradeoff(o); }; });

    CLI::App* characterise_app =
        app.add_subcommand("characterise", "measure a camera from its own frames (EMVA 1288, ISO 12233)");
    characterise_app->add_option("camera", o.config, "camera file (YAML), or the name of a shipped one")
        ->required()
        ->transform(name_of_shipped());
    characterise_app
        ->add_option("--set", o.overrides, "KEY=VALUE, replaces a value of the camera; may be repeated")
        ->allow_extra_args(false);
    characterise_app->add_flag("--json", o.json, "machine-readable");
    characterise_app->add_option("--out", o.out, "folder for JSON, curves (CSV) and a page with plots");
    characterise_app->callback([&] { action = [&] { return run_characterise(o); }; });

    CLI::App* doctor_app = app.add_subcommand(
        "doctor", "what this machine lacks to run a bench, and what to do; status 1: something CONFIG needs");
    doctor_app
        ->add_option("config", o.config,
                     "scenario file (YAML), or the name of a shipped one; none: nothing is required")
        ->transform(name_of_shipped());
    doctor_app
        ->add_option("--set", o.overrides, "KEY=VALUE, replaces a value of the scenario; may be repeated")
        ->allow_extra_args(false);
    doctor_app->add_flag("--json", o.json, "machine-readable");
    doctor_app->add_flag("--clear-cache", o.clear_cache,
                         "only remove what earlier runs have kept ($HILCAM_CACHE, else ~/.cache/hilcam)");
    doctor_app->callback([&] { action = [&] { return run_doctor(o); }; });

    add_manual_command(app, action);
    add_send_command(app, action);
    add_pages_command(app, action);

    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        if (const std::string what = unknown_subcommand(app); !what.empty()) {
            fmt::print(stderr, "hilcam: {}\n", what);
            return 2;
        }
        // What the library says quotes the command line.
        std::ostringstream help, problem;
        const int status = app.exit(error, help, problem);
        fmt::print("{}", help.str());
        std::istringstream lines(problem.str());
        for (std::string line; std::getline(lines, line);) fmt::print(stderr, "{}\n", harmless(line));
        return status == 0 ? 0 : 2;
    }
    try {
        return action();
    } catch (const InputError& error) {
        spdlog::error("{}", error.what());
        return 2;
    } catch (const std::bad_alloc&) {
        spdlog::error(
            "not enough memory: sensor, spectral bins, meshes or maps ask for more than the machine has, or "
            "than "
            "'ulimit -v' allows");
        return 1;
    } catch (const std::exception& error) {
        spdlog::error("{}", error.what());
        return 1;
    }
}

}  // namespace hilcam
