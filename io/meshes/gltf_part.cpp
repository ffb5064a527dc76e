#include "io/meshes/gltf_part.h"

#include <algorithm>
#include <cmath>

#include "io/meshes/gltf_draco.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {
namespace {

using Json = GltfDocument::Json;

enum class Mode : std::uint64_t { kTriangles = 4, kStrip = 5, kFan = 6 };

constexpr const char* kDraco = "KHR_draco_mesh_compression";

std::optional<Mode> mode_of(const GltfDocument& document, const Json& primitive) {
    const std::uint64_t mode = document.whole(primitive, "mode", "primitive").value_or(4);
    if (mode > 6)
        document.refuse("does not parse: primitive: mode: found " + std::to_string(mode) +
                        "; accepted: 0 to 6");
    if (mode < 4) return {};
    return static_cast<Mode>(mode);
}

std::optional<std::uint64_t> attribute(const GltfDocument& document, const Json& primitive,
                                       const std::string& name) {
    const Json* const all = gltf_member(primitive, "attributes");
    return all ? document.whole(*all, name.c_str(), "attributes") : std::nullopt;
}

class PartReader {
  public:
    PartReader(GltfDocument& document, const Json& primitive, GltfLooks& looks, std::string name)
        : document_(document), primitive_(primitive), looks_(looks), name_(std::move(name)) {}

    GltfPart read(std::span<const float> weights) {
        out_.surface = looks_.surface_of(material_of(document_, primitive_));
        unpack();
        read_vertices();
        read_colors();
        morph(weights);
        read_joints();
        read_triangles();
        drop_unused();
        return std::move(out_);
    }

  private:
    GltfDocument& document_;
    const Json& primitive_;
    GltfLooks& looks_;
    std::string name_;
    std::optional<DracoPrimitive> draco_;
    GltfPart out_;

    [[noreturn]] void refuse(const std::string& what) const {
        document_.refuse("part " + in_quotes(name_) + " " + what);
    }

    void unpack() {
        const Json* const packed = gltf_extension(primitive_, kDraco);
        if (!packed) return;
        std::map<std::string, std::uint32_t> ids;
        if (const Json* const attributes = gltf_member(*packed, "attributes");
            attributes && attributes->is_object())
            for (const auto& [name, id] : attributes->items())
                ids[name] =
                    static_cast<std::uint32_t>(document_.required_whole(*attributes, name.c_str(), kDraco));
        const GltfBytes bytes = document_.view(document_.required_whole(*packed, "bufferView", kDraco));
        try {
            draco_ = unpack_draco(bytes, ids);
        } catch (const InputError& error) {
            document_.refuse("does not parse: part " + in_quotes(name_) + ": " + error.what());
        }
    }

    // Returns an attribute by its name; nothing when it is missing.
    std::optional<GltfNumbers> numbers(const std::string& name, std::size_t least, std::size_t most) {
        if (draco_)
            if (const auto found = draco_->attributes.find(name); found != draco_->attributes.end()) {
                if (found->second.width < least || found->second.width > most)
                    refuse("has an attribute " + in_quotes(name) + " of " +
                           std::to_string(found->second.width) + " components");
                return std::move(found->second);
            }
        const auto accessor = attribute(document_, primitive_, name);
        if (!accessor) return {};
        GltfNumbers out = read_gltf_numbers(document_, *accessor, least, most, name);
        require_length(out.count(), name);
        return out;
    }
    void require_length(std::size_t count, const std::string& name) const {
        if (!out_.places.empty() && count != out_.places.size())
            refuse("has " + std::to_string(out_.places.size()) + " vertices and " + std::to_string(count) +
                   " values of " + in_quotes(name));
    }

    static std::vector<Vec3f> vectors(const GltfNumbers& from) {
        std::vector<Vec3f> out(from.count());
        for (std::size_t i = 0; i < out.size(); ++i) out[i] = {from.at(i)[0], from.at(i)[1], from.at(i)[2]};
        return out;
    }

