#include "io/meshes/gltf_import.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "io/meshes/gltf_document.h"
#include "io/meshes/gltf_looks.h"
#include "io/meshes/gltf_part.h"
#include "io/meshes/gltf_tree.h"
#include "io/meshes/mesh_precheck.h"
#include "io/meshes/node_names.h"
#include "io/meshes/surface_cutter.h"
#include "io/system/confined.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {
namespace {

using Json = GltfDocument::Json;

// Returns the joints of a skin as transforms from the mesh's axes to the file's.
std::vector<NodeMatrix> joints_of(GltfDocument& document, std::uint64_t skin,
                                  const std::vector<NodeMatrix>& places) {
    const std::string where = "skins[" + std::to_string(skin) + "]";
    const Json& json = document.at("skins", skin);
    const Json* const joints = gltf_member(json, "joints");
    GltfNumbers inverse;
    if (const auto accessor = document.whole(json, "inverseBindMatrices", where))
        inverse = read_gltf_numbers(document, *accessor, 16, 16, "inverseBindMatrices");
    std::vector<NodeMatrix> out;
    for (std::size_t i = 0; joints && joints->is_array() && i < joints->size(); ++i) {
        const Json& node = (*joints)[i];
        if (!node.is_number_unsigned() || node.get<std::uint64_t>() >= places.size())
            document.refuse("does not parse: " + where + " names a joint that does not exist");
        NodeMatrix back;
        if (i < inverse.count())
            for (std::size_t k = 0; k < 16; ++k) back.row[k % 4][k / 4] = inverse.at(i)[k];
        out.push_back(places[static_cast<std::size_t>(node.get<std::uint64_t>())] * back);
    }
    return out;
}

// Returns the weighted mean of a vertex's joints; nothing when it has none.
std::optional<NodeMatrix> blended(const GltfPart& part, std::size_t vertex,
                                  const std::vector<NodeMatrix>& joints) {
    NodeMatrix sum;
    for (auto& row : sum.row) row.fill(0);
    float all = 0;
    for (std::size_t set = 0; set < part.joints.size(); ++set)
        for (std::size_t k = 0; k < 4; ++k) {
            const float weight = part.weights[set].at(vertex)[k];
            const std::uint32_t joint = part.joints[set][4 * vertex + k];
            if (!(weight > 0) || joint >= joints.size()) continue;
            all += weight;
            for (std::size_t i = 0; i < 3; ++i)
                for (std::size_t c = 0; c < 4; ++c) sum.row[i][c] += weight * joints[joint].row[i][c];
        }
    if (!(all > 0)) return {};
    for (std::size_t i = 0; i < 3; ++i)
        for (float& value : sum.row[i]) value /= all;
    sum.row[3] = {0, 0, 0, 1};
    return sum;
}

class GltfImport {
  public:
    GltfImport(NamedFiles& files, const std::string& kind)
        : document_(files, kind), nodes_(shown_nodes(document_)), looks_(document_, named_materials()) {
        name_what_is_no_surface();
        read_parts();
        require_few_triangles();
    }

    // Returns the mesh of the nodes that names[part] matches, or that none matches if part is -1.
    Mesh mesh_of(std::span<const std::string> names, int part, std::vector<MeshNode>* found,
                 std::uint64_t* collapsed) {
        mesh_ = {};
        mesh_.surfaces = looks_.surfaces;
        collapsed_ = 0;
        std::vector<int> above;  // part of the node at each depth
        for (std::size_t i = 0; i < nodes_.size(); ++i) {
            const GltfNode& node = nodes_[i];
            above.resize(node.depth);
            const int own = taken_by(names, node.name);
            above.push_back(own >= 0 || above.empty() ? own : above.back());
            const std::size_t before = mesh_.triangles.size();
            if (above.back() == part) place(i);
            if (found) found->push_back({node.name, node.depth, mesh_.triangles.size() - before});
        }
        if (mesh_.triangles.empty()) refuse_empty(names, part);
        cut();
        if (collapsed) *collapsed = collapsed_;
        mesh_.textures = looks_.textures;
        mesh_.left_out = looks_.left_out.lines();
        return std::move(mesh_);
    }

    const std::vector<std::string>& unreadable_textures() const { return looks_.unreadable; }

  private:
    GltfDocument document_;
    std::vector<GltfNode> nodes_;
    GltfLooks looks_;
    // Identifies primitives with triangles, by mesh and, if it has weights of its own, by node.
    using PartKey = std::pair<std::uint64_t, std::size_t>;
    std::map<PartKey, std::vector<GltfPart>> parts_;
    std::map<std::uint64_t, std::vector<NodeMatrix>> joints_;
    bool any_normals_ = false, any_uvs_ = false, any_colors_ = false;
    Mesh mesh_;
    std::uint64_t collapsed_ = 0;

