#pragma once
// Accessors of a glTF file (glTF 2.0, section 3.6.2): numbers of six types in buffers, with strides,
// normalised integers, and sparse values.

#include <cstdint>
#include <string>
#include <vector>

#include "io/meshes/gltf_document.h"

namespace hilcam {

// The numbers of an accessor, `width` per element.
struct GltfNumbers {
    std::size_t width = 0;
    std::vector<float> values;

    std::size_t count() const { return width == 0 ? 0 : values.size() / width; }
    const float* at(std::size_t element) const { return values.data() + width * element; }
};

// Returns the number of elements. Throws InputError when there is no such accessor.
std::uint64_t gltf_count(const GltfDocument& document, std::uint64_t accessor);
// Reads an accessor with elements of min_width to max_width components. use: what reads it, for messages.
// Throws InputError for another width, and for bytes outside the buffer.
GltfNumbers read_gltf_numbers(GltfDocument& document, std::uint64_t accessor, std::size_t min_width,
                              std::size_t max_width, const std::string& use);
// Reads an accessor of integers, such as indices or joints. width: components of an element.
std::vector<std::uint32_t> read_gltf_wholes(GltfDocument& document, std::uint64_t accessor, std::size_t width,
                                            const std::string& use);

}  // namespace hilcam
