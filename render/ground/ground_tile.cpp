#include "render/ground/ground_tile.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "render/ground/cube_sphere.h"

namespace hilcam {
namespace {

constexpr int kTexels = GroundNormals::kTexels, kBorder = GroundTexels::kBorder;

GroundTile::Look between(const GroundTile::Look& a, const GroundTile::Look& b) {
    return {0.5f * (a.point_m + b.point_m), 0.5f * (a.normal + b.normal), 0.5f * (a.color + b.color)};
}

// Returns the weights of four nodes at a texel between the second and the third (Catmull & Rom, 1974).
std::array<double, 4> node_shares(int texel) {
    const double t = static_cast<double>(texel) / kTexels, t2 = t * t, t3 = t2 * t;
    return {0.5 * (-t3 + 2 * t2 - t), 0.5 * (3 * t3 - 5 * t2 + 2), 0.5 * (-3 * t3 + 4 * t2 + t),
            0.5 * (t3 - t2)};
}

// Adds values at the nodes to those at the texels, with smooth interpolation: rows first, then columns.
template <class T>
void add_between(const std::vector<T>& nodes, int node_side, int side, std::vector<T>& texels) {
    std::array<std::array<double, 4>, kTexels> shares;
    for (int t = 0; t < kTexels; ++t) shares[static_cast<std::size_t>(t)] = node_shares(t);
    // A colour is three numbers.
    using N = std::conditional_t<std::is_same_v<T, double>, double, float>;
    constexpr std::size_t kNumbers = std::is_same_v<T, double> ? 1 : 3;
    static_assert(sizeof(T) == kNumbers * sizeof(N));
    const auto blend = [&](const T* at, int texel) {
        const auto& s = shares[static_cast<std::size_t>(texel)];
        return static_cast<N>(s[0]) * at[0] + static_cast<N>(s[1]) * at[1] + static_cast<N>(s[2]) * at[2] +
               static_cast<N>(s[3]) * at[3];
    };
    const auto width = static_cast<std::size_t>(side);
    // The last texel is a node; it is computed at the end of the previous interval.
    const auto interval = [&](int k) { return std::min(k / kTexels, node_side - 4); };
    std::vector<T> rows(static_cast<std::size_t>(node_side) * width);
    for (int y = 0; y < node_side; ++y)
        for (int x = 0; x < side; ++x) {
            const T* const row = nodes.data() + y * node_side;
            rows[static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x)] =
                x / kTexels > interval(x) ? row[interval(x) + 2] : blend(row + interval(x), x % kTexels);
        }
    const auto numbers_of = [](auto* at) {
        if constexpr (kNumbers == 1)
            return at;
        else
            return &at->x;
    };
    const std::size_t step = kNumbers * width;
    for (int y = 0; y < side; ++y) {
        const N* const above = numbers_of(rows.data() + static_cast<std::size_t>(interval(y)) * width);
        N* const to = numbers_of(texels.data() + static_cast<std::size_t>(y) * width);
        const auto& shares_of = shares[static_cast<std::size_t>(y % kTexels)];
        const std::array<N, 4> s = {static_cast<N>(shares_of[0]), static_cast<N>(shares_of[1]),
                                    static_cast<N>(shares_of[2]), static_cast<N>(shares_of[3])};
        if (y / kTexels > interval(y))
            for (std::size_t k = 0; k < step; ++k) to[k] = to[k] + above[2 * step + k];
        else
            for (std::size_t k = 0; k < step; ++k)
                to[k] = to[k] + (s[0] * above[k] + s[1] * above[step + k] + s[2] * above[2 * step + k] +
                                 s[3] * above[3 * step + k]);
    }
}

// The weights of texels around a vertex: a tent as wide as the quadrilaterals.
constexpr std::array<double, 2 * kTexels - 1> kTent = {1, 2, 3, 4, 3, 2, 1};
static_assert(kTexels == 4);

}  // namespace

double GroundTileMaker::spacing_m(int level) const {
    return 0.5 * kPi * surface_.figure().equatorial_radius_m / std::ldexp(GroundTile::kQuads, level);
}