    void read_vertices() {
        const auto places = numbers("POSITION", 3, 3);
        if (!places || places->count() == 0) refuse("has no POSITION");
        out_.places = vectors(*places);
        if (const auto normals = numbers("NORMAL", 3, 3)) {
            require_length(normals->count(), "NORMAL");
            out_.normals = vectors(*normals);
        }
        const auto& place = looks_.places[out_.surface];
        if (!place) return;
        const auto uvs = numbers("TEXCOORD_" + std::to_string(place->uv_set), 2, 2);
        if (!uvs) {
            looks_.left_out.add(
                "places on the texture (TEXCOORD_" + std::to_string(place->uv_set) + "), which are missing,",
                name_);
            return;
        }
        require_length(uvs->count(), "TEXCOORD");
        for (std::size_t i = 0; i < uvs->count(); ++i) {
            const Vec2f uv = place->of({uvs->at(i)[0], uvs->at(i)[1]});
            out_.uvs.push_back(std::isfinite(uv.x) && std::isfinite(uv.y) ? uv : Vec2f{});
        }
    }

    // Reads linear factors on the colours of the surface (glTF 2.0, section 3.9.2).
    void read_colors() {
        const auto colors = numbers("COLOR_0", 3, 4);
        if (!colors) return;
        require_length(colors->count(), "COLOR_0");
        bool any = false, clear = false;
        const auto share = [](float v) { return v >= 0 ? std::min(v, 1.0f) : 0.0f; };
        for (std::size_t i = 0; i < colors->count(); ++i) {
            const float* const c = colors->at(i);
            out_.colors.push_back({share(c[0]), share(c[1]), share(c[2])});
            any = any || !(out_.colors.back() == Vec3f{1, 1, 1});
            clear = clear || (colors->width == 4 && c[3] < 1);
        }
        if (clear) looks_.left_out.add("alpha of vertex colours", name_);
        // White colours, which many writers add, have no effect.
        if (!any) out_.colors.clear();
    }

    void morph(std::span<const float> weights) {
        const Json* const targets = gltf_member(primitive_, "targets");
        if (!targets || !targets->is_array()) return;
        for (std::size_t t = 0; t < std::min(weights.size(), targets->size()); ++t) {
            if (weights[t] == 0) continue;
            move(out_.places, (*targets)[t], "POSITION", weights[t]);
            if (!out_.normals.empty()) move(out_.normals, (*targets)[t], "NORMAL", weights[t]);
            for (const char* other : {"TEXCOORD_0", "TEXCOORD_1", "COLOR_0"})
                if (gltf_member((*targets)[t], other))
                    looks_.left_out.add("morph of " + std::string(other), name_);
        }
    }
    void move(std::vector<Vec3f>& values, const Json& target, const char* name, float weight) {
        const auto accessor = document_.whole(target, name, "targets");
        if (!accessor) return;
        const GltfNumbers by = read_gltf_numbers(document_, *accessor, 3, 3, "morph target");
        require_length(by.count(), name);
        for (std::size_t i = 0; i < values.size(); ++i)
            values[i] = values[i] + weight * Vec3f{by.at(i)[0], by.at(i)[1], by.at(i)[2]};
    }

    void read_joints() {
        for (int set = 0;; ++set) {
            const auto joints = attribute(document_, primitive_, "JOINTS_" + std::to_string(set));
            if (!joints) return;
            auto weights = numbers("WEIGHTS_" + std::to_string(set), 4, 4);
            if (!weights) return;
            if (draco_ && draco_->attributes.contains("JOINTS_" + std::to_string(set)))
                out_.joints.push_back(whole(*numbers("JOINTS_" + std::to_string(set), 4, 4)));
            else
                out_.joints.push_back(read_gltf_wholes(document_, *joints, 4, "JOINTS"));
            require_length(out_.joints.back().size() / 4, "JOINTS");
            require_length(weights->count(), "WEIGHTS");
            out_.weights.push_back(std::move(*weights));
        }
    }
    static std::vector<std::uint32_t> whole(const GltfNumbers& numbers) {
        std::vector<std::uint32_t> out;
        for (const float v : numbers.values)
            out.push_back(v >= 0 && v < 65536 ? static_cast<std::uint32_t>(v) : 65536);
        return out;
    }

