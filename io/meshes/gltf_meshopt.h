#pragma once
// Decompresses buffer views of glTF's extensions EXT_meshopt_compression and KHR_meshopt_compression.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace hilcam {

// The extension's members beside the bytes.
struct MeshoptLayout {
    std::string mode;    // ATTRIBUTES, TRIANGLES, INDICES
    std::string filter;  // empty or NONE, OCTAHEDRAL, QUATERNION, EXPONENTIAL
    std::uint64_t count = 0, stride_bytes = 0;
};

// Returns count * stride_bytes bytes. Throws InputError, the rest of a sentence that begins with the view's
// name, for an unknown mode or filter and for bytes that do not decode.
std::vector<std::uint8_t> unpack_meshopt(std::span<const std::uint8_t> packed, const MeshoptLayout& layout);

}  // namespace hilcam
