#include "io/files/mesh_import.h"

#include <assimp/MemoryIOWrapper.h>
#include <assimp/material.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <assimp/BaseImporter.h>
#include <algorithm>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#include <cmath>
#include <deque>
#include <map>
#include <memory>
#include <new>
#include <optional>
#include <sstream>

#include "io/files/gltf_import.h"
#include "io/files/left_out.h"
#include "io/files/mesh_guard.h"
#include "io/files/node_names.h"
#include "io/files/obj_maps.h"
#include "io/pictures/picture_file.h"
#include "io/system/confined.h"
#include "render/scene/color_bands.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {
namespace {

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& what) {
    throw InputError(file.string() + ": " + what);
}

// The looks that assimp does not tell of.
struct LooksBeside {
    ObjMaps maps;
    bool whole_colors = false;
};

class Loader {
  public:
    // part: which of `nodes` to take, or -1 for what none of them takes.
    Loader(const std::filesystem::path& file, const aiScene& scene, const LooksBeside& beside,
           std::span<const std::string> nodes, int part)
        : file_(file), scene_(scene), beside_(beside), nodes_(nodes), part_(part) {}

    Mesh load() {
        count_normals_and_uvs();
        read_materials();
        if (scene_.mRootNode) read_node(*scene_.mRootNode, aiMatrix4x4(), -1, 0);
        if (mesh_.triangles.empty()) refuse_empty();
        name_the_rest();
        mesh_.left_out = left_out_.lines();
        return std::move(mesh_);
    }

    // The nodes that load() came across.
    std::vector<MeshNode>& nodes() { return found_nodes_; }
    std::uint64_t collapsed_triangles() const { return collapsed_triangles_; }

  private:
    const std::filesystem::path& file_;
    const aiScene& scene_;
    const LooksBeside& beside_;
    std::span<const std::string> nodes_;
    int part_;
    Mesh mesh_;
    std::map<std::string, int> texture_index_;
    bool any_normals_ = false;
    bool any_uvs_ = false;
    bool any_colors_ = false;
    LeftOut left_out_;
    std::uint64_t texels_ = 0;
    std::vector<MeshNode> found_nodes_;
    std::uint64_t collapsed_triangles_ = 0;

    // One part without normals or uvs must not take them from the others, so the missing ones are filled in.
    void count_normals_and_uvs() {
        for (unsigned i = 0; i < scene_.mNumMeshes; ++i) {
            any_normals_ |= scene_.mMeshes[i]->HasNormals();
            any_uvs_ |= scene_.mMeshes[i]->HasTextureCoords(0);
            any_colors_ |= has_colors(*scene_.mMeshes[i]);
        }
    }

    // White ones say nothing.
    static bool has_colors(const aiMesh& part) {
        if (!part.HasVertexColors(0)) return false;
        return std::any_of(part.mColors[0], part.mColors[0] + part.mNumVertices,
                           [](const aiColor4D& c) { return c.r != 1 || c.g != 1 || c.b != 1; });
    }
    // A colour at a corner as a factor, linear.
    Vec3f color_of(const aiColor4D& c) const {
        const auto factor = [this](float v) {
            const float share = v >= 0 ? std::min(v, 1.0f) : 0.0f;
            return beside_.whole_colors
                       ? linear_from_srgb(static_cast<std::uint8_t>(std::lround(255 * share)))
                       : share;
        };
        return {factor(c.r), factor(c.g), factor(c.b)};
    }

    void read_materials() {
        for (unsigned i = 0; i < scene_.mNumMaterials; ++i)
            mesh_.surfaces.push_back(surface_of(*scene_.mMaterials[i]));
        if (mesh_.surfaces.empty()) mesh_.surfaces.emplace_back();
    }

    MeshSurface surface_of(const aiMaterial& material) {
        MeshSurface surface;
        surface.name = material.GetName().C_Str();
        aiColor4D color;
        if (material.Get(AI_MATKEY_BASE_COLOR, color) == AI_SUCCESS ||
            material.Get(AI_MATKEY_COLOR_DIFFUSE, color) == AI_SUCCESS)
            surface.base_color = {std::clamp(color.r, 0.0f, 1.0f), std::clamp(color.g, 0.0f, 1.0f),
                                  std::clamp(color.b, 0.0f, 1.0f)};
        ai_real value = 0;
        if (material.Get(AI_MATKEY_METALLIC_FACTOR, value) == AI_SUCCESS)
            surface.metallic = std::clamp(value, 0.0f, 1.0f);
        if (material.Get(AI_MATKEY_ROUGHNESS_FACTOR, value) == AI_SUCCESS)
            surface.roughness = std::clamp(value, 0.0f, 1.0f);
        // The grey that assimp has for what a file says nothing of would dim the colours that it does give.
        if (any_colors_ && surface.name == AI_DEFAULT_MATERIAL_NAME) surface.base_color = {1, 1, 1};
        aiString path;
        for (const aiTextureType type : {aiTextureType_BASE_COLOR, aiTextureType_DIFFUSE})
            if (material.GetTexture(type, 0, &path) == AI_SUCCESS) {
                surface.base_color_texture = texture_of(path.C_Str(), surface.name);
                break;
            }
        read_opacity(material, surface);
        return surface;
    }