// Returns places on a square grid: texels first, first + step, ... of the tile, `side` along an edge.
std::vector<Vec3d> GroundTileMaker::places_of(const GroundTexels& grid, int step, int first, int side) const {
    const double tiles = std::ldexp(1, grid.key.level);
    const int texels = grid.quads * kTexels;
    const auto tangents_of = [&](std::int32_t tile) {
        std::vector<double> tangents;
        tangents.reserve(static_cast<std::size_t>(side));
        // A whole number over a power of two, so that neighbours have the same bits.
        for (int k = 0; k < side; ++k)
            tangents.push_back(cube_tangent(
                -1 + 2 * ((static_cast<double>(tile) * texels + first + step * k) / (tiles * texels))));
        return tangents;
    };
    const std::vector<double> across = tangents_of(grid.key.column), up = tangents_of(grid.key.row);
    std::vector<Vec3d> places;
    places.reserve(static_cast<std::size_t>(side * side));
    for (const double y : up)
        for (const double x : across) places.push_back(cube_direction_of_tangents(grid.key.face, {x, y}));
    return places;
}

// Reads the maps at the texels, or at the nodes if the maps are smooth in between. quads: along the tile's
// edge.
std::shared_ptr<GroundTexels> GroundTileMaker::lay(const GroundTileKey& key, int quads) {
    const double texel_m = spacing_m(key.level) * GroundTile::kQuads / quads / kTexels;
    auto out = std::make_shared<GroundTexels>();
    GroundTexels& grid = *out;
    grid.key = key, grid.quads = quads, grid.texel_m = texel_m;
    grid.by_nodes = texel_m * kTexels < 0.5 * surface_.finest_m();
    grid.places = places_of(grid, 1, -kBorder, grid.side());
    grid.heights_m.assign(grid.places.size(), 0);
    grid.node_places = places_of(grid, kTexels, -2 * kTexels, grid.nodes());
    grid.node_heights_m.assign(grid.node_places.size(), 0);
    if (grid.by_nodes)
        surface_.find_heights(grid.node_places, texel_m, grid.node_heights_m);
    else
        surface_.find_heights(grid.places, texel_m, grid.heights_m);
    grid.node_colors.assign(grid.node_places.size(), Vec3f{1, 1, 1});
    if (surface_.has(GroundKind::kAlbedo))
        surface_.find_colors(grid.node_places, texel_m * kTexels, grid.node_colors);
    if (surface_.has_hapke()) {
        const std::vector<Vec3d> vertices = places_of(grid, kTexels, 0, quads + 1);
        grid.hapke.assign(vertices.size(), hapke_);
        surface_.find_hapke(vertices, texel_m * kTexels, grid.hapke);
    }
    return out;
}

void GroundTileMaker::add_details(GroundTexels& grid) const {
    const std::size_t middle = grid.places.size() / 2;
    GroundPatch patch{grid.side(), grid.places, grid.heights_m, {}, grid.places[middle], 0, grid.texel_m};
    for (const Vec3d& place : grid.places)
        patch.reach_rad =
            std::max(patch.reach_rad, std::asin(std::min(1.0, length(cross(place, patch.middle)))));
    GroundPatch nodes = patch;
    nodes.side = grid.nodes(), nodes.places = grid.node_places, nodes.heights_m = grid.node_heights_m;
    for (const auto& detail : details_) detail->add_wide(nodes);
    add_between(grid.node_heights_m, grid.nodes(), grid.side(), grid.heights_m);
    grid.colors.assign(grid.places.size(), Vec3f{});
    add_between(grid.node_colors, grid.nodes(), grid.side(), grid.colors);
    patch.colors = grid.colors;
    for (const auto& detail : details_) detail->add(patch);
}

GroundTileMaker::Looks GroundTileMaker::looks(const GroundTexels& grid, Vec3d middle_m, bool sketch) const {
    std::vector<Vec3d> points(grid.places.size());
    for (std::size_t i = 0; i < points.size(); ++i)
        points[i] = surface_.point(grid.places[i], grid.heights_m[i]) - middle_m;
    const int texels = grid.quads * kTexels + 1;
    const auto side = static_cast<std::size_t>(grid.side());
    const auto index = [&](int x, int y) {
        return static_cast<std::size_t>(y + kBorder) * side + static_cast<std::size_t>(x + kBorder);
    };
    const auto normal_at = [&](std::size_t i) {
        return to_float(
            normalized(cross(points[i + 1] - points[i - 1], points[i + side] - points[i - side])));
    };
    Looks out;
    if (!sketch) {
        auto normals = std::make_shared<GroundNormals::Grid>();
        normals->reserve(static_cast<std::size_t>(texels * texels));
        for (int y = 0; y < texels; ++y)
            for (int x = 0; x < texels; ++x) normals->push_back(pack_normal(normal_at(index(x, y))));
        out.normals = std::move(normals);
    }
    for (int y = 0; y < texels; y += kTexels)
        for (int x = 0; x < texels; x += kTexels) {
            double height_m = 0;
            for (int j = 0; j < static_cast<int>(kTent.size()); ++j)
                for (int i = 0; i < static_cast<int>(kTent.size()); ++i)
                    height_m += kTent[static_cast<std::size_t>(i)] * kTent[static_cast<std::size_t>(j)] *
                                grid.heights_m[index(x + i - kTexels + 1, y + j - kTexels + 1)];
            const std::size_t at = index(x, y);
            const Vec3d point_m =
                surface_.point(grid.places[at], height_m / (kTexels * kTexels * kTexels * kTexels)) -
                middle_m;
            out.vertices.push_back({to_float(point_m), normal_at(at), grid.colors[at]});
        }
    return out;
}

