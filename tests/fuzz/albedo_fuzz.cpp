// Any text is a table of albedos that paint a mesh, or refused in one line.

#include <string_view>

#include "io/meshes/albedo_file.h"
#include "render/vocabulary/check.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace hilcam;
    try {
        // An empty input has no address.
        const std::string text(data, data + size);
        const std::vector<float> albedos = parse_albedos(text, "fuzz");
        Mesh mesh;
        mesh.surfaces.resize(1);
        mesh.vertices_m = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
        mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}};
        mesh.surface_of_triangle = {0, 0, 0};
        const double brightest = paint_albedos(mesh, albedos, {}, "fuzz");
        HILCAM_CHECK(brightest >= 0.999);
        for (const Vec2f uv : mesh.uvs) HILCAM_CHECK(uv.x > 0 && uv.x < 1);
    } catch (const InputError& error) {
        HILCAM_CHECK(std::string_view(error.what()).find('\n') == std::string_view::npos);
    }
    return 0;
}