    // `d` and `Tr` of an OBJ. Many writers mean "opaque" by 0.
    void read_opacity(const aiMaterial& material, MeshSurface& surface) {
        ai_real value = 1;
        if (material.Get(AI_MATKEY_OPACITY, value) != AI_SUCCESS || !(value < 1)) return;
        if (value > 0) surface.opacity = value;
    }

    // Names what is left out of the surfaces that triangles have.
    void name_the_rest() {
        std::vector<bool> used(mesh_.surfaces.size());
        for (const std::uint16_t surface : mesh_.surface_of_triangle) used[surface] = true;
        for (unsigned i = 0; i < scene_.mNumMaterials; ++i)
            if (used[i]) name_the_rest(*scene_.mMaterials[i], mesh_.surfaces[i].name);
    }
    void name_the_rest(const aiMaterial& material, const std::string& name) {
        ai_real opacity = 1;
        if (material.Get(AI_MATKEY_OPACITY, opacity) == AI_SUCCESS && opacity <= 0)
            left_out_.add("dissolve 0, which is taken for opaque,", name);
        aiColor3D emission;
        if (material.Get(AI_MATKEY_COLOR_EMISSIVE, emission) == AI_SUCCESS && !emission.IsBlack())
            left_out_.add("emission", name);
        constexpr std::array<std::pair<aiTextureType, const char*>, 6> kMaps = {
            {{aiTextureType_EMISSIVE, "emission map"},
             {aiTextureType_OPACITY, "opacity map"},
             {aiTextureType_NORMALS, "normal map"},
             {aiTextureType_HEIGHT, "bump map"},
             {aiTextureType_SPECULAR, "specular map"},
             {aiTextureType_DISPLACEMENT, "displacement map"}}};
        for (const auto& [type, what] : kMaps)
            if (material.GetTextureCount(type) > 0) left_out_.add(what, name);
    }

    ObjMap map_of(const std::string& material) const {
        const auto found = beside_.maps.find(material);
        return found == beside_.maps.end() ? ObjMap{} : found->second;
    }

    int texture_of(const std::string& path, const std::string& material) {
        const bool clamp = map_of(material).clamp;
        const std::string key = path + (clamp ? "|clamp" : "");
        const auto known = texture_index_.find(key);
        if (known != texture_index_.end()) return known->second;
        Texture texture = decode(
            path, file_.string() + ": texture " + in_quotes(path) + " of material " + in_quotes(material));
        texture.name = path;
        if (clamp) texture.wrap = {TextureWrap::kClamp, TextureWrap::kClamp};
        texels_ += texture.texels.size();
        if (texels_ > kMaxTexels)
            refuse(file_, "its textures have more than " + std::to_string(kMaxTexels) + " pixels together");
        mesh_.textures.push_back(std::move(texture));
        return texture_index_[key] = static_cast<int>(mesh_.textures.size()) - 1;
    }

    // `what` begins messages.
    Texture decode(const std::string& path, const std::string& what) const {
        const aiTexture* const embedded = scene_.GetEmbeddedTexture(path.c_str());
        if (!embedded) {
            const std::filesystem::path beside = file_.parent_path() / path;
            std::error_code error;
            if (!std::filesystem::exists(beside, error))
                throw InputError(what + " is missing; expected at " + beside.string());
            require_in_folders(file_, beside, what);
            const std::string bytes = read_input_file(beside, picture_kind());
            return decode_texture({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}, what);
        }
        if (embedded->mHeight == 0)  // compressed: mWidth is the number of bytes
            return decode_texture({reinterpret_cast<const std::uint8_t*>(embedded->pcData), embedded->mWidth},
                                  what);
        throw InputError(what + " is not compressed; accepted: PNG, JPEG, TIFF, BMP, WebP");
    }

