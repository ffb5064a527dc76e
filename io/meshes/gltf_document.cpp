#include "io/meshes/gltf_document.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include "io/meshes/data_uri.h"
#include "io/meshes/gltf_meshopt.h"
#include "io/meshes/mesh_import.h"
#include "io/meshes/mesh_precheck.h"
#include "io/system/confined.h"
#include "io/system/input_file.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {
namespace {

using Json = GltfDocument::Json;

// The required extensions that this reader supports, by their names in Khronos' registry.
constexpr std::array<std::string_view, 12> kObeyed = {
    "EXT_mesh_gpu_instancing",    "EXT_meshopt_compression", "EXT_texture_webp",
    "KHR_draco_mesh_compression", "KHR_materials_ior",       "KHR_materials_pbrSpecularGlossiness",
    "KHR_materials_variants",     "KHR_mesh_quantization",   "KHR_meshopt_compression",
    "KHR_node_visibility",        "KHR_texture_transform",   "KHR_xmp_json_ld"};

const Json& empty_list() {
    static const Json list = Json::array();
    return list;
}

std::string place(const char* list, std::uint64_t index) {
    return std::string(list) + "[" + std::to_string(index) + "]";
}

}  // namespace

const Json* gltf_member(const Json& object, const char* name) {
    if (!object.is_object()) return nullptr;
    const auto found = object.find(name);
    return found == object.end() ? nullptr : &*found;
}

const Json* gltf_extension(const Json& object, const char* name) {
    const Json* const all = gltf_member(object, "extensions");
    const Json* const found = all ? gltf_member(*all, name) : nullptr;
    return found && found->is_object() ? found : nullptr;
}

std::string gltf_text(const Json& object, const char* name) {
    const Json* const found = gltf_member(object, name);
    return found && found->is_string() ? found->get<std::string>() : std::string();
}

std::string gltf_shown(const Json& value) {
    if (value.is_structured()) return std::string("an ") + value.type_name();
    return in_quotes(value.dump());
}

GltfDocument::GltfDocument(NamedFiles& files, const std::string& kind)
    : files_(files), bytes_(read_input_file(files.mesh(), mesh_kind())) {
    std::string_view text = bytes_;
    if (kind == ".glb") {
        const GlbChunks chunks = require_glb_chunks(bytes_, file().string());
        text = chunks.json;
        has_binary_ = chunks.has_binary;
        binary_ = {reinterpret_cast<const std::uint8_t*>(chunks.binary.data()), chunks.binary.size()};
    }
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);  // byte-order mark
    root_ = Json::parse(text.begin(), text.end(), nullptr, false);
    if (!root_.is_object()) refuse("does not parse: it is no JSON object");
    const Json* const asset = gltf_member(root_, "asset");
    if (const std::string version = asset ? gltf_text(*asset, "version") : ""; !version.starts_with("2"))
        refuse("does not parse: found version " + in_quotes(version) + " in its asset; accepted: glTF 2");
    require_extensions();
    require_few_nodes(root_, file().string());
    if (list("materials").size() > kMaxMaterials) refuse_materials(list("materials").size(), file().string());
}

void GltfDocument::refuse(const std::string& what) const { throw InputError(file().string() + ": " + what); }

void GltfDocument::require_extensions() const {
    for (const Json& name : list("extensionsRequired")) {
        const std::string text = name.is_string() ? name.get<std::string>() : gltf_shown(name);
        if (std::find(kObeyed.begin(), kObeyed.end(), text) != kObeyed.end()) continue;
        std::string all;
        for (const std::string_view obeyed : kObeyed) all.append(all.empty() ? "" : " ").append(obeyed);
        refuse("extensionsRequired: found " + in_quotes(text) + "; accepted: " + all);
    }
}

const Json& GltfDocument::list(const char* name) const {
    const Json* const found = gltf_member(root_, name);
    return found && found->is_array() ? *found : empty_list();
}

const Json& GltfDocument::at(const char* name, std::uint64_t index) const {
    const Json& all = list(name);
    if (index >= all.size() || !all[index].is_object())
        refuse("does not parse: " + place(name, index) + ": there is none, and something names it");
    return all[index];
}

std::optional<std::uint64_t> GltfDocument::whole(const Json& object, const char* key,
                                                 const std::string& where) const {
    const Json* const found = gltf_member(object, key);
    if (!found) return {};
    // Some writers have 4.0 for 4.
    const double number = found->is_number() ? found->get<double>() : -1;
    if (!(number >= 0 && number <= 9e15 && number == std::floor(number)))
        refuse("does not parse: " + where + ": " + key + ": found " + gltf_shown(*found) +
               "; accepted: a whole number");
    return static_cast<std::uint64_t>(number);
}

std::uint64_t GltfDocument::required_whole(const Json& object, const char* key,
                                           const std::string& where) const {
    const auto found = whole(object, key, where);
    if (!found) refuse("does not parse: " + where + ": it has no " + key);
    return *found;
}

