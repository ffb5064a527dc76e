#include "io/files/mesh_level_cache.h"

#include <unistd.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <string>
#include <type_traits>

namespace hilcam {
namespace {

// Raised when coarser_levels() makes other levels of the same mesh.
constexpr std::uint32_t kVersion = 3;

// Of all that a level is made of: FNV-1a (Fowler, Noll & Vo, 1991) over words.
std::uint64_t hash_of(const Mesh& mesh) {
    std::uint64_t hash = 14695981039346656037u;
    const auto add = [&](const auto& values) {
        const auto* bytes = reinterpret_cast<const unsigned char*>(values.data());
        const std::size_t size = values.size() * sizeof(values[0]);
        for (std::size_t i = 0; i < size; i += 8) {
            std::uint64_t word = 0;
            std::memcpy(&word, bytes + i, std::min<std::size_t>(8, size - i));
            hash = (hash ^ word) * 1099511628211u;
        }
        hash = (hash ^ size) * 1099511628211u;
    };
    add(mesh.vertices_m);
    add(mesh.normals);
    add(mesh.uvs);
    add(mesh.triangles);
    add(mesh.surface_of_triangle);
    return hash;
}

struct Header {
    std::array<char, 8> magic = {'h', 'i', 'l', 'c', 'a', 'm', 'L', 'D'};
    std::uint32_t version = kVersion;
    std::uint32_t levels = 0;
    std::uint64_t hash = 0;
    bool operator==(const Header&) const = default;
};

class Writer {
  public:
    explicit Writer(const std::filesystem::path& file) : out_(file, std::ios::binary) {}
    template <class T>
    void value(const T& v) {
        static_assert(std::is_trivially_copyable_v<T>);
        out_.write(reinterpret_cast<const char*>(&v), sizeof v);
    }
    template <class T>
    void list(const std::vector<T>& values) {
        value(static_cast<std::uint64_t>(values.size()));
        out_.write(reinterpret_cast<const char*>(values.data()),
                   static_cast<std::streamsize>(values.size() * sizeof(T)));
    }
    bool good() { return static_cast<bool>(out_.flush()); }

  private:
    std::ofstream out_;
};

class Reader {
  public:
    explicit Reader(const std::filesystem::path& file) : in_(file, std::ios::binary) {}
    template <class T>
    bool value(T& v) {
        static_assert(std::is_trivially_copyable_v<T>);
        return static_cast<bool>(in_.read(reinterpret_cast<char*>(&v), sizeof v));
    }
    // At most `most` elements: a level is never larger than its mesh.
    template <class T>
    bool list(std::vector<T>& values, std::size_t most) {
        std::uint64_t size = 0;
        if (!value(size) || size > most) return false;
        values.resize(size);
        return static_cast<bool>(
            in_.read(reinterpret_cast<char*>(values.data()), static_cast<std::streamsize>(size * sizeof(T))));
    }

  private:
    std::ifstream in_;
};

bool read_level(Reader& in, const Mesh& mesh, MeshLevel& level) {
    Mesh& m = level.mesh;
    m.surfaces = mesh.surfaces;
    if (!in.value(level.error_m) || !in.list(level.flattened_alpha, mesh.surfaces.size()) ||
        !in.list(m.vertices_m, mesh.vertices_m.size()) || !in.list(m.normals, mesh.vertices_m.size()) ||
        !in.list(m.uvs, mesh.vertices_m.size()) || !in.list(m.triangles, mesh.triangles.size()) ||
        !in.list(m.surface_of_triangle, mesh.triangles.size()))
        return false;
    if (level.flattened_alpha.size() != mesh.surfaces.size() ||
        m.surface_of_triangle.size() != m.triangles.size() ||
        (!m.normals.empty() && m.normals.size() != m.vertices_m.size()) ||
        (!m.uvs.empty() && m.uvs.size() != m.vertices_m.size()))
        return false;
    for (const auto& triangle : m.triangles)
        for (const std::uint32_t v : triangle)
            if (v >= m.vertices_m.size()) return false;
    for (const std::uint16_t s : m.surface_of_triangle)
        if (s >= mesh.surfaces.size()) return false;
    return true;
}

bool read_levels(const std::filesystem::path& file, std::uint64_t hash, const Mesh& mesh,
                 std::vector<MeshLevel>& levels) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(file, error)) return false;
    Reader in(file);
    Header header;
    Header expected;
    expected.hash = hash;
    if (!in.value(header) || header.levels > 16) return false;
    expected.levels = header.levels;
    if (header != expected) return false;
    levels.resize(header.levels);
    for (MeshLevel& level : levels)
        if (!read_level(in, mesh, level)) return false;
    return true;
}

// Beside it first, then renamed: two programs may do this at once.
void write_levels(const std::filesystem::path& file, std::uint64_t hash,
                  const std::vector<MeshLevel>& levels) {
    std::error_code ignored;
    std::filesystem::create_directories(file.parent_path(), ignored);
    const std::filesystem::path beside = file.string() + "." + std::to_string(::getpid());
    Writer out(beside);
    Header header;
    header.levels = static_cast<std::uint32_t>(levels.size());
    header.hash = hash;
    out.value(header);
    for (const MeshLevel& level : levels) {
        out.value(level.error_m);
        out.list(level.flattened_alpha);
        out.list(level.mesh.vertices_m);
        out.list(level.mesh.normals);
        out.list(level.mesh.uvs);
        out.list(level.mesh.triangles);
        out.list(level.mesh.surface_of_triangle);
    }
    if (out.good())
        std::filesystem::rename(beside, file, ignored);
    else
        std::filesystem::remove(beside, ignored);
}

}  // namespace

std::vector<MeshLevel> cached_levels(const Mesh& mesh, const std::filesystem::path& folder) {
    const std::uint64_t hash = hash_of(mesh);
    const std::filesystem::path file = folder / ("levels_" + std::to_string(hash) + ".bin");
    std::vector<MeshLevel> levels;
    if (read_levels(file, hash, mesh, levels)) return levels;
    levels = coarser_levels(mesh);
    write_levels(file, hash, levels);
    return levels;
}

}  // namespace hilcam
