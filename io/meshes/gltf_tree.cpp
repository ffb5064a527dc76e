#include "io/meshes/gltf_tree.h"

#include <algorithm>
#include <array>
#include <functional>

#include "io/meshes/gltf_accessor.h"
#include "io/meshes/mesh_precheck.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {
namespace {

using Json = GltfDocument::Json;

std::string where_of(std::size_t node) { return "nodes[" + std::to_string(node) + "]"; }

// Reads a node's transform: a matrix, or translation, rotation and scale (glTF 2.0, section 3.5.3).
NodeMatrix own_place(const GltfDocument& document, std::size_t number) {
    const Json& node = document.at("nodes", number);
    const std::string where = where_of(number);
    std::array<float, 16> columns{};
    NodeMatrix out;
    if (document.numbers(node, "matrix", where, columns)) {
        for (std::size_t i = 0; i < 16; ++i) out.row[i % 4][i / 4] = columns[i];
        return out;
    }
    std::array<float, 3> by{};
    std::array<float, 4> turn{};
    if (document.numbers(node, "translation", where, by))
        out = out * NodeMatrix::moved({by[0], by[1], by[2]});
    if (document.numbers(node, "rotation", where, turn)) out = out * NodeMatrix::turned(turn);
    if (document.numbers(node, "scale", where, by)) out = out * NodeMatrix::scaled({by[0], by[1], by[2]});
    return out;
}

bool is_hidden(const Json& node) {
    const Json* const visibility = gltf_extension(node, "KHR_node_visibility");
    const Json* const visible = visibility ? gltf_member(*visibility, "visible") : nullptr;
    return visible && visible->is_boolean() && !visible->get<bool>();
}

std::vector<std::size_t> indices(const GltfDocument& document, const Json* list) {
    std::vector<std::size_t> out;
    if (!list || !list->is_array()) return out;
    for (const Json& index : *list) {
        if (!index.is_number_unsigned() || index.get<std::uint64_t>() >= document.list("nodes").size())
            document.refuse("does not parse: a node is named that does not exist: " + gltf_shown(index));
        out.push_back(static_cast<std::size_t>(index.get<std::uint64_t>()));
    }
    return out;
}

// Returns the transforms of a node's instances, in its own axes.
std::vector<NodeMatrix> instances_of(GltfDocument& document, const Json& node, const std::string& where) {
    const Json* const instancing = gltf_extension(node, "EXT_mesh_gpu_instancing");
    const Json* const attributes = instancing ? gltf_member(*instancing, "attributes") : nullptr;
    if (!attributes) return {};
    std::optional<std::size_t> count;
    const auto read = [&](const char* name, std::size_t width) {
        const auto accessor = document.whole(*attributes, name, where);
        if (!accessor) return GltfNumbers{};
        GltfNumbers numbers = read_gltf_numbers(document, *accessor, width, width, name);
        if (count && *count != numbers.count())
            document.refuse(where + " has instances with " + std::to_string(*count) + " and with " +
                            std::to_string(numbers.count()) + " values");
        count = numbers.count();
        return numbers;
    };
    const GltfNumbers at = read("TRANSLATION", 3), turn = read("ROTATION", 4), scale = read("SCALE", 3);
    std::vector<NodeMatrix> out(count.value_or(0));
    for (std::size_t i = 0; i < out.size(); ++i) {
        if (at.width > 0) out[i] = out[i] * NodeMatrix::moved({at.at(i)[0], at.at(i)[1], at.at(i)[2]});
        if (turn.width > 0) {
            const float* const q = turn.at(i);
            // Quantised quaternions have a length of about one.
            const float size = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
            if (size > 0)
                out[i] = out[i] * NodeMatrix::turned({q[0] / size, q[1] / size, q[2] / size, q[3] / size});
        }
        if (scale.width > 0)
            out[i] = out[i] * NodeMatrix::scaled({scale.at(i)[0], scale.at(i)[1], scale.at(i)[2]});
    }
    return out;
}

class TreeWalk {
  public:
    explicit TreeWalk(GltfDocument& document) : document_(document) {}

