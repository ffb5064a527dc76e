#include "io/mesh_file.h"

#include <assimp/material.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <fstream>
#include <iterator>
#include <map>
#include <opencv2/imgcodecs.hpp>

#include "io/gltf_webp.h"
#include "io/kept_stderr.h"
#include "render/check.h"
#include "render/quoted.h"

namespace hilcam {
namespace {

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& what) {
    throw InputError(file.string() + ": " + what);
}

class Loader {
  public:
    // part: which of `nodes` to take, or -1 for what none of them takes.
    Loader(const std::filesystem::path& file, const aiScene& scene, std::span<const std::string> nodes,
           int part)
        : file_(file), scene_(scene), nodes_(nodes), part_(part) {}

    Mesh load() {
        read_materials();
        count_normals_and_uvs();
        if (scene_.mRootNode) read_node(*scene_.mRootNode, aiMatrix4x4(), -1);
        if (mesh_.triangles.empty()) refuse_empty();
        return std::move(mesh_);
    }

  private:
    const std::filesystem::path& file_;
    const aiScene& scene_;
    std::span<const std::string> nodes_;
    int part_;
    Mesh mesh_;
    std::map<std::string, int> texture_index_;
    bool any_normals_ = false;
    bool any_uvs_ = false;

    // One part without normals or uvs must not take them from the others, so the missing ones are filled in.
    void count_normals_and_uvs() {
        for (unsigned i = 0; i < scene_.mNumMeshes; ++i) {
            any_normals_ |= scene_.mMeshes[i]->HasNormals();
            any_uvs_ |= scene_.mMeshes[i]->HasTextureCoords(0);
        }
    }

    void read_materials() {
        if (scene_.mNumMaterials > 65535)
            refuse(file_,
                   "has " + std::to_string(scene_.mNumMaterials) + " materials; accepted: at most 65535");
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
        aiString path;
        for (const aiTextureType type : {aiTextureType_BASE_COLOR, aiTextureType_DIFFUSE})
            if (material.GetTexture(type, 0, &path) == AI_SUCCESS) {
                surface.base_color_texture = texture_of(path.C_Str(), surface.name);
                break;
            }
        return surface;
    }

    int texture_of(const std::string& path, const std::string& material) {
        const auto known = texture_index_.find(path);
        if (known != texture_index_.end()) return known->second;
        const cv::Mat picture = decode(path, material);
        Texture texture;
        texture.name = path;
        texture.width = picture.cols;
        texture.height = picture.rows;
        texture.texels.reserve(static_cast<std::size_t>(picture.cols) *
                               static_cast<std::size_t>(picture.rows));
        for (int y = 0; y < picture.rows; ++y)
            for (int x = 0; x < picture.cols; ++x) {
                const cv::Vec3b bgr = picture.at<cv::Vec3b>(y, x);
                texture.texels.push_back({bgr[2], bgr[1], bgr[0]});
            }
        mesh_.textures.push_back(std::move(texture));
        return texture_index_[path] = static_cast<int>(mesh_.textures.size()) - 1;
    }