    const Json& primitives_of(std::uint64_t mesh) const {
        const Json* const found = gltf_member(document_.at("meshes", mesh), "primitives");
        static const Json none = Json::array();
        return found && found->is_array() ? *found : none;
    }
    PartKey key_of(const GltfNode& node) const {
        return {*node.mesh, node.weights.empty() ? document_.list("nodes").size() : node.number};
    }

    // Returns the materials in the order in which nodes show them, a node's descendants before itself.
    std::vector<GltfLooks::Named> named_materials() const {
        std::vector<GltfLooks::Named> out;
        std::map<std::uint64_t, std::size_t> place;
        std::vector<const GltfNode*> open;  // the path from the root
        const auto close_to = [&](std::size_t depth) {
            for (; open.size() > depth; open.pop_back()) name_materials_of(*open.back(), place, out);
        };
        for (const GltfNode& node : nodes_) {
            close_to(node.depth);
            open.push_back(&node);
        }
        close_to(0);
        return out;
    }
    void name_materials_of(const GltfNode& node, std::map<std::uint64_t, std::size_t>& place,
                           std::vector<GltfLooks::Named>& out) const {
        if (!node.mesh || node.places.empty()) return;
        for (const Json& primitive : primitives_of(*node.mesh)) {
            const auto material = material_of(document_, primitive);
            if (!material) continue;
            const auto [found, is_new] = place.try_emplace(*material, out.size());
            if (is_new) out.push_back({*material, false});
            out[found->second].has_triangles |= count_triangles(document_, primitive) > 0;
        }
    }

    void name_what_is_no_surface() {
        if (!document_.list("animations").empty()) looks_.left_out.add("animation (the mesh is at rest)", "");
        if (gltf_extension(document_.root(), "KHR_lights_punctual")) looks_.left_out.add("lights", "");
    }

    void read_parts() {
        std::uint64_t triangles = 0;
        for (const GltfNode& node : nodes_) {
            if (!node.mesh || node.places.empty() || parts_.contains(key_of(node))) continue;
            const Json& mesh = document_.at("meshes", *node.mesh);
            const std::string name = gltf_text(mesh, "name").empty()
                                         ? "meshes[" + std::to_string(*node.mesh) + "]"
                                         : gltf_text(mesh, "name");
            std::vector<float> weights = node.weights;
            if (const Json* const own = gltf_member(mesh, "weights");
                weights.empty() && own && own->is_array()) {
                weights.resize(own->size());
                document_.numbers(mesh, "weights", name, weights);
            }
            std::vector<GltfPart>& parts = parts_[key_of(node)];
            for (const Json& primitive : primitives_of(*node.mesh)) {
                const std::uint64_t count = count_triangles(document_, primitive);
                if (count == 0) looks_.left_out.add("points and lines", name);
                if (count == 0) continue;
                require_count(triangles += count);
                allow_more(kBytesPerTriangle * count, 1e-6 * static_cast<double>(count));
                parts.push_back(read_gltf_part(document_, primitive, weights, looks_, name));
                any_normals_ |= !parts.back().normals.empty();
                any_uvs_ |= !parts.back().uvs.empty();
                any_colors_ |= !parts.back().colors.empty();
            }
        }
    }
    void require_count(std::uint64_t triangles) const {
        if (triangles > kMaxTriangles)
            document_.refuse("has " + std::to_string(triangles) + " triangles; accepted: at most " +
                             std::to_string(kMaxTriangles));
    }
    // Counts triangles as nodes and instances place them.
    void require_few_triangles() const {
        std::uint64_t triangles = 0;
        for (const GltfNode& node : nodes_) {
            if (!node.mesh || node.places.empty()) continue;
            for (const GltfPart& part : parts_.at(key_of(node)))
                require_count(triangles += node.places.size() * part.triangles.size());
        }
        allow_more(kBytesPerTriangle * triangles, 1e-6 * static_cast<double>(triangles));
    }

    [[noreturn]] void refuse_empty(std::span<const std::string> names, int part) const {
        std::vector<std::string> all;
        for (const GltfNode& node : nodes_) all.push_back(node.name);
        document_.refuse(empty_part(names, part, all));
    }

