#include "io/meshes/mesh_precheck.h"

#include <algorithm>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "io/files/text_lines.h"
#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

using nlohmann::json;

[[noreturn]] void refuse(const std::string& name, const std::string& what) {
    throw InputError(name + ": " + what);
}

std::uint64_t little(std::string_view bytes, std::size_t at) {
    std::uint64_t value = 0;
    for (std::size_t i = 4; i-- > 0;) value = value << 8 | static_cast<std::uint8_t>(bytes[at + i]);
    return value;
}

// Counts the nodes at and below each node, and their depth. A value that is not an index is left to the
// reader.
class NodeCounter {
  public:
    NodeCounter(const json& nodes, const std::string& name)
        : nodes_(nodes), name_(name), seen_(nodes.size()) {}

    std::uint64_t count_all(const json& list, std::uint32_t depth) {
        if (depth > kDeepestNode)
            refuse(name_, "its nodes lie deeper than " + std::to_string(kDeepestNode) + " levels");
        std::uint64_t count = 0;
        if (!list.is_array()) return count;
        for (const json& index : list) {
            if (!index.is_number_unsigned() || index.get<std::uint64_t>() >= seen_.size()) continue;
            count += count_at(static_cast<std::size_t>(index.get<std::uint64_t>()), depth);
            if (count > kMaxMeshNodes)
                refuse(name_, "has more than " + std::to_string(kMaxMeshNodes) +
                                  " nodes, each counted as often as another has it as a child");
        }
        return count;
    }

  private:
    struct Seen {
        std::uint64_t count = 0;  // 0: unknown
        bool open = false;        // on the path from the root
    };
    const json& nodes_;
    const std::string& name_;
    std::vector<Seen> seen_;

    std::uint64_t count_at(std::size_t i, std::uint32_t depth) {
        if (seen_[i].open) refuse(name_, "its node " + std::to_string(i) + " is a child of itself");
        if (seen_[i].count > 0) return seen_[i].count;
        seen_[i].open = true;
        const json& node = nodes_[i];
        std::uint64_t count = 1;
        if (node.is_object() && node.contains("children")) count += count_all(node["children"], depth + 1);
        seen_[i] = {count, false};
        return count;
    }
};

}  // namespace

GlbChunks require_glb_chunks(std::string_view glb, const std::string& name) {
    // glTF 2.0 specification, 4.4: header (magic, version, length), then chunks (length, type, data), JSON
    // first; little-endian.
    constexpr std::size_t kHeaderBytes = 12, kChunkHeaderBytes = 8;
    constexpr std::uint64_t kBinary = 0x004E4942;
    if (!glb.starts_with("glTF") || glb.size() < kHeaderBytes + kChunkHeaderBytes)
        refuse(name, "does not parse: it does not begin as a binary glTF");
    GlbChunks out;
    std::size_t at = kHeaderBytes;
    for (int chunk = 0; chunk < 2 && glb.size() - at >= kChunkHeaderBytes; ++chunk) {
        const std::uint64_t size = little(glb, at);
        const std::uint64_t type = little(glb, at + 4);
        const std::uint64_t rest = glb.size() - at - kChunkHeaderBytes;
        if (size > rest)
            refuse(name, "does not parse: its chunk at byte " + std::to_string(at) + " has " +
                             std::to_string(size) + " bytes, and the file has " + std::to_string(rest) +
                             " behind it");
        const std::string_view data = glb.substr(at + kChunkHeaderBytes, size);
        if (chunk == 0) out.json = data;
        if (chunk == 1 && type == kBinary) out.binary = data, out.has_binary = true;
        at += kChunkHeaderBytes + size;
    }
    return out;
}

void require_few_nodes(const json& document, const std::string& name) {
    if (!document.is_object() || !document.contains("nodes") || !document["nodes"].is_array() ||
        !document.contains("scenes") || !document["scenes"].is_array())
        return;
    NodeCounter counter(document["nodes"], name);
    for (const json& scene : document["scenes"])
        if (scene.is_object() && scene.contains("nodes")) counter.count_all(scene["nodes"], 0);
}

void ObjMaterials::add(std::string_view text, const std::string& name) {
    TextLines lines(text, name);
    for (std::string_view line; lines.next(line);) {
        line = trimmed(line);
        if (!line.starts_with("usemtl") && !line.starts_with("newmtl")) continue;
        const std::string_view material = trimmed(line.substr(6));
        if (names_.find(material) != names_.end()) continue;
        names_.emplace(material);
        if (names_.size() > kMaxMaterials) refuse_materials(names_.size(), name);
    }
}

void refuse_textures(const std::vector<std::string>& unreadable, const std::string& name) {
    constexpr std::size_t kLongest = 600;
    if (unreadable.size() == 1) refuse(name, unreadable.front());
    std::string all;
    for (const std::string& one : unreadable)
        if (all.size() < kLongest) all += "; " + one;
    refuse(name,
           std::to_string(unreadable.size()) + " textures cannot be read ('hilcam mesh' lists all)" + all);
}

void refuse_materials(std::size_t found, const std::string& name) {
    refuse(name, "has " + std::to_string(found) + " materials or more; accepted: at most " +
                     std::to_string(kMaxMaterials));
}

}  // namespace hilcam
