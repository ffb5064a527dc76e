#include "render/ground/ground_tile.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "render/ground/cube_sphere.h"

namespace hilcam {
namespace {

GroundTile::Look between(const GroundTile::Look& a, const GroundTile::Look& b) {
    return {0.5f * (a.point_m + b.point_m), 0.5f * (a.normal + b.normal), 0.5f * (a.color + b.color)};
}

}  // namespace

double GroundTileMaker::spacing_m(int level) const {
    return 0.5 * kPi * surface_.figure().equatorial_radius_m / std::ldexp(GroundTile::kQuads, level);
}

// Places of quads + 1 vertices along an edge and a border of one, with what the maps have there.
GroundTileMaker::Grid GroundTileMaker::lay(const GroundTileKey& key, int quads, double spacing_m) {
    Grid grid;
    grid.side = quads + 3;
    grid.spacing_m = spacing_m;
    const double tiles = std::ldexp(1, key.level);
    grid.places.reserve(static_cast<std::size_t>(grid.side * grid.side));
    const auto at = [&](std::int32_t tile, int k) {
        // A whole number over a power of two: neighbours have the same bits.
        return -1 + 2 * ((static_cast<double>(tile) * quads + k - 1) / (tiles * quads));
    };
    for (int y = 0; y < grid.side; ++y)
        for (int x = 0; x < grid.side; ++x)
            grid.places.push_back(cube_direction(key.face, {at(key.column, x), at(key.row, y)}));
    grid.heights_m.resize(grid.places.size());
    surface_.find_heights(grid.places, spacing_m, grid.heights_m);
    grid.colors.assign(grid.places.size(), Vec3f{1, 1, 1});
    if (surface_.has_colors()) surface_.find_colors(grid.places, spacing_m, grid.colors);
    return grid;
}

void GroundTileMaker::add_details(Grid& grid) const {
    const std::size_t middle = grid.places.size() / 2;
    GroundDetail::Patch patch{grid.places, grid.heights_m, grid.colors, grid.places[middle],
                              0,           grid.spacing_m};
    for (const Vec3d& place : grid.places)
        patch.reach_rad =
            std::max(patch.reach_rad, std::asin(std::min(1.0, length(cross(place, patch.middle)))));
    for (const auto& detail : details_) detail->add(patch);
}

// What the grid is without its border.
std::vector<GroundTile::Look> GroundTileMaker::looks(const Grid& grid, Vec3d middle_m) const {
    std::vector<Vec3d> points(grid.places.size());
    for (std::size_t i = 0; i < points.size(); ++i)
        points[i] = surface_.point(grid.places[i], grid.heights_m[i]) - middle_m;
    std::vector<GroundTile::Look> out;
    const auto side = static_cast<std::size_t>(grid.side);
    out.reserve((side - 2) * (side - 2));
    for (std::size_t y = 1; y + 1 < side; ++y)
        for (std::size_t x = 1; x + 1 < side; ++x) {
            const std::size_t i = y * side + x;
            const Vec3d normal = cross(points[i + 1] - points[i - 1], points[i + side] - points[i - side]);
            out.push_back({to_float(points[i]), to_float(normalized(normal)), grid.colors[i]});
        }
    return out;
}

std::unique_ptr<GroundTile> GroundTileMaker::finish(Grid& own, Grid& above) const {
    add_details(own);
    add_details(above);
    auto tile = std::make_unique<GroundTile>();
    const std::size_t middle = own.places.size() / 2;
    tile->middle_m = surface_.point(own.places[middle], own.heights_m[middle]);
    tile->own = looks(own, tile->middle_m);
    const std::vector<GroundTile::Look> coarse = looks(above, tile->middle_m);
    constexpr int kSide = GroundTile::kSide, kHalf = GroundTile::kQuads / 2 + 1;
    const auto at = [&](int x, int y) { return coarse[static_cast<std::size_t>(y / 2 * kHalf + x / 2)]; };
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) {
            const int right = x % 2, up = y % 2;  // the triangles' diagonal goes from the right to the top
            tile->above.push_back(right + up == 0 ? at(x, y)
                                                  : between(at(x + right, y - up), at(x - right, y + up)));
        }
    for (const std::vector<GroundTile::Look>* looks : {&tile->own, &tile->above})
        for (const GroundTile::Look& look : *looks)
            tile->radius_m = std::max(tile->radius_m, length(to_double(look.point_m)));
    return tile;
}

std::vector<std::unique_ptr<GroundTile>> GroundTileMaker::make(std::span<const GroundTileKey> keys) {
    std::vector<Grid> own, above;
    for (const GroundTileKey& key : keys) {
        const double spacing = spacing_m(key.level);
        own.push_back(lay(key, GroundTile::kQuads, spacing));
        above.push_back(lay(key, GroundTile::kQuads / 2, 2 * spacing));
    }
    std::vector<std::unique_ptr<GroundTile>> tiles(keys.size());
    tbb::parallel_for(std::size_t{0}, keys.size(),
                      [&](std::size_t i) { tiles[i] = finish(own[i], above[i]); });
    return tiles;
}

}  // namespace hilcam