    std::vector<std::uint32_t> corners() {
        if (draco_) return std::move(draco_->indices);
        if (const auto accessor = document_.whole(primitive_, "indices", "primitive"))
            return read_gltf_wholes(document_, *accessor, 1, "indices");
        std::vector<std::uint32_t> out(out_.places.size());
        for (std::uint32_t i = 0; i < out.size(); ++i) out[i] = i;
        return out;
    }

    // Reads triangles; in strips, every other triangle is reversed (glTF 2.0, section 3.7.2.1).
    void read_triangles() {
        const std::vector<std::uint32_t> v = corners();
        const Mode mode = draco_ ? Mode::kTriangles : mode_of(document_, primitive_).value();
        const std::size_t step = mode == Mode::kTriangles ? 3 : 1;
        for (std::size_t i = 0; i + 2 < v.size(); i += step) {
            const bool odd = mode == Mode::kStrip && i % 2 == 1;
            const std::array<std::uint32_t, 3> t = {mode == Mode::kFan ? v[0] : v[i], v[i + (odd ? 2 : 1)],
                                                    v[i + (odd ? 1 : 2)]};
            if (std::max({t[0], t[1], t[2]}) >= out_.places.size())
                document_.refuse("triangle " + std::to_string(out_.triangles.size()) + " of part " +
                                 in_quotes(name_) + " names a vertex that does not exist");
            out_.triangles.push_back(t);
        }
    }

    // Primitives may share vertices of which each uses some.
    void drop_unused() {
        constexpr std::uint32_t kNone = ~std::uint32_t{0};
        std::vector<std::uint32_t> to(out_.places.size(), kNone);
        for (const auto& t : out_.triangles)
            for (const std::uint32_t v : t) to[v] = 0;
        std::uint32_t count = 0;
        for (std::uint32_t& place : to)
            if (place != kNone) place = count++;
        if (count == to.size()) return;
        const auto keep = [&](auto& values, std::size_t width) {
            if (values.empty()) return;
            for (std::size_t i = 0; i < to.size(); ++i)
                for (std::size_t k = 0; k < width && to[i] != kNone; ++k)
                    values[to[i] * width + k] = values[i * width + k];
            values.resize(count * width);
        };
        keep(out_.places, 1), keep(out_.normals, 1), keep(out_.colors, 1), keep(out_.uvs, 1);
        for (auto& joints : out_.joints) keep(joints, 4);
        for (GltfNumbers& weights : out_.weights) keep(weights.values, 4);
        for (auto& t : out_.triangles)
            for (std::uint32_t& v : t) v = to[v];
    }
};

}  // namespace

std::uint64_t count_triangles(const GltfDocument& document, const Json& primitive) {
    const auto mode = mode_of(document, primitive);
    if (!mode) return 0;
    auto accessor = document.whole(primitive, "indices", "primitive");
    if (!accessor) accessor = attribute(document, primitive, "POSITION");
    const std::uint64_t corners = accessor ? gltf_count(document, *accessor) : 0;
    if (*mode == Mode::kTriangles) return corners / 3;
    return corners < 3 ? 0 : corners - 2;
}

std::optional<std::uint64_t> material_of(const GltfDocument& document, const Json& primitive) {
    return document.whole(primitive, "material", "primitive");
}

GltfPart read_gltf_part(GltfDocument& document, const Json& primitive, std::span<const float> weights,
                        GltfLooks& looks, const std::string& name) {
    return PartReader(document, primitive, looks, name).read(weights);
}

}  // namespace hilcam
