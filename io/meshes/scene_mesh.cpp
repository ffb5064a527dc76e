#include "io/meshes/scene_mesh.h"

#include <assimp/material.h>
#include <assimp/scene.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "io/images/picture_file.h"
#include "io/meshes/left_out.h"
#include "io/meshes/mesh_precheck.h"
#include "io/meshes/node_names.h"
#include "io/system/input_file.h"
#include "render/scene/color_bands.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {
namespace {

[[noreturn]] void refuse_scene(const std::filesystem::path& file, const std::string& what) {
    throw InputError(file.string() + ": " + what);
}

class SceneLoader {
  public:
    // part: index of the part in `nodes`, or -1 for what none of them matches.
    SceneLoader(NamedFiles& files, const MeshSource& source, const aiScene& scene,
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
    std::map<std::pair<FileName, bool>, int> texture_index_;  // by name, and whether its edge continues
    bool any_normals_ = false;
    bool any_uvs_ = false;
    bool any_colors_ = false;
    LeftOut left_out_;
    std::uint64_t texels_ = 0;

    // One part without normals or texture coordinates must not remove them from the others, so missing ones
    // are filled in.
    void count_normals_and_uvs() {
        for (unsigned i = 0; i < scene_.mNumMeshes; ++i) {
            any_normals_ |= scene_.mMeshes[i]->HasNormals() && !source_.is_flat;
            any_uvs_ |= scene_.mMeshes[i]->HasTextureCoords(0);
            any_colors_ |= has_colors(*scene_.mMeshes[i]);
        }
    }

    // White colours have no effect.
    static bool has_colors(const aiMesh& part) {
        if (!part.HasVertexColors(0)) return false;
        return std::any_of(part.mColors[0], part.mColors[0] + part.mNumVertices,
                           [](const aiColor4D& c) { return c.r != 1 || c.g != 1 || c.b != 1; });
    }
    // Returns the colour at a corner as a linear factor.
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
        // assimp's default grey, for files without materials, would dim the colours that the file does have.
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

    // Reads the textures of surfaces with triangles, and names what is left out of these; libraries of
    // materials have more.
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

    // Returns the texture's index, or -1 for one that cannot be read.
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
            refuse_scene(file_,
                         "its textures have more than " + std::to_string(kMaxTexels) + " pixels together");
        return texture_index_[{file, clamp}] = index;
    }

    // what: begins messages.
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

    // above: the part of an ancestor.
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
        refuse_scene(file_, empty_part(nodes_, part_, all));
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
                refuse_scene(file_, "part " + in_quotes(part.mName.C_Str()) +
                                        " is not finite once its node places it");
            mesh_.vertices_m.push_back({p.x, p.y, p.z});
            if (any_uvs_) {
                const bool has = part.HasTextureCoords(0);
                // In these formats v points upwards from the bottom of the picture.
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
                refuse_scene(file_, "triangle " + std::to_string(i) + " of part " +
                                        in_quotes(part.mName.C_Str()) +
                                        " names a vertex that does not exist");
            // Compares positions, because some of assimp's loaders give each corner its own vertex.
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

    // Counts a facet with a normal in the file that is not that of its corners' order; a zero normal has no
    // meaning.
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
            refuse_scene(file_, std::to_string(bad) + " of " + std::to_string(part.mNumVertices) +
                                    " vertices of part " + in_quotes(part.mName.C_Str()) +
                                    " are not finite, the first is number " + std::to_string(first));
    }
};

}  // namespace

MeshContents contents_of_scene(const aiScene& scene, const MeshSource& source, NamedFiles& files) {
    return SceneLoader(files, source, scene, {}, -1).load_contents();
}

Mesh part_of_scene(const aiScene& scene, const MeshSource& source, NamedFiles& files,
                   std::span<const std::string> nodes, int part) {
    return SceneLoader(files, source, scene, nodes, part).load();
}

}  // namespace hilcam