    // above: the part that a node further up belongs to.
    void read_node(const aiNode& node, const aiMatrix4x4& parent, int above, std::uint32_t depth) {
        const int own = taken_by(nodes_, node.mName.C_Str());
        const int part = own >= 0 ? own : above;
        const aiMatrix4x4 body_from_node = parent * node.mTransformation;
        const std::size_t before = mesh_.triangles.size();
        if (part == part_)
            for (unsigned i = 0; i < node.mNumMeshes; ++i)
                read_part(*scene_.mMeshes[node.mMeshes[i]], body_from_node);
        found_nodes_.push_back({node.mName.C_Str(), depth, mesh_.triangles.size() - before});
        for (unsigned i = 0; i < node.mNumChildren; ++i)
            read_node(*node.mChildren[i], body_from_node, part, depth + 1);
    }

    [[noreturn]] void refuse_empty() const {
        std::vector<std::string> all;
        list_names(*scene_.mRootNode, all);
        refuse(file_, empty_part(nodes_, part_, all));
    }
    static void list_names(const aiNode& node, std::vector<std::string>& names) {
        names.emplace_back(node.mName.C_Str());
        for (unsigned i = 0; i < node.mNumChildren; ++i) list_names(*node.mChildren[i], names);
    }

    void read_part(const aiMesh& part, const aiMatrix4x4& body_from_part) {
        if (!(part.mPrimitiveTypes & aiPrimitiveType_TRIANGLE)) return;
        const auto base = static_cast<std::uint32_t>(mesh_.vertices_m.size());
        require_finite(part);
        aiMatrix3x3 normal_matrix(body_from_part);
        const bool mirrored = normal_matrix.Determinant() < 0;
        normal_matrix.Inverse().Transpose();
        const ObjMap map = map_of(scene_.mMaterials[part.mMaterialIndex]->GetName().C_Str());
        for (unsigned i = 0; i < part.mNumVertices; ++i) {
            const aiVector3D p = body_from_part * part.mVertices[i];
            if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
                refuse(file_,
                       "part " + in_quotes(part.mName.C_Str()) + " is not finite once its node places it");
            mesh_.vertices_m.push_back({p.x, p.y, p.z});
            if (any_uvs_) {
                const bool has = part.HasTextureCoords(0);
                // These formats have v upwards from the picture's bottom.
                const Vec2f uv =
                    has ? map.of({part.mTextureCoords[0][i].x, part.mTextureCoords[0][i].y}) : Vec2f{};
                mesh_.uvs.push_back(finite_or_zero({uv.x, 1 - uv.y}));
            }
            if (any_colors_)
                mesh_.colors.push_back(part.HasVertexColors(0) ? color_of(part.mColors[0][i])
                                                               : Vec3f{1, 1, 1});
            if (any_normals_) {
                const aiVector3D n =
                    part.HasNormals() ? normal_matrix * part.mNormals[i] : aiVector3D(0, 0, 0);
                const float size = n.Length();
                mesh_.normals.push_back(size > 0 && std::isfinite(size) ? Vec3f{n.x, n.y, n.z} / size
                                                                        : Vec3f{});
            }
        }
        const auto surface =
            static_cast<std::uint16_t>(std::min<std::size_t>(part.mMaterialIndex, mesh_.surfaces.size() - 1));
        for (unsigned i = 0; i < part.mNumFaces; ++i) {
            const aiFace& face = part.mFaces[i];
            if (face.mNumIndices != 3) continue;
            std::array<std::uint32_t, 3> t = {face.mIndices[0], face.mIndices[1], face.mIndices[2]};
            if (std::max({t[0], t[1], t[2]}) >= part.mNumVertices)
                refuse(file_, "triangle " + std::to_string(i) + " of part " + in_quotes(part.mName.C_Str()) +
                                  " names a vertex that does not exist");
            // By place: some of assimp's loaders give each corner a vertex of its own.
            const auto at = [&](std::size_t corner) { return mesh_.vertices_m[base + t[corner]]; };
            if (at(0) == at(1) || at(1) == at(2) || at(0) == at(2)) {
                ++collapsed_triangles_;
                continue;
            }
            if (mirrored) std::swap(t[1], t[2]);
            for (std::uint32_t& index : t) index += base;
            mesh_.triangles.push_back(t);
            mesh_.surface_of_triangle.push_back(surface);
        }
    }

    static Vec2f finite_or_zero(Vec2f uv) {
        return std::isfinite(uv.x) && std::isfinite(uv.y) ? uv : Vec2f{};
    }