    void place(std::size_t number) {
        const GltfNode& node = nodes_[number];
        if (!node.mesh || node.places.empty()) return;
        for (const GltfPart& part : parts_.at(key_of(node))) {
            require_finite(part, node);
            // Joints place a skin, wherever its node is (glTF 2.0, section 3.7.3.2).
            if (node.skin && !part.joints.empty())
                add_skinned(part, node);
            else
                for (const NodeMatrix& at : node.places) add(part, node, at);
        }
    }
    void require_finite(const GltfPart& part, const GltfNode& node) const {
        for (std::size_t i = 0; i < part.places.size(); ++i)
            if (!is_finite(to_double(part.places[i])))
                document_.refuse("vertex " + std::to_string(i) + " of a part of node " +
                                 in_quotes(node.name) + " is not finite");
    }

    void add(const GltfPart& part, const GltfNode& node, const NodeMatrix& at) {
        const auto base = static_cast<std::uint32_t>(mesh_.vertices_m.size());
        const NodeMatrix of_normals = at.of_normals();
        for (std::size_t i = 0; i < part.places.size(); ++i) add_vertex(part, i, node, at, of_normals);
        add_triangles(part, base, at.determinant() < 0);
    }
    void add_skinned(const GltfPart& part, const GltfNode& node) {
        auto joints = joints_.find(*node.skin);
        if (joints == joints_.end())
            joints = joints_.emplace(*node.skin, joints_of(document_, *node.skin, places_of_nodes(document_)))
                         .first;
        const auto base = static_cast<std::uint32_t>(mesh_.vertices_m.size());
        bool mirrored = false;
        for (std::size_t i = 0; i < part.places.size(); ++i) {
            const NodeMatrix at = blended(part, i, joints->second).value_or(node.places.front());
            mirrored = mirrored || at.determinant() < 0;
            add_vertex(part, i, node, at, at.of_normals());
        }
        add_triangles(part, base, mirrored);
    }

    void add_vertex(const GltfPart& part, std::size_t i, const GltfNode& node, const NodeMatrix& at,
                    const NodeMatrix& of_normals) {
        const Vec3f p = at.place(part.places[i]);
        if (!is_finite(to_double(p)))
            document_.refuse("a part of node " + in_quotes(node.name) +
                             " is not finite once its node places it");
        mesh_.vertices_m.push_back(p);
        if (any_uvs_) mesh_.uvs.push_back(part.uvs.empty() ? Vec2f{} : part.uvs[i]);
        if (any_colors_) mesh_.colors.push_back(part.colors.empty() ? Vec3f{1, 1, 1} : part.colors[i]);
        if (any_normals_)
            mesh_.normals.push_back(part.normals.empty() ? Vec3f{} : of_normals.turn_normal(part.normals[i]));
    }

    void add_triangles(const GltfPart& part, std::uint32_t base, bool mirrored) {
        for (std::array<std::uint32_t, 3> t : part.triangles) {
            const auto at = [&](std::size_t corner) { return mesh_.vertices_m[base + t[corner]]; };
            if (at(0) == at(1) || at(1) == at(2) || at(0) == at(2)) {
                ++collapsed_;
                continue;
            }
            if (mirrored) std::swap(t[1], t[2]);
            for (std::uint32_t& index : t) index += base;
            mesh_.triangles.push_back(t);
            mesh_.surface_of_triangle.push_back(static_cast<std::uint16_t>(part.surface));
        }
    }

    void cut() {
        if (looks_.cuts.empty()) return;
        mesh_.uvs.resize(mesh_.vertices_m.size());
        const int halvings = cut_mesh(mesh_, looks_.cuts);
        if (halvings > 0)
            looks_.left_out.add("detail of masks and metallic-roughness textures finer than " +
                                    std::to_string(1 << std::min(halvings, 20)) + " texels",
                                "");
        if (mesh_.triangles.empty()) document_.refuse("holds no triangle that its masks leave");
    }
};

}  // namespace

MeshContents gltf_contents(NamedFiles& files, const std::string& kind) {
    GltfImport import(files, kind);
    MeshContents out;
    out.mesh = import.mesh_of({}, -1, &out.nodes, &out.collapsed_triangles);
    out.unreadable_textures = import.unreadable_textures();
    out.remarks = files.remarks();
    return out;
}

std::vector<Mesh> gltf_parts(NamedFiles& files, const std::string& kind, std::span<const std::string> nodes) {
    GltfImport import(files, kind);
    if (!import.unreadable_textures().empty())
        refuse_textures(import.unreadable_textures(), files.mesh().string());
    std::vector<Mesh> meshes;
    for (int part = -1; part < static_cast<int>(nodes.size()); ++part)
        meshes.push_back(import.mesh_of(nodes, part, nullptr, nullptr));
    return meshes;
}

}  // namespace hilcam