    cv::Mat decode(const std::string& path, const std::string& material) const {
        const KeptStderr printed;
        cv::Mat picture;
        const std::string of = "texture " + in_quotes(path) + " of material " + in_quotes(material);
        try {
            if (const aiTexture* embedded = scene_.GetEmbeddedTexture(path.c_str())) {
                if (embedded->mHeight == 0) {  // compressed: mWidth is the number of bytes
                    const auto* bytes = reinterpret_cast<const std::uint8_t*>(embedded->pcData);
                    picture = cv::imdecode(cv::Mat(1, static_cast<int>(embedded->mWidth), CV_8UC1,
                                                   const_cast<std::uint8_t*>(bytes)),
                                           cv::IMREAD_COLOR);
                } else {
                    picture.create(static_cast<int>(embedded->mHeight), static_cast<int>(embedded->mWidth),
                                   CV_8UC3);
                    for (int i = 0; i < picture.rows * picture.cols; ++i) {
                        const aiTexel& t = embedded->pcData[i];
                        picture.at<cv::Vec3b>(i / picture.cols, i % picture.cols) = {t.b, t.g, t.r};
                    }
                }
            } else {
                const std::filesystem::path beside = file_.parent_path() / path;
                if (!std::filesystem::exists(beside))
                    refuse(file_, of + " is missing; expected at " + beside.string());
                picture = cv::imread(beside.string(), cv::IMREAD_COLOR);
            }
        } catch (const cv::Exception&) {
            picture.release();
        }
        const std::string why = printed.first_line();
        if (picture.empty())
            refuse(file_, of + " does not decode" + (why.empty() ? "" : " (" + why + ")") +
                              "; accepted: PNG, JPEG, TIFF, BMP, WebP");
        return picture;
    }

    // Which of the names takes a node, or -1.
    int taken_by(const std::string& name) const {
        for (std::size_t k = 0; k < nodes_.size(); ++k) {
            const std::string& pattern = nodes_[k];
            const bool open = !pattern.empty() && pattern.back() == '*';
            if (open ? name.starts_with(pattern.substr(0, pattern.size() - 1)) : name == pattern)
                return static_cast<int>(k);
        }
        return -1;
    }

    // above: the part that a node further up belongs to.
    void read_node(const aiNode& node, const aiMatrix4x4& parent, int above) {
        const int own = taken_by(node.mName.C_Str());
        const int part = own >= 0 ? own : above;
        const aiMatrix4x4 body_from_node = parent * node.mTransformation;
        if (part == part_)
            for (unsigned i = 0; i < node.mNumMeshes; ++i)
                read_part(*scene_.mMeshes[node.mMeshes[i]], body_from_node);
        for (unsigned i = 0; i < node.mNumChildren; ++i) read_node(*node.mChildren[i], body_from_node, part);
    }

    [[noreturn]] void refuse_empty() const {
        if (part_ < 0)
            refuse(file_, nodes_.empty() ? "holds no triangle; accepted: a mesh with at least one"
                                         : "holds no triangle besides its parts");
        std::string names;
        list_names(*scene_.mRootNode, names);
        refuse(file_, "no triangle under a node " + in_quotes(nodes_[static_cast<std::size_t>(part_)]) +
                          "; its nodes:" + names);
    }
    static void list_names(const aiNode& node, std::string& names) {
        if (names.size() < 400) names.append(" ").append(node.mName.C_Str());
        for (unsigned i = 0; i < node.mNumChildren; ++i) list_names(*node.mChildren[i], names);
    }

