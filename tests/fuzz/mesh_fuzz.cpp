// Any file is a mesh with finite vertices and valid indices, or refused in one line. The kind is told from
// the first bytes.

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "io/meshes/mesh_file.h"
#include "io/meshes/mesh_import.h"
#include "render/vocabulary/check.h"

namespace {
const char* kind_of(std::string_view text) {
    if (text.starts_with("glTF")) return ".glb";
    if (text.starts_with("ply")) return ".ply";
    if (text.starts_with("solid")) return ".stl";
    return text.starts_with("{") ? ".gltf" : ".obj";
}
}  // namespace

// assimp leaks some of what it had read of a file that it then refuses.
extern "C" const char* __lsan_default_suppressions() { return "leak:libassimp\n"; }

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace hilcam;
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    const auto file = std::filesystem::temp_directory_path() /
                      ("hilcam_mesh_fuzz_" + std::to_string(getpid()) + kind_of(text));
    std::ofstream(file, std::ios::binary) << text;
    try {
        const Mesh mesh = load_mesh(file);
        // What a child process survived is read here as well, where the sanitizers and the fuzzer see it.
        NamedFiles files(file);
        HILCAM_CHECK(import_mesh_parts(files, kind_of(text), {}).front().triangles == mesh.triangles);
        HILCAM_CHECK(!mesh.triangles.empty() && mesh.triangles.size() == mesh.surface_of_triangle.size());
        for (const Vec3f& v : mesh.vertices_m) HILCAM_CHECK(is_finite(to_double(v)));
        for (const auto& triangle : mesh.triangles)
            for (const std::uint32_t index : triangle) HILCAM_CHECK(index < mesh.vertices_m.size());
        for (const std::uint16_t surface : mesh.surface_of_triangle)
            HILCAM_CHECK(surface < mesh.surfaces.size());
    } catch (const InputError& error) {
        HILCAM_CHECK(std::string_view(error.what()).find('\n') == std::string_view::npos);
    }
    std::filesystem::remove(file);
    return 0;
}
