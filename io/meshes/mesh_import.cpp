#include "io/meshes/mesh_import.h"

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

#include "io/meshes/gltf_import.h"
#include "io/meshes/left_out.h"
#include "io/meshes/mesh_guard.h"
#include "io/meshes/node_names.h"
#include "io/meshes/obj_maps.h"
#include "io/meshes/obj_source.h"
#include "io/meshes/ply_source.h"
#include "io/meshes/stl_source.h"
#include "io/pictures/picture_file.h"
#include "io/system/confined.h"
#include "render/scene/color_bands.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {
namespace {

[[noreturn]] void refuse_mesh(const std::filesystem::path& file, const std::string& what) {
    throw InputError(file.string() + ": " + what);
}

// A file as assimp is to read it: at a path whose ending says what it is.
struct MeshSource {
    std::string path, bytes;
    ObjLibraries libraries = {};  // an OBJ has some
    std::vector<std::string> remarks = {};
    bool is_flat = false;       // the corners' order is the normal
    ObjMaps maps = {};          // an OBJ may have some
    bool whole_colors = false;  // colours at corners are a picture's, not linear
};

class Loader {
  public:
    // part: which of `nodes` to take, or -1 for what none of them takes.
    Loader(NamedFiles& files, const MeshSource& source, const aiScene& scene,
           std::span<const std::string> nodes, int part)
        : file_(files.mesh()), files_(files), source_(source), scene_(scene), nodes_(nodes), part_(part) {}

    // Throws InputError when textures cannot be read, all of them in one line.
    Mesh load() {
        MeshContents contents = load_contents();
        const std::vector<std::string>& bad = contents.unreadable_textures;
        if (bad.empty()) return std::move(contents.mesh);
        refuse_textures(bad, file_.string());
    }

    MeshContents load_contents() {
        count_normals_and_uvs();
        read_materials();
        if (scene_.mRootNode) read_node(*scene_.mRootNode, aiMatrix4x4(), -1, 0);
        if (mesh_.triangles.empty()) refuse_empty();
        read_textures();
        mesh_.left_out = left_out_.lines();
        out_.mesh = std::move(mesh_);
        return std::move(out_);
    }

  private:
    const std::filesystem::path& file_;
    NamedFiles& files_;
    const MeshSource& source_;
    const aiScene& scene_;
    std::span<const std::string> nodes_;
    int part_;
    Mesh mesh_;
    MeshContents out_;
    std::map<std::pair<FileName, bool>, int> texture_index_;  // by name, and whether its edge goes on
    bool any_normals_ = false;
    bool any_uvs_ = false;
    bool any_colors_ = false;
    LeftOut left_out_;
    std::uint64_t texels_ = 0;

