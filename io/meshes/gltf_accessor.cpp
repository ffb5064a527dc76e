#include "io/meshes/gltf_accessor.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <string_view>
#include <utility>

#include "io/meshes/mesh_precheck.h"
#include "io/system/confined.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {
namespace {

using Json = GltfDocument::Json;

// Types of components (glTF 2.0, section 3.6.2.2).
enum class Component : std::uint64_t {
    kByte = 5120,
    kUnsignedByte = 5121,
    kShort = 5122,
    kUnsignedShort = 5123,
    kUnsignedInt = 5125,
    kFloat = 5126,
};

std::size_t size_bytes(Component c) {
    switch (c) {
        case Component::kByte:
        case Component::kUnsignedByte:
            return 1;
        case Component::kShort:
        case Component::kUnsignedShort:
            return 2;
        case Component::kUnsignedInt:
        case Component::kFloat:
            return 4;
    }
    return 0;
}

template <class T>
T read_as(const std::uint8_t* from) {
    T value;
    std::memcpy(&value, from, sizeof value);
    return value;
}

// Returns a normalised integer as a fraction of the greatest of its type; signed ones end at -1 (section
// 3.6.2.2).
template <class T>
float fraction(T value) {
    return std::max(-1.0f, static_cast<float>(value) / static_cast<float>(std::numeric_limits<T>::max()));
}

template <class T>
float whole_or_fraction(const std::uint8_t* from, bool normalized) {
    const T value = read_as<T>(from);
    return normalized ? fraction(value) : static_cast<float>(value);
}

float number_at(const std::uint8_t* from, Component type, bool normalized) {
    switch (type) {
        case Component::kByte:
            return whole_or_fraction<std::int8_t>(from, normalized);
        case Component::kUnsignedByte:
            return whole_or_fraction<std::uint8_t>(from, normalized);
        case Component::kShort:
            return whole_or_fraction<std::int16_t>(from, normalized);
        case Component::kUnsignedShort:
            return whole_or_fraction<std::uint16_t>(from, normalized);
        case Component::kUnsignedInt:
            return whole_or_fraction<std::uint32_t>(from, normalized);
        case Component::kFloat:
            return read_as<float>(from);
    }
    return 0;
}

std::uint32_t whole_at(const std::uint8_t* from, Component type) {
    if (type == Component::kUnsignedByte) return *from;
    return type == Component::kUnsignedShort ? read_as<std::uint16_t>(from) : read_as<std::uint32_t>(from);
}

bool is_index(Component type) {
    return type == Component::kUnsignedByte || type == Component::kUnsignedShort ||
           type == Component::kUnsignedInt;
}

// An accessor with its members checked.
class Accessor {
  public:
    Accessor(GltfDocument& document, std::uint64_t index, std::string use)
        : document_(document),
          json_(document.at("accessors", index)),
          where_("accessors[" + std::to_string(index) + "] (" + std::move(use) + ")"),
          count_(document.required_whole(json_, "count", where_)),
          type_(component(json_)) {
        constexpr std::array<std::pair<std::string_view, std::size_t>, 7> kWidths = {
            {{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT2", 4}, {"MAT3", 9}, {"MAT4", 16}}};
        const std::string name = gltf_text(json_, "type");
        for (const auto& [known, width] : kWidths)
            if (name == known) width_ = width;
        if (width_ == 0) refuse("type: found " + in_quotes(name) + "; accepted: SCALAR, VEC2 to VEC4, MAT4");
        // No mesh needs more than three corners per triangle.
        if (count_ > 3 * kMaxTriangles)
            refuse("count: found " + std::to_string(count_) + "; accepted: at most " +
                   std::to_string(3 * kMaxTriangles));
        const Json* const normalized = gltf_member(json_, "normalized");
        normalized_ = normalized && normalized->is_boolean() && normalized->get<bool>();
    }

    std::size_t width() const { return width_; }
    Component type() const { return type_; }
    [[noreturn]] void refuse(const std::string& what) const {
        document_.refuse("does not parse: " + where_ + ": " + what);
    }

    // Calls take(component, its bytes) for all components of all elements, then again for those that are
    // given sparsely. Elements without data are left unchanged.
    template <class Take>
    void visit(const Take& take) {
        if (gltf_member(json_, "bufferView")) visit_view(json_, type_, count_, width_, true, take);
        if (const Json* const sparse = gltf_member(json_, "sparse")) visit_sparse(*sparse, take);
    }
    bool normalized() const { return normalized_; }
    // Returns how many numbers it has. More memory is requested only if a view has bytes for them, because
    // zeros take no space in the file.
    std::uint64_t values() const {
        if (gltf_member(json_, "bufferView")) allow_more(4 * count_ * width_, 0);
        return count_ * width_;
    }

  private:
    GltfDocument& document_;
    const Json& json_;
    std::string where_;
    std::uint64_t count_;
    Component type_;
    std::size_t width_ = 0;
    bool normalized_ = false;

    Component component(const Json& of) const {
        const auto type = static_cast<Component>(document_.required_whole(of, "componentType", where_));
        if (size_bytes(type) == 0)
            refuse("componentType: found " + std::to_string(static_cast<std::uint64_t>(type)) +
                   "; accepted: 5120 to 5123, 5125, 5126");
        return type;
    }

    // `of` names a view and an offset in it. strided: uses the view's own stride.
    template <class Take>
    void visit_view(const Json& of, Component type, std::uint64_t count, std::size_t width, bool strided,
                    const Take& take) {
        const std::uint64_t index = document_.required_whole(of, "bufferView", where_);
        const GltfBytes bytes = document_.view(index);
        const std::uint64_t from = document_.whole(of, "byteOffset", where_).value_or(0),
                            element = width * size_bytes(type);
        std::uint64_t stride = element;
        if (strided)
            stride = document_.whole(document_.at("bufferViews", index), "byteStride", where_).value_or(0);
        if (stride == 0) stride = element;
        if (stride < element || stride > 65535) refuse("byteStride: found " + std::to_string(stride));
        if (count > 0 && (from > bytes.size() || (count - 1) * stride + element > bytes.size() - from))
            refuse("its " + std::to_string(count) + " elements do not lie in bufferViews[" +
                   std::to_string(index) + "], which has " + std::to_string(bytes.size()) + " bytes");
        for (std::uint64_t i = 0; i < count; ++i)
            for (std::size_t k = 0; k < width; ++k)
                take(i * width + k, bytes.data() + from + i * stride + k * size_bytes(type));
    }

    template <class Take>
    void visit_sparse(const Json& sparse, const Take& take) {
        const std::uint64_t count = document_.required_whole(sparse, "count", where_);
        const Json* const indices = gltf_member(sparse, "indices");
        const Json* const values = gltf_member(sparse, "values");
        if (!indices || !values || count > count_) refuse("sparse: it wants indices and values, at most all");
        const Component type = component(*indices);
        if (!is_index(type)) refuse("sparse: its indices are no whole numbers");
        std::vector<std::uint64_t> places(count);
        visit_view(*indices, type, count, 1, false, [&](std::uint64_t i, const std::uint8_t* from) {
            places[i] = whole_at(from, type);
            if (places[i] >= count_)
                refuse("sparse: index " + std::to_string(places[i]) + " is beyond its end");
        });
        visit_view(*values, type_, count, width_, false, [&](std::uint64_t i, const std::uint8_t* from) {
            take(places[i / width_] * width_ + i % width_, from);
        });
    }
};

}  // namespace

std::uint64_t gltf_count(const GltfDocument& document, std::uint64_t accessor) {
    return document.required_whole(document.at("accessors", accessor), "count",
                                   "accessors[" + std::to_string(accessor) + "]");
}

GltfNumbers read_gltf_numbers(GltfDocument& document, std::uint64_t index, std::size_t min_width,
                              std::size_t max_width, const std::string& use) {
    Accessor accessor(document, index, use);
    if (accessor.width() < min_width || accessor.width() > max_width)
        accessor.refuse("found " + std::to_string(accessor.width()) +
                        " components; accepted: " + std::to_string(min_width) +
                        (min_width == max_width ? "" : " to " + std::to_string(max_width)));
    GltfNumbers out{accessor.width(), std::vector<float>(accessor.values())};
    accessor.visit([&](std::uint64_t at, const std::uint8_t* from) {
        out.values[at] = number_at(from, accessor.type(), accessor.normalized());
    });
    return out;
}

std::vector<std::uint32_t> read_gltf_wholes(GltfDocument& document, std::uint64_t index, std::size_t width,
                                            const std::string& use) {
    Accessor accessor(document, index, use);
    if (accessor.width() != width || !is_index(accessor.type()))
        accessor.refuse("found components that are no whole numbers without a sign, or not " +
                        std::to_string(width));
    std::vector<std::uint32_t> out(accessor.values());
    accessor.visit(
        [&](std::uint64_t at, const std::uint8_t* from) { out[at] = whole_at(from, accessor.type()); });
    return out;
}

}  // namespace hilcam