std::unique_ptr<GroundTile> GroundTileMaker::finish(const GroundTexels& own,
                                                    const GroundTexels& above) const {
    const bool sketch = own.quads < GroundTile::kQuads;
    auto tile = std::make_unique<GroundTile>();
    tile->quads = own.quads;
    const std::size_t middle = own.places.size() / 2;
    tile->middle_m = surface_.point(own.places[middle], own.heights_m[middle]);
    Looks fine = looks(own, tile->middle_m, sketch);
    const Looks coarse = looks(above, tile->middle_m, sketch);
    tile->own = std::move(fine.vertices);
    tile->own_normals = std::move(fine.normals), tile->above_normals = coarse.normals;
    const int side = own.quads + 1, half = own.quads / 2 + 1;
    const auto at = [&](int x, int y) {
        return coarse.vertices[static_cast<std::size_t>(y / 2 * half + x / 2)];
    };
    tile->own_hapke = own.hapke;
    const auto hapke_at = [&](int x, int y) {
        return above.hapke[static_cast<std::size_t>(y / 2 * half + x / 2)];
    };
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            const int right = x % 2, up = y % 2;  // the triangles' diagonal goes from the right to the top
            tile->above.push_back(right + up == 0 ? at(x, y)
                                                  : between(at(x + right, y - up), at(x - right, y + up)));
            if (!above.hapke.empty())
                tile->above_hapke.push_back(
                    blend(hapke_at(x + right, y - up), 0.5f, hapke_at(x - right, y + up), 0.5f, {}, 0));
        }
    for (const std::vector<GroundTile::Look>* looks : {&tile->own, &tile->above})
        for (const GroundTile::Look& look : *looks)
            tile->radius_m = std::max(tile->radius_m, length(to_double(look.point_m)));
    return tile;
}

std::unique_ptr<GroundTile> GroundTileMaker::make(Making& making) const {
    add_details(*making.own);
    if (making.above_laid) {
        add_details(*making.above_laid);
        making.above = making.above_laid;
    }
    std::unique_ptr<GroundTile> tile = finish(*making.own, *making.above);
    if (tile->quads < GroundTile::kQuads) tile->texels = making.own;
    return tile;
}

// lay_one(i): returns tile i with its maps read.
template <class Lay>
std::vector<std::unique_ptr<GroundTile>> GroundTileMaker::make_all(std::size_t count, const Lay& lay_one) {
    // A batch may have many tiles, whose texels are large.
    constexpr std::size_t kTogether = 64;
    std::vector<std::unique_ptr<GroundTile>> tiles(count);
    for (std::size_t first = 0; first < count; first += kTogether) {
        std::vector<Making> makings;
        for (std::size_t i = first; i < std::min(count, first + kTogether); ++i)
            makings.push_back(lay_one(i));
        tbb::parallel_for(std::size_t{0}, makings.size(),
                          [&](std::size_t i) { tiles[first + i] = make(makings[i]); });
    }
    return tiles;
}

std::vector<std::unique_ptr<GroundTile>> GroundTileMaker::sketch(std::span<const GroundTileKey> keys) {
    return make_all(keys.size(), [&](std::size_t i) {
        return Making{lay(keys[i], GroundTile::kSketchQuads), nullptr,
                      lay(keys[i], GroundTile::kSketchQuads / 2)};
    });
}

std::vector<std::unique_ptr<GroundTile>> GroundTileMaker::make(std::span<const GroundTileKey> keys,
                                                               std::span<const GroundTile* const> sketches) {
    return make_all(keys.size(), [&](std::size_t i) {
        Making making{lay(keys[i], GroundTile::kQuads), sketches[i]->texels, nullptr};
        if (!making.above) making.above_laid = lay(keys[i], GroundTile::kSketchQuads);
        return making;
    });
}

}  // namespace hilcam
