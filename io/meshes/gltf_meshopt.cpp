#include "io/meshes/gltf_meshopt.h"

#include <meshoptimizer.h>

#include "render/vocabulary/check.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {
namespace {

// The library asserts its requirements on strides: see the extension's tables of modes and filters.
void require_stride(const MeshoptLayout& l, bool good, const char* accepted) {
    if (!good)
        throw InputError("byteStride: found " + std::to_string(l.stride_bytes) + " with mode " +
                         in_quotes(l.mode) + "; accepted: " + accepted);
}

int decode(std::span<const std::uint8_t> packed, const MeshoptLayout& l, std::vector<std::uint8_t>& out) {
    if (l.mode == "ATTRIBUTES") {
        require_stride(l, l.stride_bytes > 0 && l.stride_bytes % 4 == 0 && l.stride_bytes <= 256,
                       "a multiple of 4, to 256");
        return meshopt_decodeVertexBuffer(out.data(), l.count, l.stride_bytes, packed.data(), packed.size());
    }
    if (l.mode != "TRIANGLES" && l.mode != "INDICES")
        throw InputError("compression: found mode " + in_quotes(l.mode) +
                         "; accepted: ATTRIBUTES, TRIANGLES, INDICES");
    require_stride(l, l.stride_bytes == 2 || l.stride_bytes == 4, "2, 4");
    if (l.mode == "INDICES")
        return meshopt_decodeIndexSequence(out.data(), l.count, l.stride_bytes, packed.data(), packed.size());
    if (l.count % 3 != 0)
        throw InputError("compression: found " + std::to_string(l.count) +
                         " indices of triangles; accepted: a multiple of 3");
    return meshopt_decodeIndexBuffer(out.data(), l.count, l.stride_bytes, packed.data(), packed.size());
}

void unfilter(const MeshoptLayout& l, std::vector<std::uint8_t>& out) {
    if (l.filter.empty() || l.filter == "NONE") return;
    if (l.filter == "OCTAHEDRAL") {
        require_stride(l, l.stride_bytes == 4 || l.stride_bytes == 8, "4, 8 with filter OCTAHEDRAL");
        meshopt_decodeFilterOct(out.data(), l.count, l.stride_bytes);
    } else if (l.filter == "QUATERNION") {
        require_stride(l, l.stride_bytes == 8, "8 with filter QUATERNION");
        meshopt_decodeFilterQuat(out.data(), l.count, l.stride_bytes);
    } else if (l.filter == "EXPONENTIAL") {
        require_stride(l, l.stride_bytes > 0 && l.stride_bytes % 4 == 0,
                       "a multiple of 4 with filter EXPONENTIAL");
        meshopt_decodeFilterExp(out.data(), l.count, l.stride_bytes);
    } else {
        throw InputError("compression: found filter " + in_quotes(l.filter) +
                         "; accepted: NONE, OCTAHEDRAL, QUATERNION, EXPONENTIAL");
    }
}

}  // namespace

std::vector<std::uint8_t> unpack_meshopt(std::span<const std::uint8_t> packed, const MeshoptLayout& layout) {
    // Filters process four elements at a time.
    std::vector<std::uint8_t> out(layout.count * layout.stride_bytes);
    if (layout.count == 0) return out;
    if (decode(packed, layout, out) != 0)
        throw InputError("its compressed bytes do not decode (meshoptimizer: broken, or of a newer version)");
    unfilter(layout, out);
    return out;
}

}  // namespace hilcam
