#pragma once
// Accessors of a glTF file (glTF 2.0, section 3.6.2): numbers of six types in buffers, with strides, as fractions where they are
// normalised, and with values of their own at some places (sparse).

#include <cstdint>
#include <string>
#include <vector>

#include "io/meshes/gltf_document.h"

namespace hilcam {

// Numbers of an accessor, `width` to an element.
struct GltfNumbers {
    std::size_t width = 0;
    std::vector<float> values;

    std::size_t count() const { return width == 0 ? 0 : values.size() / width; }
    const float* at(std::size_t element) const { return values.data() + width * element; }
};

// Returns how many elements an accessor has. InputError where there is no such accessor.
std::uint64_t gltf_count(const GltfDocument& document, std::uint64_t accessor);
// Reads an accessor whose elements have so many components at least and at most; `use` names what reads it in messages.
// InputError for another, and for bytes that do not lie in its buffer.
GltfNumbers read_gltf_numbers(GltfDocument& document, std::uint64_t accessor, std::size_t min_width,
                              std::size_t max_width, const std::string& use);
// Reads an accessor of whole numbers: indices, joints. `width`: components of an element.
std::vector<std::uint32_t> read_gltf_wholes(GltfDocument& document, std::uint64_t accessor, std::size_t width,
                                            const std::string& use);

}  // namespace hilcam
