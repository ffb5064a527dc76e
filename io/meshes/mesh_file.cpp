#include "io/meshes/mesh_file.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <span>

#include "io/meshes/dsk_shape.h"
#include "io/meshes/mesh_import.h"
#include "io/meshes/shape_table.h"
#include "io/system/confined.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/quoted.h"

namespace hilcam {
namespace {

// Memory that any mesh may take: a node or a material takes more than a kilobyte, and libraries have tables.
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

// Checks everything that could mislead code that uses the mesh, because the file may have corrupted the
// child.
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

void write_texts(const std::vector<std::string>& texts, ConfinedOutput& out) {
    out.value(texts.size());
    for (const std::string& text : texts) out.text(text);
}

std::vector<std::string> read_texts(ConfinedResult& in) {
    std::vector<std::string> texts;
    for (auto left = in.value<std::size_t>(); left > 0; --left) texts.push_back(in.text());
    return texts;
}

void write_contents(const MeshContents& contents, ConfinedOutput& out) {
    write_mesh(contents.mesh, out);
    write_nodes(contents.nodes, out);
    out.value(contents.collapsed_triangles);
    out.value(contents.opposed_facets);
    out.value(contents.leaning_facets);
    write_texts(contents.missing_materials, out);
    write_texts(contents.unreadable_textures, out);
    write_texts(contents.remarks, out);
}

MeshContents read_contents(ConfinedResult& in) {
    MeshContents contents;
    contents.mesh = read_mesh(in);
    contents.nodes = read_nodes(in);
    contents.collapsed_triangles = in.value<std::uint64_t>();
    contents.opposed_facets = in.value<std::uint64_t>();
    contents.leaning_facets = in.value<std::uint64_t>();
    contents.missing_materials = read_texts(in);
    contents.unreadable_textures = read_texts(in);
    contents.remarks = read_texts(in);
    return contents;
}

// Writes the files that the parent has to examine, before any result.
void write_wanted(const std::vector<FileName>& wanted, ConfinedOutput& out) {
    out.value(wanted.size());
    for (const FileName& name : wanted) {
        out.text(name.name);
        out.value(name.folders.size());
        for (const std::filesystem::path& folder : name.folders) out.text(folder.string());
    }
}

std::vector<FileName> read_wanted(ConfinedResult& in) {
    std::vector<FileName> wanted;
    auto left = in.value<std::size_t>();
    if (left > kMaxWantedFiles) in.refuse();
    for (; left > 0; --left) {
        FileName& name = wanted.emplace_back();
        name.name = in.text();
        for (auto folders = in.value<std::size_t>(); folders > 0; --folders)
            name.folders.emplace_back(in.text());
    }
    return wanted;
}

// Shapes of small bodies have no nodes; a shape kernel lists its segments instead.
bool is_shape_kernel(const std::string& kind) { return kind == ".bds" || kind == ".xds"; }
bool is_shape(const std::string& kind) { return is_shape_kernel(kind) || is_shape_table(kind); }

// Reads the label beside a table, which has the same name with another ending.
Longitudes labelled_longitudes(const std::filesystem::path& table) {
    const InputKind kind{1u << 20, "a PDS label"};
    for (const char* ending : {".lbl", ".LBL", ".Lbl"}) {
        std::filesystem::path label = table;
        std::error_code error;
        if (std::filesystem::is_regular_file(label.replace_extension(ending), error))
            return longitudes_of_label(read_input_file(label, kind));
    }
    return Longitudes::kUnsaid;
}

MeshContents shape_contents(const std::filesystem::path& file, const std::string& kind,
                            std::optional<int> surface) {
    const std::string bytes = read_input_file(file, mesh_kind());
    if (!is_shape_kernel(kind)) {
        MeshContents out;
        out.mesh = read_shape_table(bytes, file.string(), labelled_longitudes(file), &out.remarks);
        return out;
    }
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

// Returns the ending of a mesh file in lower case. Throws InputError for an unknown one.
std::string required_kind(const std::filesystem::path& file, std::optional<int> surface) {
    std::string kind = file.extension().string();
    std::transform(kind.begin(), kind.end(), kind.begin(), [](unsigned char c) { return std::tolower(c); });
    const std::array<std::string, 10> kinds = {".glb", ".gltf", ".obj", ".stl", ".ply",
                                               ".tab", ".plt",  ".icq", ".bds", ".xds"};
    std::error_code error;
    if (!std::filesystem::exists(file, error)) throw InputError(file.string() + ": no such mesh file");
    if (std::find(kinds.begin(), kinds.end(), kind) == kinds.end())
        throw refused(file.string(), "a file of kind " + in_quotes(kind),
                      ".glb .gltf .obj .stl .ply .tab .plt .icq .bds .xds");
    if (surface && !is_shape_kernel(kind))
        throw refused(file.string(), "the surface " + std::to_string(*surface),
                      "none: only shape kernels (.bds, .xds) have surfaces by number");
    return kind;
}

// Lets `import` read the file in a child process, with the file's kind and the files that the mesh names;
// `write` writes its result. When some of these files are outside the mesh's folders, the child reports them
// in place of a result. A second child may then read those that are permitted.
template <class Import, class Write>
ConfinedResult read_confined(const std::filesystem::path& file, std::optional<int> surface,
                             const Import& import, const Write& write) {
    const std::string kind = required_kind(file, surface);
    const std::uint64_t bytes = open_input_file(file, mesh_kind()).bytes;
    const ConfinedLimits limits{kMinMemory_bytes + kMeshMemoryPerByte * bytes,
                                kMinCpu_s + kMeshCpu_s_byte * static_cast<double>(bytes)};
    std::vector<std::filesystem::path> readable = mesh_folders(file);
    GrantedFiles granted;
    const auto work = [&](ConfinedOutput& out) {
        NamedFiles files(file, granted);
        std::optional<decltype(import(kind, files))> found;
        try {
            found = import(kind, files);
        } catch (const InputError&) {
            if (files.wanted().empty()) throw;
        }
        write_wanted(files.wanted(), out);
        if (files.wanted().empty()) write(*found, out);
    };
    // Materials outside may name textures outside. A child that keeps asking is broken.
    constexpr int kMaxRounds = 4;
    for (int round = 1;; ++round) {
        ConfinedResult result = run_confined(file.string(), limits, readable, work);
        const std::vector<FileName> wanted = read_wanted(result);
        if (wanted.empty()) return result;
        if (round == kMaxRounds) result.refuse();
        for (const FileName& name : wanted) {
            const GrantedFile& grant = granted[name] = granted_file(file, name);
            if (!grant.file.empty() && grant.refusal.empty()) readable.push_back(grant.file);
        }
    }
}

MeshContents import_contents(const std::string& kind, NamedFiles& files, std::optional<int> surface) {
    return is_shape(kind) ? shape_contents(files.mesh(), kind, surface) : import_mesh_contents(files, kind);
}

std::vector<Mesh> import_parts(const std::string& kind, NamedFiles& files, std::optional<int> surface,
                               std::span<const std::string> nodes) {
    if (!is_shape(kind)) return import_mesh_parts(files, kind, nodes);
    if (!nodes.empty())
        throw refused(files.mesh().string(), "the node " + in_quotes(nodes[0]), "none: it has no nodes");
    std::vector<Mesh> meshes;
    meshes.push_back(shape_contents(files.mesh(), kind, surface).mesh);
    return meshes;
}

}  // namespace

MeshContents load_mesh_contents(const std::filesystem::path& file, std::optional<int> surface) {
    ConfinedResult result = read_confined(
        file, surface,
        [&](const std::string& kind, NamedFiles& files) { return import_contents(kind, files, surface); },
        write_contents);
    return read_contents(result);
}

Mesh load_mesh(const std::filesystem::path& file) { return std::move(load_mesh_parts(file, {}).front()); }

std::vector<Mesh> load_mesh_parts(const std::filesystem::path& file, std::span<const std::string> nodes,
                                  std::optional<int> surface) {
    ConfinedResult result = read_confined(
        file, surface,
        [&](const std::string& kind, NamedFiles& files) { return import_parts(kind, files, surface, nodes); },
        [](const std::vector<Mesh>& meshes, ConfinedOutput& out) {
            for (const Mesh& mesh : meshes) write_mesh(mesh, out);
        });
    std::vector<Mesh> meshes;
    for (std::size_t part = 0; part <= nodes.size(); ++part) meshes.push_back(read_mesh(result));
    return meshes;
}

}  // namespace hilcam
