#include "render/ground/globe_terrain.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "render/ground/cube_sphere.h"

namespace hilcam {
namespace {

// Quadrilaterals along the edge of a tile in a mesh.
constexpr std::size_t kSeenQuads = GroundTile::kQuads, kBesideQuads = GroundTile::kSketchQuads;
// The distances over which a vertex moves to the coarser level, relative to those at which tiles of its level
// are used.
constexpr double kMorphFrom = 1.5, kMorphTo = 2;
// A tile must be narrower than the distance range before kMorphFrom, so it needs at least this ratio of
// distance to edge.
constexpr double kMinEdges = 128;
constexpr int kFinestLevel = 27;
// Number of sketches that keep their texels, 0.25 MB each, until the mesh is made.
constexpr std::size_t kMaxTexels = 128;

}  // namespace

GlobeTerrain::GlobeTerrain(const Figure& figure, std::vector<GroundMap> maps,
                           std::vector<std::unique_ptr<const GroundDetail>> details,
                           const GlobeSettings& settings)
    : surface_(figure, std::move(maps), settings.max_bytes / 2),
      details_(std::move(details)),
      maker_(surface_, details_, settings.hapke),
      max_tiles_(settings.max_bytes * 3 / 8 / tile_bytes()),
      max_sketches_(settings.max_bytes / 8 / sketch_bytes()),
      finest_level_(0) {
    while (finest_level_ < kFinestLevel && maker_.spacing_m(finest_level_) > settings.finest_m)
        ++finest_level_;
}

Vec3d GlobeTerrain::up_at(Vec3d p) const {
    const Figure& f = surface_.figure();
    const double ratio = f.equatorial_radius_m / f.polar_radius_m;
    return length(p) > 0 ? normalized(Vec3d{p.x, p.y, p.z * ratio * ratio}) : Vec3d{0, 0, 1};
}

// Returns the missing tiles, up to the number that may be made. all: false if more are missing.
std::vector<GroundTileKey> GlobeTerrain::to_be_made(std::span<const GroundTileKey> keys, const Tiles& of,
                                                    bool& all) {
    std::vector<GroundTileKey> missing;
    for (const GroundTileKey& key : keys)
        if (!of.contains(key.word())) missing.push_back(key);
    all = missing.size() <= may_make_;
    if (!all) missing.resize(may_make_);
    if (may_make_ != kAnyNumber) may_make_ -= missing.size();
    return missing;
}

void GlobeTerrain::mark_used(std::span<const GroundTileKey> keys, const Tiles& of) const {
    for (const GroundTileKey& key : keys) of.at(key.word())->used = mesh_number_;
}

// Makes missing sketches. Returns false if some are still missing.
bool GlobeTerrain::require_sketches(std::span<const GroundTileKey> keys) {
    bool all;
    const std::vector<GroundTileKey> missing = to_be_made(keys, sketches_, all);
    std::vector<std::unique_ptr<GroundTile>> made = maker_.sketch(missing);
    for (std::size_t i = 0; i < made.size(); ++i) {
        with_texels_.push_back(made[i].get());
        sketches_[missing[i].word()] = std::move(made[i]);
    }
    keep_texels(kMaxTexels);
    mark_used(all ? keys : missing, sketches_);
    return all;
}

// Makes missing tiles from their sketches. Returns false if some are still missing.
bool GlobeTerrain::require_tiles(std::span<const GroundTileKey> keys) {
    bool all;
    const std::vector<GroundTileKey> missing = to_be_made(keys, tiles_, all);
    std::vector<const GroundTile*> sketches;
    sketches.reserve(missing.size());
    for (const GroundTileKey& key : missing) sketches.push_back(sketches_[key.word()].get());
    std::vector<std::unique_ptr<GroundTile>> made = maker_.make(missing, sketches);
    for (std::size_t i = 0; i < made.size(); ++i) tiles_[missing[i].word()] = std::move(made[i]);
    mark_used(all ? keys : missing, tiles_);
    return all;
}

// Only the latest sketches keep their texels.
void GlobeTerrain::keep_texels(std::size_t most) {
    for (; with_texels_.size() > most; with_texels_.pop_front()) with_texels_.front()->texels.reset();
}

// True outside the field or behind the ground's horizon.
bool GlobeTerrain::is_outside(const TerrainView& view, const GroundTile& tile) const {
    const Vec3d to_tile = tile.middle_m - view.camera_m;
    const double distance = length(to_tile);
    if (distance <= tile.radius_m) return false;
    const double off_rad = angle_between_rad(to_tile, view.boresight);
    if (off_rad - std::asin(tile.radius_m / distance) > view.half_field_rad) return true;
    // Ground lower than this share of the ellipsoid hides less than assumed.
    constexpr double kLowest = 0.99;
    const double horizon_m = kLowest * surface_.figure().polar_radius_m;
    const double camera_m = length(view.camera_m), middle_m = length(tile.middle_m);
    const double top_m = middle_m + tile.radius_m;
    if (camera_m <= horizon_m || tile.radius_m >= middle_m) return false;
    const double apart_rad =
        angle_between_rad(view.camera_m, tile.middle_m) - std::asin(tile.radius_m / middle_m);
    return apart_rad > std::acos(horizon_m / camera_m) + std::acos(std::min(1.0, horizon_m / top_m));
}

std::size_t GlobeTerrain::triangles_of(std::span<const Leaf> leaves) {
    std::size_t sum = 0;
    for (const Leaf& leaf : leaves) sum += MeshGrid::triangles(leaf.outside ? kBesideQuads : kSeenQuads);
    return sum;
}

// Selects the tiles to show. edges: the ratio of distance to triangle edge from which a tile is fine enough.
GlobeTerrain::Selected GlobeTerrain::select(const TerrainView& view, double edges, std::size_t max_triangles,
                                            std::vector<Leaf>& leaves) {
    leaves.clear();
    std::vector<GroundTileKey> wave;
    wave.reserve(kCubeFaces);
    for (int face = 0; face < kCubeFaces; ++face) wave.push_back({face, 0, 0, 0});
    while (!wave.empty()) {
        if (triangles_of(leaves) + wave.size() * MeshGrid::triangles(kBesideQuads) > max_triangles)
            return Selected::kTooManyTriangles;
        if (!require_sketches(wave)) return Selected::kNotYet;
        std::vector<GroundTileKey> next;
        for (const GroundTileKey& key : wave) {
            const GroundTile& tile = *sketches_[key.word()];
            const double distance_m = length(view.camera_m - tile.middle_m) - tile.radius_m;
            const bool outside = is_outside(view, tile);
            const double reach_m = maker_.spacing_m(key.level) * edges / (outside ? kOutside : 1.0);
            if (key.level < finest_level_ && distance_m < reach_m)
                for (int k = 0; k < 4; ++k) next.push_back(key.child(k));
            else
                leaves.push_back({key, &tile, outside});
        }
        wave = std::move(next);
    }
    if (triangles_of(leaves) > max_triangles) return Selected::kTooManyTriangles;
    // Visible tiles come first; they need more than their sketches.
    const auto beside =
        std::stable_partition(leaves.begin(), leaves.end(), [](const Leaf& leaf) { return !leaf.outside; });
    std::vector<GroundTileKey> seen;
    for (auto leaf = leaves.begin(); leaf != beside; ++leaf) seen.push_back(leaf->key);
    if (!require_tiles(seen)) return Selected::kNotYet;
    for (auto leaf = leaves.begin(); leaf != beside; ++leaf) leaf->tile = tiles_[leaf->key.word()].get();
    return Selected::kAll;
}

// Drops the least recently used tiles, but none used since a mesh. Returns false if too many remain.
bool GlobeTerrain::forget_oldest(Tiles& tiles, std::size_t most, std::uint64_t before) {
    if (tiles.size() <= most) return true;
    std::vector<std::pair<std::uint64_t, std::uint64_t>> by_age;
    for (const auto& [word, tile] : tiles) by_age.push_back({tile->used, word});
    std::sort(by_age.begin(), by_age.end());
    for (std::size_t i = 0; i < by_age.size() && tiles.size() > most && by_age[i].first < before; ++i)
        tiles.erase(by_age[i].second);
    return tiles.size() <= most;
}

// Finds the tiles to show, and the ratio at which there are not too many. Returns false if some are not made
// yet.
bool GlobeTerrain::find_leaves(const TerrainView& view, double& edges, std::vector<Leaf>& leaves) {
    edges = std::max(kMinEdges, 1 / (view.edge_px * view.pixel_rad));
    Selected selected = select(view, edges, view.max_triangles, leaves);
    while (selected == Selected::kTooManyTriangles) {
        const bool least = edges == kMinEdges;
        edges = std::max(kMinEdges, 0.9 * edges);
        selected =
            select(view, edges, least ? std::numeric_limits<std::size_t>::max() : view.max_triangles, leaves);
    }
    return selected == Selected::kAll;
}

bool GlobeTerrain::make_ahead(const TerrainView& view) {
    constexpr std::size_t kTogether = 4;
    const bool room = max_tiles_ > kTogether && max_sketches_ > kTogether &&
                      forget_oldest(tiles_, max_tiles_ - kTogether, mesh_number_) &&
                      forget_oldest(sketches_, max_sketches_ - kTogether, mesh_number_);
    if (!room) return false;
    may_make_ = kTogether;
    double edges;
    std::vector<Leaf> leaves;
    const bool all = find_leaves(view, edges, leaves);
    const bool made_any = may_make_ < kTogether;
    may_make_ = kAnyNumber;
    return !all || made_any;
}

TerrainMesh GlobeTerrain::mesh(const TerrainView& view) {
    ++mesh_number_;
    double edges;
    std::vector<Leaf> leaves;
    find_leaves(view, edges, leaves);
    TerrainMesh out = assemble(view, edges, leaves);
    keep_texels(0);
    forget_oldest(tiles_, max_tiles_, mesh_number_ + 1);
    forget_oldest(sketches_, max_sketches_, mesh_number_ + 1);
    return out;
}

TerrainMesh GlobeTerrain::assemble(const TerrainView& view, double edges,
                                   const std::vector<Leaf>& leaves) const {
    TerrainMesh out;
    double nearest_m = 1e300;
    for (const Leaf& leaf : leaves)
        if (length(leaf.tile->middle_m - view.camera_m) - leaf.tile->radius_m < nearest_m)
            for (const GroundTile::Look& look : leaf.tile->own) {
                const Vec3d point_m = leaf.tile->middle_m + to_double(look.point_m);
                const double distance_m = length(point_m - view.camera_m);
                if (distance_m < nearest_m) nearest_m = distance_m, out.anchor_m = point_m;
            }
    const auto seen = static_cast<std::size_t>(
        std::count_if(leaves.begin(), leaves.end(), [](const Leaf& leaf) { return !leaf.outside; }));
    const std::size_t beside = leaves.size() - seen;
    Mesh& mesh = out.mesh;
    for (std::size_t i = 0, vertex = 0, triangle = 0; i < leaves.size(); ++i) {
        const std::size_t quads = i < seen ? kSeenQuads : kBesideQuads;
        out.grids.push_back({static_cast<std::uint32_t>(vertex), static_cast<std::uint32_t>(triangle),
                             static_cast<std::uint32_t>(quads)});
        vertex += MeshGrid::vertices(quads), triangle += MeshGrid::triangles(quads);
    }
    mesh.vertices_m.resize(seen * MeshGrid::vertices(kSeenQuads) + beside * MeshGrid::vertices(kBesideQuads));
    mesh.normals.resize(mesh.vertices_m.size());
    if (surface_.has(GroundKind::kAlbedo) || !details_.empty()) mesh.colors.resize(mesh.vertices_m.size());
    if (surface_.has_hapke()) mesh.hapke.resize(mesh.vertices_m.size());
    mesh.triangles.resize(triangles_of(leaves));
    mesh.surface_of_triangle.assign(mesh.triangles.size(), 0);
    mesh.surfaces.resize(1);
    auto normals = std::make_shared<GroundNormals>();
    normals->tiles.resize(seen);
    normals->triangles_per_tile = static_cast<std::uint32_t>(MeshGrid::triangles(kSeenQuads));
    tbb::parallel_for(std::size_t{0}, leaves.size(), [&](std::size_t i) {
        Shares shares;
        find_shares(view, edges, leaves[i], shares);
        append(leaves[i], shares, out.anchor_m, out.grids[i], mesh);
        if (i >= seen) return;
        GroundNormals::Tile& tile = normals->tiles[i];
        tile.own = leaves[i].tile->own_normals, tile.above = leaves[i].tile->above_normals;
        std::transform(shares.begin(), shares.end(), tile.share.begin(),
                       [](float share) { return static_cast<std::uint8_t>(255 * share + 0.5f); });
    });
    out.normals = std::move(normals);
    return out;
}

// Finds, for each vertex, the weight of the coarser level's ground.
void GlobeTerrain::find_shares(const TerrainView& view, double edges, const Leaf& leaf,
                               Shares& shares) const {
    const GroundTile& tile = *leaf.tile;
    const double reach_m = maker_.spacing_m(leaf.key.level) * edges;
    if (length(tile.middle_m - view.camera_m) + tile.radius_m < kMorphFrom * reach_m) return shares.fill(0);
    for (std::size_t i = 0; i < tile.above.size(); ++i) {
        const double distance_m = length(tile.middle_m + to_double(tile.above[i].point_m) - view.camera_m);
        shares[i] = static_cast<float>(
            std::clamp((distance_m / reach_m - kMorphFrom) / (kMorphTo - kMorphFrom), 0.0, 1.0));
    }
}

void GlobeTerrain::append(const Leaf& leaf, const Shares& shares, Vec3d anchor_m, const MeshGrid& grid,
                          Mesh& mesh) const {
    const GroundTile& tile = *leaf.tile;
    const std::size_t inner = static_cast<std::size_t>(tile.quads) + 1, side = MeshGrid::side(grid.quads);
    const auto vertex = [&](std::size_t x, std::size_t y) { return grid.first_vertex + y * side + x; };
    const Vec3d shift_m = tile.middle_m - anchor_m;
    for (std::size_t i = 0; i < inner * inner; ++i) {
        const std::size_t to = vertex(i % inner + 1, i / inner + 1);
        const GroundTile::Look& own = tile.own[i];
        const GroundTile::Look& above = tile.above[i];
        const float share = shares[i];
        const Vec3d own_m = to_double(own.point_m), above_m = to_double(above.point_m);
        mesh.vertices_m[to] = to_float(shift_m + (own_m + static_cast<double>(share) * (above_m - own_m)));
        mesh.normals[to] = normalized(own.normal + share * (above.normal - own.normal));
        if (!mesh.colors.empty()) mesh.colors[to] = own.color + share * (above.color - own.color);
        if (!mesh.hapke.empty())
            mesh.hapke[to] = blend(tile.own_hapke[i], 1 - share, tile.above_hapke[i], share, {}, 0);
    }
    const Vec3f down =
        to_float(-maker_.spacing_m(leaf.key.level) * (kSeenQuads / grid.quads) * up_at(tile.middle_m));
    for (std::size_t y = 0; y < side; ++y)
        for (std::size_t x = 0; x < side; x += y == 0 || y + 1 == side ? 1 : side - 1) {
            const std::size_t from = vertex(std::clamp<std::size_t>(x, 1, inner),
                                            std::clamp<std::size_t>(y, 1, inner)),
                              to = vertex(x, y);
            mesh.vertices_m[to] = mesh.vertices_m[from] + down;
            mesh.normals[to] = mesh.normals[from];
            if (!mesh.colors.empty()) mesh.colors[to] = mesh.colors[from];
            if (!mesh.hapke.empty()) mesh.hapke[to] = mesh.hapke[from];
        }
    const auto step = static_cast<std::uint32_t>(side);
    grid.for_each_quad([&](std::uint32_t triangle, std::uint32_t corner) {
        mesh.triangles[triangle] = {corner, corner + 1, corner + step};
        mesh.triangles[triangle + 1] = {corner + 1, corner + step + 1, corner + step};
    });
}

}  // namespace hilcam