    void require_finite(const aiMesh& part) const {
        unsigned bad = 0;
        unsigned first = 0;
        for (unsigned i = 0; i < part.mNumVertices; ++i) {
            const aiVector3D& p = part.mVertices[i];
            if (std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z)) continue;
            if (bad++ == 0) first = i;
        }
        if (bad > 0)
            refuse(file_, std::to_string(bad) + " of " + std::to_string(part.mNumVertices) +
                              " vertices of part " + in_quotes(part.mName.C_Str()) +
                              " are not finite, the first is number " + std::to_string(first));
    }
};

// The files that assimp opens: the mesh is in memory already, others are opened as every file is.
class MeshFiles final : public Assimp::IOSystem {
  public:
    // `bytes` are those of `mesh`, and stand for the file `path`.
    MeshFiles(std::filesystem::path mesh, std::string path, std::string_view bytes)
        : mesh_(std::move(mesh)), path_(std::move(path)), bytes_(bytes) {
        if (path_.ends_with(".obj")) materials_.add(bytes_, path_);
    }

    // The error in a file: assimp has words of its own for it, or goes on without the file.
    const std::optional<InputError>& refused() const { return refused_; }

    bool Exists(const char* file) const override {
        std::error_code error;
        return file == path_ || std::filesystem::exists(file, error);
    }
    char getOsSeparator() const override { return '/'; }
    Assimp::IOStream* Open(const char* file, const char*) override {
        if (file == path_) return stream_of(bytes_);
        if (!Exists(file)) {
            missing_.push_back(std::filesystem::path(file).filename().string());
            return nullptr;
        }
        try {
            require_in_folders(mesh_, file, mesh_.string() + ": " + in_quotes(file));
            beside_.push_back(read_input_file(file, mesh_kind()));
            const std::string& text = beside_.back();
            allow_more(kMeshMemoryPerByte * text.size(), kMeshCpu_s_byte * static_cast<double>(text.size()));
            if (!path_.ends_with(".obj")) return stream_of(text);
            materials_.add(text, file);
            beside_.push_back(take_map_options(text, maps_));
            return stream_of(beside_.back());
        } catch (const InputError& error) {
            refused_ = error;
            throw;
        }
    }
    void Close(Assimp::IOStream* stream) override { delete stream; }

    const ObjMaps& maps() const { return maps_; }

    // What an OBJ names that is not there. assimp looks for each in several ways, and then for a file of the
    // mesh's own name: one that was read stands for all.
    std::vector<std::string> missing_materials() const {
        std::vector<std::string> out;
        if (!path_.ends_with(".obj") || !beside_.empty()) return out;
        for (const std::string& name : missing_)
            if (std::find(out.begin(), out.end(), name) == out.end()) out.push_back(name);
        const std::string own = std::filesystem::path(path_).stem().string() + ".mtl";
        if (out.size() > 1) std::erase(out, own);
        return out;
    }

  private:
    std::vector<std::string> missing_;
    std::filesystem::path mesh_;
    std::string path_;
    std::string_view bytes_;
    std::optional<InputError> refused_;
    std::deque<std::string> beside_;  // in use as long as assimp reads
    ObjMaterials materials_;
    ObjMaps maps_;

