#include "render/scene/ground_sun.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <limits>

namespace hilcam {
namespace {

constexpr int kQuads = GroundNormals::kQuads, kSide = kQuads + 1;
using Seen = std::array<std::uint8_t, kSide * kSide>;  // 1: the vertex sees the Sun

Seen seen_from_tile(const EmbreeScene& embree, const PreparedMesh& tree, const Mesh& mesh, std::size_t first,
                    Vec3f sun) {
    Seen seen{};
    // Above the ground by a hundredth of an edge, so that no triangle at the vertex hides it.
    constexpr float kAbove = 0.01f;
    const float above_m = kAbove * length(mesh.vertices_m[first + 1] - mesh.vertices_m[first]);
    for (std::size_t i = 0; i < seen.size(); i += kPacketSize) {
        RayPacket rays;
        rays.count = static_cast<int>(std::min<std::size_t>(kPacketSize, seen.size() - i));
        for (int k = 0; k < rays.count; ++k) {
            const std::size_t v = first + i + static_cast<std::size_t>(k);
            rays.set(k, mesh.vertices_m[v] + above_m * mesh.normals[v], sun, 0,
                     std::numeric_limits<float>::infinity());
        }
        const std::uint32_t blocked = embree.occluded_by(tree, rays);
        for (int k = 0; k < rays.count; ++k) {
            const std::size_t v = i + static_cast<std::size_t>(k);
            seen[v] = (blocked >> k & 1u) == 0 && dot(mesh.normals[first + v], sun) > 0 ? 1 : 0;
        }
    }
    return seen;
}

// Returns what those around a quadrilateral in the tile have seen.
KnownSun known_of(const Seen& seen, int x, int y) {
    int lit = 0, all = 0;
    for (int j = std::max(0, y - 1); j <= std::min(kQuads, y + 2); ++j)
        for (int i = std::max(0, x - 1); i <= std::min(kQuads, x + 2); ++i, ++all)
            lit += seen[static_cast<std::size_t>(j * kSide + i)];
    return lit == all ? KnownSun::kLit : lit == 0 ? KnownSun::kDark : KnownSun::kAsk;
}

}  // namespace

std::vector<KnownSun> known_sun(const EmbreeScene& embree, const PreparedMesh& tree,
                                const TerrainMesh& terrain, Vec3d sun_dir) {
    const Mesh& mesh = terrain.mesh;
    const GroundNormals& normals = *terrain.normals;
    std::vector<KnownSun> known(mesh.triangles.size(), KnownSun::kAsk);
    // Those of a tile follow each other, the first of its first triangle being the first of all.
    const auto first_vertex = [&](std::size_t tile) -> std::size_t {
        return mesh.triangles[tile * normals.triangles_per_tile][0];
    };
    tbb::parallel_for(std::size_t{0}, normals.tiles.size(), [&](std::size_t tile) {
        const Seen seen = seen_from_tile(embree, tree, mesh, first_vertex(tile), to_float(sun_dir));
        KnownSun* const at = known.data() + tile * normals.triangles_per_tile;
        for (int y = 0; y < kQuads; ++y)
            for (int x = 0; x < kQuads; ++x) {
                const auto k = static_cast<std::size_t>(2 * (y * kQuads + x));
                at[k] = at[k + 1] = known_of(seen, x, y);
            }
    });
    return known;
}

}  // namespace hilcam
