// `hilcam characterise`: measures a camera as in a laboratory.

#include <spdlog/fmt/fmt.h>

#include <nlohmann/json.hpp>

#include "emulator/characterise/characterise_report.h"
#include "emulator/scenario/scene_loader.h"
#include "emulator/send/command_examples.h"
#include "emulator/subcommands/arguments.h"
#include "io/config/config_yaml.h"
#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

struct CharacteriseArguments {
    ConfigArguments camera;
    std::filesystem::path out;
    bool json = false;
};

int carry_out(const CharacteriseArguments& o) {
    if (has_top_level_key(o.camera.file, "time_utc"))
        throw InputError(o.camera.file.string() +
                         ": is a scenario; accepted: a camera's data sheet, as cameras/lorri.yaml");
    CameraModel camera;
    read_config(o.camera.file, section_of(camera), o.camera.overrides);
    const DetectorPictures pictures = load_detector_pictures(camera);
    const Characterisation result = characterise(camera, pictures);
    fmt::print("{}\n", o.json ? characterisation_json(result, pictures).dump(2)
                              : characterisation_table(result, pictures));
    if (!o.out.empty()) write_characterisation(result, pictures, o.out);
    return 0;
}

}  // namespace

void add_characterise_command(CLI::App& app, Action& action) {
    auto o = std::make_shared<CharacteriseArguments>();
    CLI::App* command =
        app.add_subcommand("characterise", "measure a camera from its own frames (EMVA 1288, ISO 12233)");
    command->add_option("camera", o->camera.file, "camera file (YAML), or the name of a shipped one")
        ->required()
        ->transform(name_of_shipped());
    add_overrides(command, o->camera.overrides, "the camera");
    command->add_flag("--json", o->json, "machine-readable");
    command->add_option("--out", o->out, "folder for JSON, curves (CSV) and a page with plots");
    set_examples(command, {"hilcam characterise mv_imx249", "hilcam characterise lorri --out lorri_sheet"});
    when_named(command, action, o, carry_out);
}

}  // namespace hilcam