    std::vector<GltfNode> walk() {
        std::vector<std::size_t> roots = roots_of_scene();
        if (roots.size() != 1) out_.push_back({"ROOT", 0, document_.list("nodes").size(), {}, {}, {}, {}});
        for (const std::size_t root : roots) add(root, NodeMatrix{}, roots.size() == 1 ? 0 : 1);
        return std::move(out_);
    }

  private:
    GltfDocument& document_;
    std::vector<GltfNode> out_;

    // Returns the roots of the default scene, or of the first; without scenes, all nodes that are no
    // children.
    std::vector<std::size_t> roots_of_scene() {
        const auto scene = document_.whole(document_.root(), "scene", "scene");
        if (!document_.list("scenes").empty())
            return indices(document_, gltf_member(document_.at("scenes", scene.value_or(0)), "nodes"));
        std::vector<std::uint8_t> is_child(document_.list("nodes").size());
        for (const Json& node : document_.list("nodes"))
            for (const std::size_t child : indices(document_, gltf_member(node, "children")))
                is_child[child] = 1;
        std::vector<std::size_t> out;
        for (std::size_t i = 0; i < is_child.size(); ++i)
            if (!is_child[i]) out.push_back(i);
        return out;
    }

    void add(std::size_t number, const NodeMatrix& parent, std::uint32_t depth) {
        const Json& json = document_.at("nodes", number);
        if (is_hidden(json)) return;
        if (out_.size() > kMaxMeshNodes || depth > kDeepestNode)
            document_.refuse("has more than " + std::to_string(kMaxMeshNodes) + " nodes");
        const std::string where = where_of(number);
        const NodeMatrix place = parent * own_place(document_, number);
        GltfNode node;
        node.name = gltf_text(json, "name");
        if (node.name.empty()) node.name = where;
        node.depth = depth, node.number = number;
        node.mesh = document_.whole(json, "mesh", where);
        node.skin = document_.whole(json, "skin", where);
        read_weights(json, node);
        if (gltf_extension(json, "EXT_mesh_gpu_instancing"))
            for (const NodeMatrix& instance : instances_of(document_, json, where))
                node.places.push_back(place * instance);
        else
            node.places.push_back(place);
        out_.push_back(std::move(node));
        for (const std::size_t child : indices(document_, gltf_member(json, "children")))
            add(child, place, depth + 1);
    }

    void read_weights(const Json& json, GltfNode& node) const {
        const Json* const weights = gltf_member(json, "weights");
        if (!weights || !weights->is_array()) return;
        node.weights.resize(weights->size());
        document_.numbers(json, "weights", where_of(node.number), node.weights);
    }
};

}  // namespace

std::vector<GltfNode> shown_nodes(GltfDocument& document) { return TreeWalk(document).walk(); }

std::vector<NodeMatrix> places_of_nodes(const GltfDocument& document) {
    const std::size_t count = document.list("nodes").size();
    std::vector<std::size_t> parent(count, count);
    for (std::size_t i = 0; i < count; ++i)
        for (const std::size_t child : indices(document, gltf_member(document.list("nodes")[i], "children")))
            if (parent[child] == count) parent[child] = i;
    std::vector<NodeMatrix> out(count);
    std::vector<std::uint8_t> known(count);
    for (std::size_t i = 0; i < count; ++i) {
        std::vector<std::size_t> way;
        for (std::size_t at = i; at != count && !known[at]; at = parent[at]) {
            way.push_back(at);
            if (way.size() > count)
                document.refuse("its node " + std::to_string(i) + " is a child of itself");
        }
        for (; !way.empty(); way.pop_back()) {
            const std::size_t at = way.back(), above = parent[at];
            out[at] = above == count ? own_place(document, at) : out[above] * own_place(document, at);
            known[at] = 1;
        }
    }
    return out;
}

}  // namespace hilcam
