// Any bytes are a shape kernel whose corners are vertices of it, or refused in one line.

#include <string_view>

#include "io/meshes/dsk_shape.h"
#include "render/vocabulary/check.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace hilcam;
    const std::string bytes(data, data + size);
    try {
        for (const DskSegment& segment : dsk_segments(bytes, "fuzz")) try {
                const Mesh mesh = read_dsk_shape(bytes, "fuzz", segment.surface);
                HILCAM_CHECK(!mesh.triangles.empty() &&
                             mesh.triangles.size() == mesh.surface_of_triangle.size());
                for (const Vec3f& v : mesh.vertices_m) HILCAM_CHECK(is_finite(to_double(v)));
                for (const auto& triangle : mesh.triangles)
                    for (const std::uint32_t index : triangle) HILCAM_CHECK(index < mesh.vertices_m.size());
            } catch (const InputError& error) {
                HILCAM_CHECK(std::string_view(error.what()).find('\n') == std::string_view::npos);
            }
    } catch (const InputError& error) {
        HILCAM_CHECK(std::string_view(error.what()).find('\n') == std::string_view::npos);
    }
    return 0;
}