    void read_part(const aiMesh& part, const aiMatrix4x4& body_from_part) {
        if (!(part.mPrimitiveTypes & aiPrimitiveType_TRIANGLE)) return;
        const auto base = static_cast<std::uint32_t>(mesh_.vertices_m.size());
        require_finite(part);
        aiMatrix3x3 normal_matrix(body_from_part);
        const bool mirrored = normal_matrix.Determinant() < 0;
        normal_matrix.Inverse().Transpose();
        for (unsigned i = 0; i < part.mNumVertices; ++i) {
            const aiVector3D p = body_from_part * part.mVertices[i];
            if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
                refuse(file_,
                       "part " + in_quotes(part.mName.C_Str()) + " is not finite once its node places it");
            mesh_.vertices_m.push_back({p.x, p.y, p.z});
            if (any_uvs_) {
                const bool has = part.HasTextureCoords(0);
                mesh_.uvs.push_back(has ? Vec2f{part.mTextureCoords[0][i].x, part.mTextureCoords[0][i].y}
                                        : Vec2f{});
            }
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
            if (at(0) == at(1) || at(1) == at(2) || at(0) == at(2)) continue;
            if (mirrored) std::swap(t[1], t[2]);
            for (std::uint32_t& index : t) index += base;
            mesh_.triangles.push_back(t);
            mesh_.surface_of_triangle.push_back(surface);
        }
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

std::vector<std::uint8_t> read_bytes(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

// Reads a scene, from the changed bytes where there are some.
const aiScene* import(Assimp::Importer& importer, const std::filesystem::path& file,
                      const std::optional<std::vector<std::uint8_t>>& changed) {
    importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
    constexpr unsigned kSteps = aiProcess_Triangulate | aiProcess_SortByPType;
    if (changed) return importer.ReadFileFromMemory(changed->data(), changed->size(), kSteps, "glb");
    return importer.ReadFile(file.string(), kSteps);
}

// Quicker and clearer than the child below, which a header without an end keeps busy.
void require_ply_header(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    std::string line;
    for (int lines = 0; lines < 1000 && std::getline(in, line); ++lines)
        if (line.starts_with("end_header")) return;
    refuse(file, "does not parse: its PLY header has no end_header");
}

// assimp 5.2 as Debian builds it aborts on some broken files (a PLY cut short in its faces) and never returns
// from others (one cut short in its header). So a child process reads the file first; what ends it is a
// message.
void require_survivable(const std::filesystem::path& file,
                        const std::optional<std::vector<std::uint8_t>>& changed) {
    // A hundred times what large files take a megabyte, and enough for the smallest.
    const rlim_t most_cpu_s = 10 + 3 * std::filesystem::file_size(file) / 1'000'000;
    const pid_t child = fork();
    if (child < 0) throw DeviceError("no process can be made to read " + file.string());
    if (child == 0) {
        const rlimit cpu{most_cpu_s, most_cpu_s}, core{0, 0};
        setrlimit(RLIMIT_CPU, &cpu);
        setrlimit(RLIMIT_CORE, &core);
        const int nowhere = open("/dev/null", O_WRONLY);
        dup2(nowhere, STDERR_FILENO);
        // No handler of the parent's (a sanitizer's, a test's) shall take an abort for its own.
        for (const int signal : {SIGABRT, SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGINT, SIGTERM})
            std::signal(signal, SIG_DFL);
        Assimp::Importer importer;
        import(importer, file, changed);
        _exit(0);  // a file that is refused in words is refused again by the parent
    }
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return;
    const int signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
    refuse(file, signal == SIGXCPU || signal == SIGKILL
                     ? "does not parse: its reader found no end"
                     : "does not parse: it is broken in a way that ends its reader; export it anew");
}

}  // namespace

Mesh load_mesh(const std::filesystem::path& file) { return std::move(load_mesh_parts(file, {}).front()); }

std::vector<Mesh> load_mesh_parts(const std::filesystem::path& file, std::span<const std::string> nodes) {
    std::string kind = file.extension().string();
    std::transform(kind.begin(), kind.end(), kind.begin(), [](unsigned char c) { return std::tolower(c); });
    const std::array<std::string, 5> kinds = {".glb", ".gltf", ".obj", ".stl", ".ply"};
    if (!std::filesystem::is_regular_file(file)) refuse(file, "no such mesh file");
    if (std::find(kinds.begin(), kinds.end(), kind) == kinds.end())
        refuse(file, "found a file of kind " + in_quotes(kind) + "; accepted: .glb .gltf .obj .stl .ply");
    if (kind == ".ply") require_ply_header(file);
    std::optional<std::vector<std::uint8_t>> changed;
    if (kind == ".glb") changed = with_plain_webp_sources(read_bytes(file));
    require_survivable(file, changed);
    Assimp::Importer importer;
    const aiScene* scene = import(importer, file, changed);
    if (!scene) refuse(file, std::string("does not parse: ") + importer.GetErrorString());
    std::vector<Mesh> meshes;
    for (int part = -1; part < static_cast<int>(nodes.size()); ++part)
        meshes.push_back(Loader(file, *scene, nodes, part).load());
    return meshes;
}

}  // namespace hilcam
