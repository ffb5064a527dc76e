#include "io/files/mesh_file.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <span>

#include "io/files/dsk_shape.h"
#include "io/files/mesh_import.h"
#include "io/files/shape_table.h"
#include "io/system/confined.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {
namespace {

// The memory that any mesh may take: a node or a material is a kilobyte and more, and libraries have tables.
constexpr std::uint64_t kMinMemory_bytes = std::uint64_t{512} << 20;
constexpr double kMinCpu_s = 10;

void write_surface(const MeshSurface& s, ConfinedOutput& out) {
    out.text(s.name);
    out.value(s.base_color);
    out.value(s.metallic);
    out.value(s.roughness);
    out.value(s.base_color_texture);
    out.value(s.refractive_index);
    out.value(s.opacity);
    out.value(s.transmission);
}

MeshSurface read_surface(ConfinedResult& in) {
    MeshSurface s;
    s.name = in.text();
    s.base_color = in.value<Vec3f>();
    s.metallic = in.value<float>();
    s.roughness = in.value<float>();
    s.base_color_texture = in.value<int>();
    s.refractive_index = in.value<float>();
    s.opacity = in.value<float>();
    s.transmission = in.value<float>();
    return s;
}

void write_texture(const Texture& t, ConfinedOutput& out) {
    out.text(t.name);
    out.value(t.width);
    out.value(t.height);
    out.list(std::span(t.texels));
    out.value(t.wrap);
}

Texture read_texture(ConfinedResult& in) {
    Texture t;
    t.name = in.text();
    t.width = in.value<int>();
    t.height = in.value<int>();
    t.texels = in.list<std::array<std::uint8_t, 3>>();
    t.wrap = in.value<std::array<TextureWrap, 2>>();
    if (std::max(t.wrap[0], t.wrap[1]) > TextureWrap::kMirror) in.refuse();
    if (t.width < 1 || t.height < 1 ||
        t.texels.size() != static_cast<std::size_t>(t.width) * static_cast<std::size_t>(t.height))
        in.refuse();
    return t;
}

void write_mesh(const Mesh& m, ConfinedOutput& out) {
    out.list(std::span(m.vertices_m));
    out.list(std::span(m.normals));
    out.list(std::span(m.uvs));
    out.list(std::span(m.colors));
    out.list(std::span(m.triangles));
    out.list(std::span(m.surface_of_triangle));
    out.value(m.surfaces.size());
    for (const MeshSurface& s : m.surfaces) write_surface(s, out);
    out.value(m.textures.size());
    for (const Texture& t : m.textures) write_texture(t, out);
    out.value(m.left_out.size());
    for (const std::string& line : m.left_out) out.text(line);
}

// Checks for what would lead astray whoever uses it: the child may have been broken by the file.
bool is_whole(const Mesh& m) {
    const auto all_below = [](const auto& values, std::size_t end) {
        return std::all_of(values.begin(), values.end(), [&](auto v) { return v < end; });
    };
    return m.surface_of_triangle.size() == m.triangles.size() &&
           (m.normals.empty() || m.normals.size() == m.vertices_m.size()) &&
           (m.uvs.empty() || m.uvs.size() == m.vertices_m.size()) &&
           (m.colors.empty() || m.colors.size() == m.vertices_m.size()) &&
           all_below(m.surface_of_triangle, m.surfaces.size()) &&
           std::all_of(m.triangles.begin(), m.triangles.end(),
                       [&](const auto& t) { return all_below(t, m.vertices_m.size()); }) &&
           std::all_of(m.surfaces.begin(), m.surfaces.end(), [&](const MeshSurface& s) {
               return s.base_color_texture < static_cast<int>(m.textures.size()) && s.refractive_index >= 1 &&
                      s.refractive_index <= 4 && s.opacity >= 0 && s.opacity <= 1 && s.transmission >= 0 &&
                      s.transmission <= 1;
           });
}

Mesh read_mesh(ConfinedResult& in) {
    Mesh m;
    m.vertices_m = in.list<Vec3f>();
    m.normals = in.list<Vec3f>();
    m.uvs = in.list<Vec2f>();
    m.colors = in.list<Vec3f>();
    m.triangles = in.list<std::array<std::uint32_t, 3>>();
    m.surface_of_triangle = in.list<std::uint16_t>();
    for (auto left = in.value<std::size_t>(); left > 0; --left) m.surfaces.push_back(read_surface(in));
    for (auto left = in.value<std::size_t>(); left > 0; --left) m.textures.push_back(read_texture(in));
    for (auto left = in.value<std::size_t>(); left > 0; --left) m.left_out.push_back(in.text());
    if (!is_whole(m)) in.refuse();
    return m;
}

void write_nodes(const std::vector<MeshNode>& nodes, ConfinedOutput& out) {
    out.value(nodes.size());
    for (const MeshNode& node : nodes) {
        out.text(node.name);
        out.value(node.depth);
        out.value(node.triangles);
    }
}

std::vector<MeshNode> read_nodes(ConfinedResult& in) {
    std::vector<MeshNode> nodes;
    for (auto left = in.value<std::size_t>(); left > 0; --left) {
        MeshNode& node = nodes.emplace_back();
        node.name = in.text();
        node.depth = in.value<std::uint32_t>();
        node.triangles = in.value<std::uint64_t>();
    }
    return nodes;
}

// Shapes of small bodies have no nodes; a shape kernel tells its segments in their place.
bool is_shape(const std::string& kind) { return kind == ".bds" || is_shape_table(kind); }

MeshContents shape_contents(const std::filesystem::path& file, const std::string& kind,
                            std::optional<int> surface) {
    const std::string bytes = read_input_file(file, mesh_kind());
    if (kind != ".bds") return {read_shape_table(bytes, file.string()), {}, 0};
    MeshContents out;
    std::uint64_t plates = 0;
    out.mesh = read_dsk_shape(bytes, file.string(), surface);
    for (const DskSegment& segment : dsk_segments(bytes, file.string())) {
        out.nodes.push_back({"surface " + std::to_string(segment.surface) + " of body " +
                                 std::to_string(segment.body) + ", frame " + std::to_string(segment.frame),
                             0, segment.plates});
        if (!surface || segment.surface == *surface) plates += segment.plates;
    }
    out.collapsed_triangles = plates - out.mesh.triangles.size();
    return out;
}

// Has `work` read the file in a child process; it gets the file's kind.
template <class Work>
ConfinedResult read_confined(const std::filesystem::path& file, std::optional<int> surface,
                             const Work& work) {
    std::string kind = file.extension().string();
    std::transform(kind.begin(), kind.end(), kind.begin(), [](unsigned char c) { return std::tolower(c); });
    const std::array<std::string, 9> kinds = {".glb", ".gltf", ".obj", ".stl", ".ply",
                                              ".tab", ".plt",  ".icq", ".bds"};
    std::error_code error;
    if (!std::filesystem::exists(file, error)) throw InputError(file.string() + ": no such mesh file");
    if (std::find(kinds.begin(), kinds.end(), kind) == kinds.end())
        throw refused(file.string(), "a file of kind " + in_quotes(kind),
                      ".glb .gltf .obj .stl .ply .tab .plt .icq .bds");
    if (surface && kind != ".bds")
        throw refused(file.string(), "the surface " + std::to_string(*surface),
                      "none: only shape kernels (.bds) have surfaces by number");
    const std::uint64_t bytes = open_input_file(file, mesh_kind()).bytes;
    const ConfinedLimits limits{kMinMemory_bytes + kMeshMemoryPerByte * bytes,
                                kMinCpu_s + kMeshCpu_s_byte * static_cast<double>(bytes)};
    return run_confined(file.string(), limits, mesh_folders(file),
                        [&](ConfinedOutput& out) { work(kind, out); });
}

}  // namespace

