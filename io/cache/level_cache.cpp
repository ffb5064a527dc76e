#include "io/cache/level_cache.h"

#include <array>
#include <cstdint>
#include <string>

namespace hilcam {
namespace {

// Raise this when coarser_levels() makes other levels of the same mesh.
constexpr std::uint32_t kLevelsVersion = 9;

struct LevelsHeader {
    std::array<char, 8> magic = {'h', 'i', 'l', 'c', 'a', 'm', 'L', 'D'};
    std::uint32_t version = kLevelsVersion;
    std::uint32_t levels = 0;
    std::uint64_t hash = 0;
    bool operator==(const LevelsHeader&) const = default;
};

bool read_level(CacheReader& in, const Mesh& mesh, MeshLevel& level) {
    Mesh& m = level.mesh;
    m.surfaces = mesh.surfaces;
    in(level.error_m), in(level.flattened_alpha), in(m.vertices_m), in(m.normals), in(m.uvs), in(m.triangles),
        in(m.surface_of_triangle), in(level.lod_normals);
    if (!in.good()) return false;
    if (level.flattened_alpha.size() != mesh.surfaces.size() ||
        m.surface_of_triangle.size() != m.triangles.size() ||
        level.lod_normals.size() != m.triangles.size() ||
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

bool read_levels(CacheReader& in, std::uint64_t hash, const Mesh& mesh, std::vector<MeshLevel>& levels) {
    LevelsHeader header;
    LevelsHeader expected;
    in(header);
    expected.hash = hash;
    if (!in.good() || header.levels > 16) return false;
    expected.levels = header.levels;
    if (header != expected) return false;
    levels.resize(header.levels);
    for (MeshLevel& level : levels)
        if (!read_level(in, mesh, level)) return false;
    return true;
}

void write_levels(CacheWriter& out, std::uint64_t hash, const std::vector<MeshLevel>& levels) {
    LevelsHeader header;
    header.levels = static_cast<std::uint32_t>(levels.size());
    header.hash = hash;
    out(header);
    for (const MeshLevel& level : levels) {
        const Mesh& m = level.mesh;
        out(level.error_m), out(level.flattened_alpha), out(m.vertices_m), out(m.normals), out(m.uvs),
            out(m.triangles), out(m.surface_of_triangle), out(level.lod_normals);
    }
}

}  // namespace

std::vector<MeshLevel> cached_levels(const Mesh& mesh, const Cache& cache) {
    const std::uint64_t hash = hash_of(mesh);
    const std::string name = "levels_" + std::to_string(hash) + ".bin";
    std::vector<MeshLevel> levels;
    if (cache.read(name, [&](CacheReader& in) { return read_levels(in, hash, mesh, levels); })) return levels;
    levels = coarser_levels(mesh);
    cache.write(name, [&](CacheWriter& out) { write_levels(out, hash, levels); });
    return levels;
}

}  // namespace hilcam
