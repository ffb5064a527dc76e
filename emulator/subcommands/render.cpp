// `hilcam render`: makes one picture.

#include <spdlog/spdlog.h>

#include <algorithm>

#include "emulator/check/scenario_verdict.h"
#include "emulator/progress/progress.h"
#include "emulator/recording/run_seed.h"
#include "emulator/run/render_command.h"
#include "emulator/run/still_camera.h"
#include "emulator/scenario/scene_loader.h"
#include "emulator/send/choice_option.h"
#include "emulator/send/command_examples.h"
#include "emulator/subcommands/arguments.h"
#include "emulator/subcommands/scenario_use.h"

namespace hilcam {
namespace {

struct RenderArguments {
    ConfigArguments config;
    RenderFiles files;
    PictureStage stage = PictureStage::kFrame;
    double time_offset_s = 0;
    std::size_t camera = 0;  // from 1; 0: not given
};

// Called before minutes go into a picture that would be black.
void log_picture_verdict(StillCamera& camera) {
    const LoadedView view{camera.scenario(), camera.renderer(), camera.objects()};
    log_warnings(verdict_on_objects(view, VerdictOn::kPicture));
    log_warnings(report_scenario_maps(view.scenario).doubts);
    camera.renderer().place_for_truth(camera.world());
    log_warnings(verdict_on_view(view.scenario, report_view(view, 1, camera.world().camera)));
}

int carry_out(const RenderArguments& o) {
    ScenarioConfig scenario = load_scenario(o.config.file, o.config.overrides);
    const auto threads = limit_threads(scenario);
    require_camera(o.camera, scenario);
    log_info(settle_seed(scenario));
    log_warnings(early_verdict(scenario, VerdictOn::kPicture));
    if (o.camera == 0 && !scenario.more_cameras.empty())
        spdlog::info("camera 1 of {}; --camera N for another", 1 + scenario.more_cameras.size());
    const Progress progress("render " + scenario.name);
    if (o.files.out.empty() && !o.files.pixel)
        throw InputError("render: --out is missing; accepted: --out FILE, --pixel X Y, or both");
    return in_memory(scenario, [&] {
        const std::size_t camera = std::max<std::size_t>(1, o.camera);
        render_to_files(scenario, o.stage, o.time_offset_s, o.files, camera, log_picture_verdict);
        if (o.stage == PictureStage::kFrame && o.files.view.empty() && !o.files.out.empty())
            log_warning(dark_picture_warning(o.files.out,
                                             scenario_of_camera(scenario, camera - 1).camera.frame_bits(),
                                             "--view FILE.png writes one to look at"));
        return 0;
    });
}

}  // namespace

void add_render_command(CLI::App& app, Action& action) {
    auto o = std::make_shared<RenderArguments>();
    CLI::App* render = app.add_subcommand("render", "make one picture of the first instant");
    add_config(render, o->config);
    add_choice<PictureStage>(
        *render, "--stage", o->stage,
        {{"radiance", PictureStage::kRadiance},
         {"electrons", PictureStage::kElectrons},
         {"frame", PictureStage::kFrame}},
        "last stage: light at the lens, electrons in the pixels, or the converter's output");
    render->add_option(
        "--out", o->files.out,
        "FILE.exr for radiance and electrons (.fits, too), FILE.png, .tiff, .fits or .raw for a "
        "frame");
    render->add_flag(
        "--parts", o->files.parts,
        "with --stage radiance: the parts of the light as layers of the file (docs/pictures.md)");
    render
        ->add_option_function<std::vector<int>>(
            "--pixel",
            [o](const std::vector<int>& at) {
                o->files.pixel = {at[0], at[1]};
            },
            "X Y: say what this pixel of the frame is made of: parts of the light, surfaces, electrons")
        ->expected(2)
        ->type_name("X Y");
    render->add_option("--view", o->files.view,
                       "also write the frame as an 8-bit PNG to look at (docs/pictures.md)");
    render->add_option("--time-offset-s", o->time_offset_s, "seconds after the scenario's start");
    render->add_option("--truth", o->files.truth,
                       "also write what the picture shows to this folder, named after it (docs/truth.md)");
    add_camera(render, o->camera);
    render->add_flag("--overwrite", o->files.overwrite,
                     "replace a run's frame, or a truth that is there already");
    set_examples(render, {"hilcam render small --out small.png --view small_view.png",
                          "hilcam render moon_flyby --time-offset-s 600 --out moon.png",
                          "hilcam render small --set quality=still --stage radiance --out small.exr",
                          "hilcam render small --stage radiance --parts --out small_parts.exr",
                          "hilcam render small --pixel 320 240"});
    when_named(render, action, o, carry_out);
}

}  // namespace hilcam
