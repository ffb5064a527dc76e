#include "tools/make_spacecraft/glb.h"

#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace spacecraft {
namespace {

using nlohmann::json;

struct Look {
    const char* name;
    std::array<double, 3> color;  // linear RGB
    double metallic, roughness;
};
// Plausible colours for viewers; a hilcam scenario replaces them by materials with reflectance curves.
constexpr Look kLooks[] = {
    {"mli_gold", {0.83, 0.55, 0.20}, 1, 0.35},
    {"mli_silver", {0.85, 0.85, 0.85}, 1, 0.35},
    {"mli_black", {0.03, 0.03, 0.03}, 0, 0.5},
    {"tape", {0.75, 0.5, 0.2}, 1, 0.45},
    {"white_paint", {0.8, 0.8, 0.78}, 0, 0.9},
    {"osr", {0.9, 0.9, 0.92}, 1, 0.06},
    {"aluminium", {0.78, 0.78, 0.8}, 1, 0.4},
    {"nozzle", {0.12, 0.11, 0.1}, 1, 0.5},
    {"dish_white", {0.75, 0.75, 0.73}, 0, 0.7},
    {"panel_back", {0.04, 0.04, 0.04}, 0, 0.4},
    {"cfrp", {0.05, 0.05, 0.05}, 0, 0.35},
    {"solar_cell", {0.02, 0.03, 0.09}, 0, 0.12},
    {"cell_substrate", {0.35, 0.22, 0.08}, 0, 0.6},
    {"busbar", {0.8, 0.8, 0.8}, 1, 0.3},
    {"baffle_black", {0.02, 0.02, 0.02}, 0, 0.8},
    // Those of other kinds, by the shipped materials' names.
    {"aluminium_bare", {0.9, 0.91, 0.92}, 1, 0.45},
    {"anodised_clear", {0.73, 0.73, 0.74}, 1, 0.55},
    {"black_anodised", {0.04, 0.04, 0.04}, 0, 0.8},
    {"black_paint", {0.03, 0.03, 0.03}, 0, 0.75},
    {"gold", {0.97, 0.78, 0.41}, 1, 0.15},
    {"mli_kapton", {0.76, 0.62, 0.1}, 1, 0.42},
    {"mli_silvered", {0.96, 0.97, 0.96}, 1, 0.3},
};

json material_of(const std::string& name) {
    const auto* look =
        std::find_if(std::begin(kLooks), std::end(kLooks), [&](const Look& l) { return name == l.name; });
    if (look == std::end(kLooks)) throw std::runtime_error("no look for material " + name);
    return {{"name", name},
            {"pbrMetallicRoughness",
             {{"baseColorFactor", {look->color[0], look->color[1], look->color[2], 1.0}},
              {"metallicFactor", look->metallic},
              {"roughnessFactor", look->roughness}}}};
}

class Writer {
  public:
    explicit Writer(const Parts& parts) {
        document_ = {{"asset", {{"version", "2.0"}, {"generator", "hilcam-make-spacecraft"}}},
                     {"scene", 0},
                     {"scenes", json::array({{{"nodes", json::array()}}})},
                     {"nodes", json::array()},
                     {"meshes", json::array()},
                     {"materials", json::array()},
                     {"accessors", json::array()},
                     {"bufferViews", json::array()}};
        std::map<std::string, std::size_t> materials;
        for (const auto& [part, surfaces] : parts) {
            json primitives = json::array();
            for (const auto& [material, surface] : surfaces) {
                const auto [known, is_new] = materials.try_emplace(material, materials.size());
                if (is_new) document_["materials"].push_back(material_of(material));
                primitives.push_back(primitive(surface, known->second));
            }
            document_["scenes"][0]["nodes"].push_back(document_["nodes"].size());
            document_["nodes"].push_back({{"name", part}, {"mesh", document_["meshes"].size()}});
            document_["meshes"].push_back({{"name", part}, {"primitives", primitives}});
        }
        document_["buffers"] = json::array({{{"byteLength", bytes_}}});
    }

    void write(std::ostream& out) const {
        std::string text = document_.dump();
        text.resize((text.size() + 3) / 4 * 4, ' ');
        put_u32(out, 0x46546C67);
        put_u32(out, 2);
        put_u32(out, 12 + 8 + text.size() + 8 + bytes_);
        put_u32(out, text.size());
        put_u32(out, 0x4E4F534A);
        out << text;
        put_u32(out, bytes_);
        put_u32(out, 0x004E4942);
        for (const auto& [data, size] : blocks_)
            out.write(static_cast<const char*>(data), static_cast<std::streamsize>(size));
    }

  private:
    json document_;
    std::vector<std::pair<const void*, std::size_t>> blocks_;
    std::size_t bytes_ = 0;

    // Every array is of 4-byte numbers, so all views stay aligned.
    template <class T>
    std::size_t view(const std::vector<T>& data, int target) {
        const std::size_t size = data.size() * sizeof(T);
        document_["bufferViews"].push_back(
            {{"buffer", 0}, {"byteOffset", bytes_}, {"byteLength", size}, {"target", target}});
        blocks_.emplace_back(data.data(), size);
        bytes_ += size;
        return document_["bufferViews"].size() - 1;
    }
    std::size_t accessor(json value) {
        document_["accessors"].push_back(std::move(value));
        return document_["accessors"].size() - 1;
    }

    json primitive(const Surface& s, std::size_t material) {
        constexpr int kFloat = 5126, kUnsignedInt = 5125, kArrayBuffer = 34962, kElementBuffer = 34963;
        Vec3f low = s.positions.front(), high = low;
        for (const Vec3f& p : s.positions) {
            low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
            high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
        }
        const auto positions = accessor({{"bufferView", view(s.positions, kArrayBuffer)},
                                         {"componentType", kFloat},
                                         {"count", s.positions.size()},
                                         {"type", "VEC3"},
                                         {"min", {low.x, low.y, low.z}},
                                         {"max", {high.x, high.y, high.z}}});
        const auto normals = accessor({{"bufferView", view(s.normals, kArrayBuffer)},
                                       {"componentType", kFloat},
                                       {"count", s.normals.size()},
                                       {"type", "VEC3"}});
        const auto indices = accessor({{"bufferView", view(s.triangles, kElementBuffer)},
                                       {"componentType", kUnsignedInt},
                                       {"count", 3 * s.triangles.size()},
                                       {"type", "SCALAR"}});
        return {{"attributes", {{"POSITION", positions}, {"NORMAL", normals}}},
                {"indices", indices},
                {"material", material}};
    }

    static void put_u32(std::ostream& out, std::size_t value) {
        for (int i = 0; i < 4; ++i) out.put(static_cast<char>(value >> (8 * i) & 0xFF));
    }
};

}  // namespace

void write_glb(const std::filesystem::path& file, const Parts& parts) {
    const Writer writer(parts);
    const std::filesystem::path partial = file.string() + ".partial" + std::to_string(getpid());
    {
        std::ofstream out(partial, std::ios::binary);
        writer.write(out);
        if (!out.flush()) {
            std::filesystem::remove(partial);
            throw std::runtime_error(partial.string() +
                                     ": cannot be written; is the disk full, or the folder read-only?");
        }
    }
    std::filesystem::rename(partial, file);
}

}  // namespace spacecraft