    // One part without normals or uvs must not take them from the others, so the missing ones are filled in.
    void count_normals_and_uvs() {
        for (unsigned i = 0; i < scene_.mNumMeshes; ++i) {
            any_normals_ |= scene_.mMeshes[i]->HasNormals() && !source_.is_flat;
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
            return source_.whole_colors
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
        // `d` and `Tr` of an OBJ. Many writers mean "opaque" by 0.
        if (material.Get(AI_MATKEY_OPACITY, value) == AI_SUCCESS && value > 0 && value < 1)
            surface.opacity = value;
        return surface;
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
        const auto found = source_.maps.find(material);
        return found == source_.maps.end() ? ObjMap{} : found->second;
    }

    // Reads the textures of the surfaces that triangles have, and names what is left out of them: libraries of materials have others, too.
    void read_textures() {
        std::vector<bool> used(mesh_.surfaces.size());
        for (const std::uint16_t surface : mesh_.surface_of_triangle) used[surface] = true;
        for (unsigned i = 0; i < scene_.mNumMaterials; ++i) {
            if (used[i]) name_the_rest(*scene_.mMaterials[i], mesh_.surfaces[i].name);
            aiString name;
            for (const aiTextureType type : {aiTextureType_BASE_COLOR, aiTextureType_DIFFUSE})
                if (used[i] && scene_.mMaterials[i]->GetTexture(type, 0, &name) == AI_SUCCESS) {
                    mesh_.surfaces[i].base_color_texture = texture_of(name.C_Str(), mesh_.surfaces[i].name);
                    break;
                }
        }
    }

    // Returns the texture's number, or -1 for one that cannot be read.
    int texture_of(const std::string& name, const std::string& material) {
        FileName file{name, {}};
        const auto& folders = source_.libraries.folder_of_material;
        if (const auto folder = folders.find(material); folder != folders.end())
            file.folders.push_back(folder->second);
        const bool clamp = map_of(material).clamp;
        const auto known = texture_index_.find({file, clamp});
        if (known != texture_index_.end()) return known->second;
        int index = -1;
        try {
            Texture texture =
                decode(file, "texture " + in_quotes(name) + " of material " + in_quotes(material));
            texture.name = name;
            if (clamp) texture.wrap = {TextureWrap::kClamp, TextureWrap::kClamp};
            texels_ += texture.texels.size();
            mesh_.textures.push_back(std::move(texture));
            index = static_cast<int>(mesh_.textures.size()) - 1;
        } catch (const InputError& fault) {
            out_.unreadable_textures.emplace_back(fault.what());
        }
        if (texels_ > kMaxTexels)
            refuse_mesh(file_,
                        "its textures have more than " + std::to_string(kMaxTexels) + " pixels together");
        return texture_index_[{file, clamp}] = index;
    }

    // `what` begins messages.
    Texture decode(const FileName& name, const std::string& what) const {
        const aiTexture* const embedded = scene_.GetEmbeddedTexture(name.name.c_str());
        if (!embedded) {
            const std::optional<std::filesystem::path> found = files_.find(name, what);
            if (!found)
                throw InputError(what + " is missing; expected at " +
                                 (file_.parent_path() / name.name).string());
            const std::string bytes = [&] {
                try {
                    return read_input_file(*found, picture_kind());
                } catch (const InputError& fault) {
                    throw InputError(what + ": " + fault.what());
                }
            }();
            return decode_texture({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}, what);
        }
        if (embedded->mHeight == 0)  // compressed: mWidth is the number of bytes
            return decode_texture({reinterpret_cast<const std::uint8_t*>(embedded->pcData), embedded->mWidth},
                                  what);
        throw InputError(what + " is not compressed; accepted: " + picture_kind().accepted);
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
        out_.nodes.push_back({node.mName.C_Str(), depth, mesh_.triangles.size() - before});
        for (unsigned i = 0; i < node.mNumChildren; ++i)
            read_node(*node.mChildren[i], body_from_node, part, depth + 1);
    }

    [[noreturn]] void refuse_empty() const {
        std::vector<std::string> all;
        list_names(*scene_.mRootNode, all);
        refuse_mesh(file_, empty_part(nodes_, part_, all));
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
                refuse_mesh(file_, "part " + in_quotes(part.mName.C_Str()) +
                                       " is not finite once its node places it");
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
                refuse_mesh(file_, "triangle " + std::to_string(i) + " of part " +
                                       in_quotes(part.mName.C_Str()) + " names a vertex that does not exist");
            // By place: some of assimp's loaders give each corner a vertex of its own.
            const auto at = [&](std::size_t corner) { return mesh_.vertices_m[base + t[corner]]; };
            if (at(0) == at(1) || at(1) == at(2) || at(0) == at(2)) {
                ++out_.collapsed_triangles;
                continue;
            }
            if (source_.is_flat && part.HasNormals()) compare_normals(part, face);
            if (mirrored) std::swap(t[1], t[2]);
            for (std::uint32_t& index : t) index += base;
            mesh_.triangles.push_back(t);
            mesh_.surface_of_triangle.push_back(surface);
        }
    }

    // Counts a facet whose normal in the file is not that of its corners' order; one of 0 says nothing.
    void compare_normals(const aiMesh& part, const aiFace& face) {
        const aiVector3D said = part.mNormals[face.mIndices[0]];
        const aiVector3D a = part.mVertices[face.mIndices[0]], b = part.mVertices[face.mIndices[1]];
        const aiVector3D own = (b - a) ^ (part.mVertices[face.mIndices[2]] - a);
        const float both = said * own, sizes = said.Length() * own.Length();
        if (!(sizes > 0)) return;
        out_.opposed_facets += both < 0;
        out_.leaning_facets += both >= 0 && both < 0.9f * sizes;
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
            refuse_mesh(file_, std::to_string(bad) + " of " + std::to_string(part.mNumVertices) +
                                   " vertices of part " + in_quotes(part.mName.C_Str()) +
                                   " are not finite, the first is number " + std::to_string(first));
    }
};

// The name by which assimp asks for an OBJ's materials, all of them in one text.
constexpr const char* kMaterials = "hilcam_materials.mtl";

// The files that assimp opens: the mesh and its materials are in memory already, others are opened as every file is.
class MeshFiles final : public Assimp::IOSystem {
  public:
    MeshFiles(NamedFiles& files, const MeshSource& source) : files_(files), source_(source) {}

    // The error in a file: assimp has words of its own for it, or goes on without the file.
    const std::optional<InputError>& refused() const { return refused_; }

    bool Exists(const char* file) const override {
        std::error_code error;
        return file == source_.path || std::filesystem::exists(file, error);
    }
    char getOsSeparator() const override { return '/'; }
    Assimp::IOStream* Open(const char* file, const char*) override {
        const std::filesystem::path path = file;
        if (file == source_.path) return stream_of(source_.bytes);
        if (path.filename() == kMaterials) return stream_of(source_.libraries.text);
        try {
            const std::string name = path.lexically_proximate(files_.mesh().parent_path()).string();
            const auto found = files_.find_for_mesh({name, {}}, in_quotes(name));
            if (!found) return nullptr;
            beside_.push_back(read_input_file(*found, mesh_kind()));
            const std::string& text = beside_.back();
            allow_more(kMeshMemoryPerByte * text.size(), kMeshCpu_s_byte * static_cast<double>(text.size()));
            return stream_of(text);
        } catch (const InputError& error) {
            refused_ = error;
            throw;
        }
    }
    void Close(Assimp::IOStream* stream) override { delete stream; }

