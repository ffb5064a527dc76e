// Any text is a shape whose corners are vertices of it, or refused in one line.

#include <string_view>

#include "io/meshes/shape_table.h"
#include "render/vocabulary/check.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace hilcam;
    try {
        const Mesh mesh = read_shape_table({reinterpret_cast<const char*>(data), size}, "fuzz");
        HILCAM_CHECK(!mesh.triangles.empty() && mesh.triangles.size() == mesh.surface_of_triangle.size());
        for (const Vec3f& v : mesh.vertices_m) HILCAM_CHECK(is_finite(to_double(v)));
        for (const auto& triangle : mesh.triangles)
            for (const std::uint32_t index : triangle) HILCAM_CHECK(index < mesh.vertices_m.size());
    } catch (const InputError& error) {
        HILCAM_CHECK(std::string_view(error.what()).find('\n') == std::string_view::npos);
    }
    return 0;
}