MeshContents load_mesh_contents(const std::filesystem::path& file, std::optional<int> surface) {
    ConfinedResult result = read_confined(file, surface, [&](const std::string& kind, ConfinedOutput& out) {
        const MeshContents contents =
            is_shape(kind) ? shape_contents(file, kind, surface) : import_mesh_contents(file, kind);
        write_mesh(contents.mesh, out);
        write_nodes(contents.nodes, out);
        out.value(contents.collapsed_triangles);
        out.value(contents.missing_materials.size());
        for (const std::string& name : contents.missing_materials) out.text(name);
    });
    MeshContents contents;
    contents.mesh = read_mesh(result);
    contents.nodes = read_nodes(result);
    contents.collapsed_triangles = result.value<std::uint64_t>();
    for (auto left = result.value<std::size_t>(); left > 0; --left)
        contents.missing_materials.push_back(result.text());
    return contents;
}

Mesh load_mesh(const std::filesystem::path& file) { return std::move(load_mesh_parts(file, {}).front()); }

std::vector<Mesh> load_mesh_parts(const std::filesystem::path& file, std::span<const std::string> nodes,
                                  std::optional<int> surface) {
    ConfinedResult result = read_confined(file, surface, [&](const std::string& kind, ConfinedOutput& out) {
        if (is_shape(kind)) {
            if (!nodes.empty())
                throw refused(file.string(), "the node " + in_quotes(nodes[0]), "none: it has no nodes");
            write_mesh(shape_contents(file, kind, surface).mesh, out);
            return;
        }
        for (const Mesh& mesh : import_mesh_parts(file, kind, nodes)) write_mesh(mesh, out);
    });
    std::vector<Mesh> meshes;
    for (std::size_t part = 0; part <= nodes.size(); ++part) meshes.push_back(read_mesh(result));
    return meshes;
}

}  // namespace hilcam
