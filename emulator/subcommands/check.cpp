// `hilcam check`: what a scenario needs and why; a camera's data sheet; calibrations.

#include <spdlog/fmt/fmt.h>

#include <array>

#include "emulator/check/calibration.h"
#include "emulator/check/check_command.h"
#include "emulator/progress/progress.h"
#include "emulator/send/choice_option.h"
#include "emulator/send/command_examples.h"
#include "emulator/subcommands/arguments.h"
#include "emulator/subcommands/scenario_use.h"
#include "io/config/config_yaml.h"

namespace hilcam {
namespace {

struct CheckArguments {
    ConfigArguments config;
    std::size_t camera = 0;  // from 1; 0: all cameras
    bool json = false;
    bool strict = false;  // true: warnings count as failures
    CalibrationFormat calibration = CalibrationFormat::kNone;
};

std::string calibrations(const CheckArguments& o) {
    if (is_camera_file(o.config.file)) {
        CameraModel camera;
        read_config(o.config.file, section_of(camera), o.config.overrides);
        return calibration_text(std::array{calibration_of(camera)}, o.calibration);
    }
    const ScenarioConfig scenario = load_and_warn(o.config);
    require_camera(o.camera, scenario);
    return calibration_text(calibrations_of(scenario, o.camera), o.calibration);
}

Checked sheet_of_scenario(const CheckArguments& o) {
    const ScenarioConfig scenario = load_scenario(o.config.file, o.config.overrides);
    require_camera(o.camera, scenario);
    const CheckReport report = in_memory(scenario, [&] {
        const Progress progress("check " + scenario.name);
        return check_scenario(scenario, o.camera);
    });
    return {o.json ? to_json(report) : to_text(report), !report.warnings.empty()};
}

int carry_out(const CheckArguments& o) {
    if (o.calibration != CalibrationFormat::kNone) {
        fmt::print("{}", calibrations(o));
        return 0;
    }
    const Checked found = is_camera_file(o.config.file)
                              ? check_camera(o.config.file, o.config.overrides, o.json)
                              : sheet_of_scenario(o);
    fmt::print("{}", found.text);
    return o.strict && found.has_warnings ? 1 : 0;
}

}  // namespace

void add_check_command(CLI::App& app, Action& action) {
    auto o = std::make_shared<CheckArguments>();
    CLI::App* check = app.add_subcommand(
        "check", "validate a scenario and list its needs; for a camera file, print its data sheet");
    add_config(check, o->config);
    add_camera(check, o->camera);
    CLI::Option* json = check->add_flag("--json", o->json, "machine-readable");
    check->add_flag("--strict", o->strict, "end with status 1 when there are warnings, for scripts");
    add_choice<CalibrationFormat>(*check, "--calibration", o->calibration,
                                  {{"opencv", CalibrationFormat::kOpencv},
                                   {"ros", CalibrationFormat::kRos},
                                   {"kalibr", CalibrationFormat::kKalibr}},
                                  "print the cameras' calibration instead (YAML; docs/check.md)")
        ->excludes(json);
    set_examples(check, {"hilcam check geo_inspection", "hilcam check lorri",
                         "hilcam check stereo --camera 2 --calibration opencv"});
    when_named(check, action, o, carry_out);
}

}  // namespace hilcam