    static Assimp::IOStream* stream_of(std::string_view bytes) {
        return new Assimp::MemoryIOStream(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
    }
};

// A file as assimp is to read it: at a path whose ending says what it is.
struct Source {
    std::string path, bytes;
};

Source source_of(const std::filesystem::path& file, const std::string& kind) {
    const std::string name = file.string();
    Source source{(file.parent_path() / file.stem()).string() + kind, read_input_file(file, mesh_kind())};
    if (kind == ".ply") require_ply_header(source.bytes, name);
    if (kind == ".stl") require_whole_stl(source.bytes, name);
    return source;
}

// Returns the number of triangles that the parts have once their nodes place them.
std::uint64_t placed_triangles(const aiNode& node, const std::vector<std::uint64_t>& of_mesh) {
    std::uint64_t sum = 0;
    for (unsigned i = 0; i < node.mNumMeshes; ++i) sum += of_mesh[node.mMeshes[i]];
    for (unsigned i = 0; i < node.mNumChildren; ++i) sum += placed_triangles(*node.mChildren[i], of_mesh);
    return sum;
}

// Called before anything is computed of it.
void require_few(const aiScene& scene, const std::filesystem::path& file) {
    if (scene.mNumMaterials > kMaxMaterials) refuse_materials(scene.mNumMaterials, file.string());
    std::vector<std::uint64_t> of_mesh(scene.mNumMeshes);
    for (unsigned i = 0; i < scene.mNumMeshes; ++i) {
        const aiMesh& mesh = *scene.mMeshes[i];
        for (unsigned k = 0; k < mesh.mNumFaces; ++k) {
            const unsigned corners = mesh.mFaces[k].mNumIndices;
            if (corners > kMaxCorners)
                refuse(file, "has a polygon of " + std::to_string(corners) + " corners; accepted: at most " +
                                 std::to_string(kMaxCorners));
            of_mesh[i] += std::max(3u, corners) - 2;
        }
    }
    const std::uint64_t triangles = scene.mRootNode ? placed_triangles(*scene.mRootNode, of_mesh) : 0;
    if (triangles > kMaxTriangles)
        refuse(file, "has " + std::to_string(triangles) + " triangles; accepted: at most " +
                         std::to_string(kMaxTriangles));
    allow_more(kBytesPerTriangle * triangles, 1e-6 * static_cast<double>(triangles));
}

// A word of a list with blanks between its words.
bool has_word(std::string_view list, std::string_view word) {
    std::istringstream words{std::string(list)};
    for (std::string one; words >> one;)
        if (one == word) return true;
    return false;
}

// Leaves the one importer that is for this kind of file. assimp has fifty, and gives contents that none of a
// file's ending takes to whichever knows them: a file of any kind would be read under a name of ours.
void keep_importer_of(const std::string& kind, Assimp::Importer& importer) {
    const std::string_view ending = std::string_view(kind).substr(1);
    for (std::size_t i = importer.GetImporterCount(); i-- > 0;) {
        const aiImporterDesc& about = *importer.GetImporterInfo(i);
        if (has_word(about.mFileExtensions, ending)) continue;
        const std::unique_ptr<Assimp::BaseImporter> other(importer.GetImporter(i));
        importer.UnregisterLoader(other.get());
    }
}

const aiScene& read_scene(Assimp::Importer& importer, const Source& source, const std::filesystem::path& file,
                          LooksBeside& beside, std::vector<std::string>* missing_materials = nullptr) {
    keep_importer_of(std::filesystem::path(source.path).extension().string(), importer);
    importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
    auto* const files =
        new MeshFiles(file, source.path, source.bytes);  // the importer's from the next line on
    importer.SetIOHandler(files);
    const aiScene* scene = importer.ReadFile(source.path, 0);
    if (files->refused()) throw InputError(*files->refused());
    if (missing_materials) *missing_materials = files->missing_materials();
    beside = {files->maps(), source.path.ends_with(".ply") && has_whole_colors(source.bytes)};
    if (scene) {
        require_few(*scene, file);
        scene = importer.ApplyPostProcessing(aiProcess_Triangulate | aiProcess_SortByPType);
    }
    const std::string error = importer.GetErrorString();
    if (!scene && error.find("bad_alloc") != std::string::npos) throw std::bad_alloc();
    if (!scene) refuse(file, "does not parse: " + error);
    return *scene;
}

}  // namespace

namespace {

bool is_gltf(const std::string& kind) { return kind == ".glb" || kind == ".gltf"; }

}  // namespace

MeshContents import_mesh_contents(const std::filesystem::path& file, const std::string& kind) {
    if (is_gltf(kind)) return gltf_contents(file, kind);
    const Source source = source_of(file, kind);
    Assimp::Importer importer;
    MeshContents out;
    LooksBeside beside;
    const aiScene& scene = read_scene(importer, source, file, beside, &out.missing_materials);
    Loader loader(file, scene, beside, {}, -1);
    out.mesh = loader.load();
    out.nodes = std::move(loader.nodes());
    out.collapsed_triangles = loader.collapsed_triangles();
    return out;
}

std::vector<Mesh> import_mesh_parts(const std::filesystem::path& file, const std::string& kind,
                                    std::span<const std::string> nodes) {
    if (is_gltf(kind)) return gltf_parts(file, kind, nodes);
    const Source source = source_of(file, kind);
    Assimp::Importer importer;
    LooksBeside beside;
    const aiScene& scene = read_scene(importer, source, file, beside);
    std::vector<Mesh> meshes;
    for (int part = -1; part < static_cast<int>(nodes.size()); ++part)
        meshes.push_back(Loader(file, scene, beside, nodes, part).load());
    return meshes;
}

}  // namespace hilcam
