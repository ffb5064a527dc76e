// `hilcam mesh`: what a mesh file holds, and what is wrong with it.

#include <spdlog/fmt/fmt.h>

#include <cstdio>
#include <optional>

#include "emulator/check/mesh_survey.h"
#include "emulator/send/command_examples.h"
#include "emulator/subcommands/arguments.h"
#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

struct MeshArguments {
    std::filesystem::path file;
    std::optional<int> surface;
    bool json = false;
};

int carry_out(const MeshArguments& o) {
    const MeshSurvey found = survey_mesh(load_mesh_contents(o.file, o.surface), o.file.string());
    fmt::print("{}", o.json ? to_json(found) : to_text(found));
    if (found.unreadable_textures.empty()) return 0;
    std::fflush(stdout);  // prints the list before the message
    throw InputError(
        fmt::format("{}: {} of its textures cannot be read (they are listed under 'problems'); accepted: "
                    "textures that are there and decode",
                    o.file.string(), found.unreadable_textures.size()));
}

}  // namespace

void add_mesh_command(CLI::App& app, Action& action) {
    auto o = std::make_shared<MeshArguments>();
    CLI::App* mesh =
        app.add_subcommand("mesh", "report the size, the contents and the faults of a mesh file");
    mesh->add_option(
            "file", o->file,
            "GLB, glTF, OBJ, STL or PLY file, a shape (.tab, .plt, .icq, .bds), or a shipped one's name")
        ->required()
        ->transform(name_of_shipped(*shipped_kind("meshes")));
    mesh->add_option("--surface", o->surface, "code of the surface, of a shape kernel (.bds) with several");
    mesh->add_flag("--json", o->json, "machine-readable");
    set_examples(mesh, {"hilcam mesh asteroid", "hilcam mesh corner_mirrors --json"});
    when_named(mesh, action, o, carry_out);
}

}  // namespace hilcam