  private:
    NamedFiles& files_;
    const MeshSource& source_;
    std::optional<InputError> refused_;
    std::deque<std::string> beside_;  // in use as long as assimp reads

    static Assimp::IOStream* stream_of(std::string_view bytes) {
        return new Assimp::MemoryIOStream(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
    }
};

MeshSource source_of(NamedFiles& files, const std::string& kind) {
    const std::filesystem::path& file = files.mesh();
    const std::string name = file.string();
    MeshSource source{(file.parent_path() / file.stem()).string() + kind, read_input_file(file, mesh_kind())};
    if (kind == ".obj") {
        ObjSource obj = plain_obj(source.bytes, name);
        source.libraries = read_obj_libraries(obj, files);
        source.libraries.text = take_map_options(source.libraries.text, source.maps);
        source.bytes = std::move(obj.text);
        if (!source.libraries.text.empty())
            source.bytes.insert(0, std::string("mtllib ") + kMaterials + "\n");
    }
    if (kind == ".ply") source.bytes = plain_ply(source.bytes, name);
    source.whole_colors = kind == ".ply" && has_whole_colors(source.bytes);
    if (kind == ".stl") source.bytes = plain_stl(source.bytes, name, source.remarks);
    source.is_flat = kind == ".stl";
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
                refuse_mesh(file, "has a polygon of " + std::to_string(corners) +
                                      " corners; accepted: at most " + std::to_string(kMaxCorners));
            of_mesh[i] += std::max(3u, corners) - 2;
        }
    }
    const std::uint64_t triangles = scene.mRootNode ? placed_triangles(*scene.mRootNode, of_mesh) : 0;
    if (triangles > kMaxTriangles)
        refuse_mesh(file, "has " + std::to_string(triangles) + " triangles; accepted: at most " +
                              std::to_string(kMaxTriangles));
    allow_more(kBytesPerTriangle * triangles, 1e-6 * static_cast<double>(triangles));
}

// A word of a list with blanks between its words.
bool lists_word(std::string_view list, std::string_view word) {
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
        if (lists_word(about.mFileExtensions, ending)) continue;
        const std::unique_ptr<Assimp::BaseImporter> other(importer.GetImporter(i));
        importer.UnregisterLoader(other.get());
    }
}

const aiScene& read_scene(Assimp::Importer& importer, const MeshSource& source, NamedFiles& names) {
    const std::filesystem::path& file = names.mesh();
    keep_importer_of(std::filesystem::path(source.path).extension().string(), importer);
    importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
    auto* const files = new MeshFiles(names, source);  // the importer's from the next line on
    importer.SetIOHandler(files);
    const aiScene* scene = importer.ReadFile(source.path, 0);
    if (files->refused()) throw InputError(*files->refused());
    if (scene) {
        require_few(*scene, file);
        scene = importer.ApplyPostProcessing(aiProcess_Triangulate | aiProcess_SortByPType);
    }
    const std::string error = importer.GetErrorString();
    if (!scene && error.find("bad_alloc") != std::string::npos) throw std::bad_alloc();
    if (!scene) refuse_mesh(file, "does not parse: " + error);
    return *scene;
}

}  // namespace

const InputKind& mesh_kind() {
    static const InputKind kind{std::uintmax_t{4} << 30, "a mesh file, or what one names beside it"};
    return kind;
}

namespace {

bool is_gltf(const std::string& kind) { return kind == ".glb" || kind == ".gltf"; }

}  // namespace

MeshContents import_mesh_contents(NamedFiles& files, const std::string& kind) {
    if (is_gltf(kind)) return gltf_contents(files, kind);
    const MeshSource source = source_of(files, kind);
    Assimp::Importer importer;
    MeshContents out = Loader(files, source, read_scene(importer, source, files), {}, -1).load_contents();
    out.missing_materials = source.libraries.missing;
    out.remarks = source.remarks;
    out.remarks.insert(out.remarks.end(), files.remarks().begin(), files.remarks().end());
    return out;
}

std::vector<Mesh> import_mesh_parts(NamedFiles& files, const std::string& kind,
                                    std::span<const std::string> nodes) {
    if (is_gltf(kind)) return gltf_parts(files, kind, nodes);
    const MeshSource source = source_of(files, kind);
    Assimp::Importer importer;
    const aiScene& scene = read_scene(importer, source, files);
    std::vector<Mesh> meshes;
    for (int part = -1; part < static_cast<int>(nodes.size()); ++part)
        meshes.push_back(Loader(files, source, scene, nodes, part).load());
    return meshes;
}

}  // namespace hilcam
