#include "io/files/gltf_webp.h"

#include <cstring>
#include <nlohmann/json.hpp>
#include <string>

namespace hilcam {
namespace {

using nlohmann::json;

// glTF 2.0 specification, 4.4: header (magic, version, length), then chunks (length, type, data);
// little-endian.
constexpr std::uint32_t kMagic = 0x46546C67;      // "glTF"
constexpr std::uint32_t kJsonChunk = 0x4E4F534A;  // "JSON"
constexpr std::size_t kGlbHeaderBytes = 12;
constexpr std::size_t kChunkHeaderBytes = 8;

std::uint32_t read_u32(std::span<const std::uint8_t> bytes, std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i) value |= std::uint32_t{bytes[at + i]} << (8 * i);
    return value;
}
void append_u32(std::vector<std::uint8_t>& bytes, std::size_t value) {
    for (std::size_t i = 0; i < 4; ++i) bytes.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}

bool move_sources(json& document) {
    bool changed = false;
    for (json& texture : document["textures"]) {
        const json::json_pointer source("/extensions/EXT_texture_webp/source");
        if (!texture.is_object() || texture.contains("source") || !texture.contains(source)) continue;
        texture["source"] = texture.at(source);
        changed = true;
    }
    return changed;
}

}  // namespace

std::optional<std::vector<std::uint8_t>> with_plain_webp_sources(std::span<const std::uint8_t> glb) {
    constexpr std::size_t kTextAt = kGlbHeaderBytes + kChunkHeaderBytes;
    if (glb.size() < kTextAt || read_u32(glb, 0) != kMagic || read_u32(glb, 16) != kJsonChunk) return {};
    const std::size_t text_bytes = read_u32(glb, 12);
    if (text_bytes > glb.size() - kTextAt) return {};
    const auto text = glb.subspan(kTextAt, text_bytes);
    json document = json::parse(text.begin(), text.end(), nullptr, false);
    if (!document.is_object() || !document.contains("textures") || !document["textures"].is_array() ||
        !move_sources(document))
        return {};
    std::string changed = document.dump();
    changed.resize((changed.size() + 3) / 4 * 4, ' ');
    const auto rest = glb.subspan(kTextAt + text_bytes);
    std::vector<std::uint8_t> out;
    out.reserve(kTextAt + changed.size() + rest.size());
    append_u32(out, kMagic);
    append_u32(out, read_u32(glb, 4));
    append_u32(out, kTextAt + changed.size() + rest.size());
    append_u32(out, changed.size());
    append_u32(out, kJsonChunk);
    out.insert(out.end(), changed.begin(), changed.end());
    out.insert(out.end(), rest.begin(), rest.end());
    return out;
}

}  // namespace hilcam
