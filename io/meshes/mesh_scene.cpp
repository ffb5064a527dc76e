#include "io/meshes/mesh_scene.h"

#include <assimp/MemoryIOWrapper.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <assimp/BaseImporter.h>
#include <algorithm>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <new>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "io/meshes/mesh_import.h"
#include "io/meshes/mesh_precheck.h"
#include "io/system/confined.h"
#include "io/system/input_file.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {
namespace {

[[noreturn]] void refuse_mesh(const std::filesystem::path& file, const std::string& what) {
    throw InputError(file.string() + ": " + what);
}

// The files that assimp opens. The mesh and its materials are in memory already; others are opened like every
// file.
class MeshFiles final : public Assimp::IOSystem {
  public:
    MeshFiles(NamedFiles& files, const MeshSource& source) : files_(files), source_(source) {}

    // The error in a file. assimp replaces it with its own text, or continues without the file.
    const std::optional<InputError>& refused() const { return refused_; }

    bool Exists(const char* file) const override {
        std::error_code error;
        return file == source_.path || std::filesystem::exists(file, error);
    }
    char getOsSeparator() const override { return '/'; }
    Assimp::IOStream* Open(const char* file, const char*) override {
        const std::filesystem::path path = file;
        if (file == source_.path) return stream_of(source_.bytes);
        if (path.filename() == kMeshMaterials) return stream_of(source_.libraries.text);
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
    std::deque<std::string> beside_;  // in use while assimp reads

    static Assimp::IOStream* stream_of(std::string_view bytes) {
        return new Assimp::MemoryIOStream(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
    }
};

// Returns the number of triangles after nodes have placed the parts.
std::uint64_t placed_triangles(const aiNode& node, const std::vector<std::uint64_t>& of_mesh) {
    std::uint64_t sum = 0;
    for (unsigned i = 0; i < node.mNumMeshes; ++i) sum += of_mesh[node.mMeshes[i]];
    for (unsigned i = 0; i < node.mNumChildren; ++i) sum += placed_triangles(*node.mChildren[i], of_mesh);
    return sum;
}

// Called before anything is computed from the scene.
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

// True when a list of words separated by blanks has this word.
bool lists_word(std::string_view list, std::string_view word) {
    std::istringstream words{std::string(list)};
    for (std::string one; words >> one;)
        if (one == word) return true;
    return false;
}

// Keeps only the importer for this kind of file. assimp has fifty, and gives contents that do not suit the
// file's ending to any importer that recognises them; a file of any kind could then pass under one of our
// names.
void keep_importer_of(const std::string& kind, Assimp::Importer& importer) {
    const std::string_view ending = std::string_view(kind).substr(1);
    for (std::size_t i = importer.GetImporterCount(); i-- > 0;) {
        const aiImporterDesc& about = *importer.GetImporterInfo(i);
        if (lists_word(about.mFileExtensions, ending)) continue;
        const std::unique_ptr<Assimp::BaseImporter> other(importer.GetImporter(i));
        importer.UnregisterLoader(other.get());
    }
}

}  // namespace

MeshScene::~MeshScene() = default;

MeshScene::MeshScene(const MeshSource& source, NamedFiles& names)
    : importer_(std::make_unique<Assimp::Importer>()) {
    Assimp::Importer& importer = *importer_;
    const std::filesystem::path& file = names.mesh();
    keep_importer_of(std::filesystem::path(source.path).extension().string(), importer);
    importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
    auto* const files = new MeshFiles(names, source);  // owned by the importer from the next line on
    importer.SetIOHandler(files);
    scene_ = importer.ReadFile(source.path, 0);
    if (files->refused()) throw InputError(*files->refused());
    if (scene_) {
        require_few(*scene_, file);
        scene_ = importer.ApplyPostProcessing(aiProcess_Triangulate | aiProcess_SortByPType);
    }
    const std::string error = importer.GetErrorString();
    if (!scene_ && error.find("bad_alloc") != std::string::npos) throw std::bad_alloc();
    if (!scene_) refuse_mesh(file, "does not parse: " + error);
}

}  // namespace hilcam
