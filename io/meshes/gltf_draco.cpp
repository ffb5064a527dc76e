#include "io/meshes/gltf_draco.h"

#include <draco/compression/decode.h>

#include <memory>

#include "io/meshes/mesh_precheck.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {
namespace {

// Returns the values of an attribute, point by point; normalised integers become fractions.
GltfNumbers numbers_of(const draco::PointAttribute& attribute, std::uint32_t points,
                       const std::string& name) {
    const auto width = static_cast<std::size_t>(attribute.num_components());
    if (width < 1 || width > 4)
        throw InputError("Draco: attribute " + name + " has " + std::to_string(width) +
                         " components; accepted: 1 to 4");
    GltfNumbers out{width, std::vector<float>(width * points)};
    for (std::uint32_t p = 0; p < points; ++p) {
        const draco::AttributeValueIndex value = attribute.mapped_index(draco::PointIndex(p));
        if (value.value() >= attribute.size() ||
            !attribute.ConvertValue<float>(value, static_cast<std::int8_t>(width), &out.values[p * width]))
            throw InputError("Draco: attribute " + name + " has no value for point " + std::to_string(p));
    }
    return out;
}

}  // namespace

DracoPrimitive unpack_draco(std::span<const std::uint8_t> packed,
                            const std::map<std::string, std::uint32_t>& attributes) {
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(packed.data()), packed.size());
    draco::Decoder decoder;
    auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
    if (!decoded.ok())
        throw InputError("its bytes do not decode (Draco: " + shortened(decoded.status().error_msg_string()) +
                         ")");
    const std::unique_ptr<draco::Mesh> mesh = std::move(decoded).value();
    if (mesh->num_faces() > kMaxTriangles)
        throw InputError("Draco: found " + std::to_string(mesh->num_faces()) +
                         " triangles; accepted: at most " + std::to_string(kMaxTriangles));
    DracoPrimitive out;
    out.indices.reserve(std::size_t{3} * mesh->num_faces());
    for (draco::FaceIndex f(0); f < mesh->num_faces(); ++f)
        for (const draco::PointIndex& corner : mesh->face(f)) out.indices.push_back(corner.value());
    for (const auto& [name, id] : attributes) {
        const draco::PointAttribute* const attribute = mesh->GetAttributeByUniqueId(id);
        if (!attribute)
            throw InputError("Draco: there is no attribute number " + std::to_string(id) + " for " +
                             in_quotes(name));
        out.attributes.emplace(name, numbers_of(*attribute, mesh->num_points(), in_quotes(name)));
    }
    return out;
}

}  // namespace hilcam