bool GltfDocument::number(const Json& object, const char* key, const std::string& where, float& out) const {
    const Json* const found = gltf_member(object, key);
    if (!found) return false;
    const auto value = found->is_number() ? found->get<float>() : std::nanf("");
    if (!std::isfinite(value))
        refuse("does not parse: " + where + ": " + key + ": found " + gltf_shown(*found) +
               "; accepted: a finite number");
    out = value;
    return true;
}

bool GltfDocument::numbers(const Json& object, const char* key, const std::string& where,
                           std::span<float> out) const {
    const Json* const found = gltf_member(object, key);
    if (!found) return false;
    bool good = found->is_array() && found->size() == out.size();
    for (std::size_t i = 0; good && i < out.size(); ++i) {
        good = (*found)[i].is_number();
        if (good) out[i] = (*found)[i].get<float>();
        good = good && std::isfinite(out[i]);
    }
    if (!good)
        refuse("does not parse: " + where + ": " + key + ": found " + gltf_shown(*found) +
               "; accepted: " + std::to_string(out.size()) + " finite numbers");
    return true;
}

std::string GltfDocument::bytes_at(const std::string& uri, const InputKind& kind,
                                   const std::string& what) const {
    if (const auto data = decoded_data_uri(uri)) return *data;
    if (uri.starts_with("data:")) throw InputError(what + " does not parse: its data are no base64");
    // Tries the decoded URI, then the URI itself, which some writers mean.
    std::optional<std::filesystem::path> found = files_.find({without_percents(uri), {}}, what);
    if (!found) found = files_.find({uri, {}}, what);
    if (!found)
        throw InputError(what + " is missing; expected at " +
                         (file().parent_path() / without_percents(uri)).string());
    std::string bytes;
    try {
        bytes = read_input_file(*found, kind);
    } catch (const InputError& fault) {
        throw InputError(what + ": " + fault.what());
    }
    allow_more(kMeshMemoryPerByte * bytes.size(), kMeshCpu_s_byte * static_cast<double>(bytes.size()));
    return bytes;
}

GltfBytes GltfDocument::buffer(std::uint64_t index) {
    const Json& buffer = at("buffers", index);
    const std::string uri = gltf_text(buffer, "uri");
    if (uri.empty()) {
        if (index == 0 && has_binary_) return binary_;
        refuse("does not parse: " + place("buffers", index) + ": it has no uri" +
               (index == 0 ? ", and the file has no binary chunk" : ""));
    }
    auto found = buffers_.find(index);
    if (found == buffers_.end()) {
        const std::string what = place("buffers", index) + " " + in_quotes(uri.substr(0, uri.find(',')));
        try {
            found = buffers_.emplace(index, bytes_at(uri, mesh_kind(), what)).first;
        } catch (const InputError& fault) {
            refuse(fault.what());
        }
    }
    return {reinterpret_cast<const std::uint8_t*>(found->second.data()), found->second.size()};
}

GltfBytes GltfDocument::part_of_buffer(const Json& of, const std::string& where) {
    const GltfBytes all = buffer(required_whole(of, "buffer", where));
    const std::uint64_t from = whole(of, "byteOffset", where).value_or(0),
                        bytes = required_whole(of, "byteLength", where);
    if (from > all.size() || bytes > all.size() - from)
        refuse("does not parse: " + where + ": its " + std::to_string(bytes) + " bytes from byte " +
               std::to_string(from) + " on do not lie in its buffer of " + std::to_string(all.size()));
    return all.subspan(from, bytes);
}

GltfBytes GltfDocument::view(std::uint64_t index) {
    const Json& view = at("bufferViews", index);
    for (const char* name : {"EXT_meshopt_compression", "KHR_meshopt_compression"})
        if (const Json* const compression = gltf_extension(view, name)) return unpacked(index, *compression);
    return part_of_buffer(view, place("bufferViews", index));
}

GltfBytes GltfDocument::unpacked(std::uint64_t index, const Json& c) {
    const auto found = unpacked_.find(index);
    if (found != unpacked_.end()) return found->second;
    const std::string where = place("bufferViews", index);
    const GltfBytes packed = part_of_buffer(c, where);
    const MeshoptLayout layout{gltf_text(c, "mode"), gltf_text(c, "filter"),
                               required_whole(c, "count", where), required_whole(c, "byteStride", where)};
    // A vertex that repeats the previous one takes little more than a bit, so the bytes limit the number of
    // vertices.
    constexpr std::uint64_t kMaxPerByte = 1024;
    if (layout.stride_bytes > 256 || layout.count > kMaxPerByte * (packed.size() + 1))
        refuse("does not parse: " + where + ": " + std::to_string(layout.count) + " elements of " +
               std::to_string(layout.stride_bytes) + " bytes do not come of " +
               std::to_string(packed.size()));
    allow_more(2 * layout.count * layout.stride_bytes, 1e-7 * static_cast<double>(layout.count));
    try {
        return unpacked_.emplace(index, unpack_meshopt(packed, layout)).first->second;
    } catch (const InputError& error) {
        refuse("does not parse: " + where + ": " + error.what());
    }
}

}  // namespace hilcam
