#include "emulator/zoo/zoo_entries.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>

#include "emulator/zoo/surface_words.h"
#include "io/meshes/mesh_file.h"
#include "io/system/shipped_parts.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/plain_number.h"

namespace hilcam {
namespace {

constexpr const char* kMeshScenario = "mesh_in_orbit";
constexpr std::array kMeshEndings = {".obj", ".glb", ".gltf", ".stl", ".ply"};

bool is_mesh(const std::filesystem::path& file) {
    return std::find(kMeshEndings.begin(), kMeshEndings.end(), file.extension()) != kMeshEndings.end();
}

// Escapes a text for YAML's single quotes.
std::string yaml_text(const std::string& text) {
    std::string out = "'";
    for (const char c : text) out += c == '\'' ? std::string("''") : std::string(1, c);
    return out + "'";
}

// Replaces the shipped scenario's object by the mesh.
std::string object_override(const std::filesystem::path& file) {
    const MeshContents contents = load_mesh_contents(file);
    std::string surfaces;
    for (const MeshSurface& surface : contents.mesh.surfaces)
        surfaces += fmt::format("{}{{name: {}, material: {}}}", surfaces.empty() ? "" : ", ",
                                yaml_text(surface.name), shipped_material_for(surface));
    return fmt::format("objects=[{{name: target, mesh: {}, materials: {{surfaces: [{}]}}}}]",
                       yaml_text(std::filesystem::absolute(file).string()), surfaces);
}

// Returns overrides that show the same view with fewer pixels.
std::vector<std::string> smaller(const ScenarioSource& source, std::int64_t picture_px) {
    const CameraModel camera = source.load().camera;
    const std::int64_t longer = std::max(camera.width_px, camera.height_px);
    if (longer <= picture_px) return {};
    const double share = static_cast<double>(picture_px) / static_cast<double>(longer);
    const auto side = [&](std::int64_t px) {
        return std::max<std::int64_t>(1, std::llround(share * static_cast<double>(px)));
    };
    return {fmt::format("camera.width_px={}", side(camera.width_px)),
            fmt::format("camera.height_px={}", side(camera.height_px)),
            fmt::format("camera.focal_length_mm={}", plain(camera.focal_length_m * 1e3 * share))};
}

ZooEntry entry_of(const std::filesystem::path& file, const ZooEntriesOptions& options) {
    ScenarioSource source{file, {}};
    if (is_mesh(file)) {
        static const ShippedKind& kind = *shipped_kind("scenarios");
        source.file = shipped_part(kind, kMeshScenario);
        if (source.file.empty())
            throw InputError(
                fmt::format("{}: a mesh stands in the shipped scenario '{}', which is not found; "
                            "'hilcam list scenarios' says where shipped files are",
                            file.string(), kMeshScenario));
        source.overrides = {object_override(file)};
    }
    source.overrides = joined_overrides(source.overrides, smaller(source, options.picture_px));
    source.overrides = joined_overrides(source.overrides, options.overrides);
    return {file.stem().string(), std::move(source)};
}

}  // namespace

std::vector<ZooEntry> zoo_entries(const std::filesystem::path& folder, const ZooEntriesOptions& options) {
    std::vector<std::filesystem::path> files;
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(folder, error))
        if (entry.is_regular_file(error) && (entry.path().extension() == ".yaml" || is_mesh(entry.path())))
            files.push_back(entry.path());
    std::erase_if(files, [](const std::filesystem::path& file) {
        std::filesystem::path scenario = file;
        std::error_code none;
        return is_mesh(file) && std::filesystem::exists(scenario.replace_extension(".yaml"), none);
    });
    if (files.empty())
        throw InputError(
            fmt::format("--zoo: found no scenario and no mesh in '{}'; accepted: a folder with *.yaml, "
                        "*.obj, *.glb, *.gltf, *.stl or *.ply",
                        folder.string()));
    std::sort(files.begin(), files.end());
    std::vector<ZooEntry> entries;
    for (const std::filesystem::path& file : files) entries.push_back(entry_of(file, options));
    return entries;
}

}  // namespace hilcam
