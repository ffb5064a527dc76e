#include "render/probes/probe_maker.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "render/scene/surface.h"
#include "render/vocabulary/mixed_bits.h"

namespace hilcam {
namespace {

// Returns the cells of a set, without its unused entries.
std::span<const std::uint32_t> used(const CellSet& set) {
    return {set.begin(), std::find(set.begin(), set.end(), SurfaceProbes::kClosed)};
}

// Chooses one of several items for each of a probe's points, evenly along their cumulative areas. Calls
// pick(point, item).
template <class AreaOf, class Pick>
void spread_evenly(std::size_t items, std::uint64_t seed, const AreaOf& area_of, const Pick& pick) {
    double area_m2 = 0;
    for (std::size_t k = 0; k < items; ++k) area_m2 += area_of(k);
    const double shift = static_cast<double>(mixed(seed) >> 11) * 0x1p-53;
    std::size_t k = 0;
    double passed = 0;
    for (std::size_t i = 0; i < SurfaceProbe::kPoints; ++i) {
        const double at = (static_cast<double>(i) + shift) / SurfaceProbe::kPoints * area_m2;
        while (k + 1 < items && passed + area_of(k) <= at) passed += area_of(k), ++k;
        pick(i, k);
    }
}

// `color` is the sum over the points.
void finish(SurfaceProbe& probe, Vec3f color) {
    probe.color = color / static_cast<float>(SurfaceProbe::kPoints);
    Vec3f mean{};
    for (const std::uint32_t normal : probe.normal) mean = mean + unpack_normal(normal);
    probe.mean_normal = dot(mean, mean) > 1e-6f ? pack_normal(normalized(mean)) : probe.normal[0];
}

}  // namespace

float points_above_m(const Mesh& mesh) {
    float greatest = 0;
    for (const Vec3f v : mesh.vertices_m)
        greatest = std::max({greatest, std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    return 32 * std::numeric_limits<float>::epsilon() * greatest;
}

ProbeMaker::ProbeMaker(const Mesh& mesh, const CubeGrid& grid, std::span<const FoundCell> cells,
                       const Sight& sight)
    : mesh_(mesh), grid_(grid), cells_(cells), sight_(sight), above_m_(points_above_m(mesh)) {
    for (const Texture& texture : mesh.textures) pictures_.emplace_back(Texture(texture));
}

MadeProbe ProbeMaker::make(const CellSet& set, std::uint64_t seed) const {
    const Candidates all = candidates(used(set));
    const std::optional<DividedPoints> divided = find_division(all.raised_m, all.facing, sight_);
    if (!divided) return {of_cells(used(set), seed), {}, {}};
    // A side with few points was found by chance; the probe then belongs to the other side.
    constexpr std::size_t kFew = 16;
    const auto is_few = [&](const std::vector<std::size_t>& side) {
        return kFew * side.size() < all.point.size();
    };
    if (is_few(divided->above)) return {of_points(all, divided->below, seed), {}, {}};
    if (is_few(divided->below)) return {of_points(all, divided->above, seed), {}, {}};
    return {of_points(all, divided->below, seed), of_points(all, divided->above, seed), divided->by};
}

ProbeMaker::Candidates ProbeMaker::candidates(std::span<const std::uint32_t> cells) const {
    constexpr float kWall = 0.15f;    // in cubes: higher than tiles and wrinkles
    constexpr std::size_t kMax = 32;  // each pair costs a ray
    Candidates out;
    for (const std::uint32_t c : cells) {
        const FoundCell& cell = cells_[c];
        const std::size_t count = std::min(static_cast<std::size_t>(cell.count), kMax / cells.size());
        for (const CellPoint& point : std::span(cell.best).first(count)) {
            const TriangleSpread spread(mesh_, point.triangle, 0.5f * grid_.cube_m);
            out.point.push_back(point);
            out.area_m2.push_back(cell.area_m2 / static_cast<double>(count));
            out.raised_m.push_back(spread.at(spread.weights(static_cast<int>(point.point))));
            out.facing = out.facing + (point.back ? -1.0f : 1.0f) * spread.normal;
        }
    }
    if (length(out.facing) > 0) out.facing = normalized(out.facing);
    for (Vec3f& point_m : out.raised_m) point_m = point_m + kWall * grid_.cube_m * out.facing;
    return out;
}

// Makes the probe of some candidates.
SurfaceProbe ProbeMaker::of_points(const Candidates& all, std::span<const std::size_t> here,
                                   std::uint64_t seed) const {
    SurfaceProbe probe;
    Vec3f color{};
    spread_evenly(
        here.size(), seed, [&](std::size_t k) { return all.area_m2[here[k]]; },
        [&](std::size_t i, std::size_t k) { add(probe, i, all.point[here[k]], color); });
    finish(probe, color);
    return probe;
}

// Makes the probe of all points of some cells.
SurfaceProbe ProbeMaker::of_cells(std::span<const std::uint32_t> cells, std::uint64_t seed) const {
    SurfaceProbe probe;
    Vec3f color{};
    std::array<int, std::tuple_size_v<CellSet>> taken{};
    spread_evenly(
        cells.size(), seed, [&](std::size_t k) { return cells_[cells[k]].area_m2; },
        [&](std::size_t i, std::size_t k) {
            const FoundCell& cell = cells_[cells[k]];
            add(probe, i, cell.best[static_cast<std::size_t>(taken[k]++ % cell.count)], color);
        });
    finish(probe, color);
    return probe;
}

void ProbeMaker::add(SurfaceProbe& probe, std::size_t i, const CellPoint& candidate, Vec3f& sum) const {
    const TriangleSpread spread(mesh_, candidate.triangle, 0.5f * grid_.cube_m);
    const Vec3f w = spread.weights(static_cast<int>(candidate.point));
    const Vec3f geometric = candidate.back ? -spread.normal : spread.normal;
    Vec3f normal = geometric;
    if (!mesh_.normals.empty()) {
        const auto at = [&](std::size_t k) { return mesh_.normals[spread.corner[k].vertex]; };
        const Vec3f smooth = w.x * at(0) + w.y * at(1) + w.z * at(2);
        if (dot(smooth, smooth) > 1e-6f) normal = normalized(smooth);
        if (dot(normal, geometric) < 0) normal = -normal;
    }
    probe.surface = mesh_.surface_of_triangle[candidate.triangle];
    probe.point_m[i] = spread.at(w) + above_m_ * geometric;
    probe.normal[i] = pack_normal(normal);
    probe.geometric[i] = pack_normal(geometric);
    sum = sum + color(spread, w, probe.surface);
}

Vec3f ProbeMaker::color(const TriangleSpread& spread, Vec3f w, std::uint16_t surface) const {
    Vec3f own{1, 1, 1};
    if (!mesh_.colors.empty()) {
        const auto at = [&](std::size_t i) { return mesh_.colors[spread.corner[i].vertex]; };
        own = w.x * at(0) + w.y * at(1) + w.z * at(2);
    }
    const int texture = mesh_.surfaces[surface].base_color_texture;
    if (texture < 0 || mesh_.uvs.empty()) return own;
    const auto uv = [&](std::size_t i) { return mesh_.uvs[spread.corner[i].vertex]; };
    const Vec3f painted = pictures_[static_cast<std::size_t>(texture)].sample(
        w.x * uv(0).x + w.y * uv(1).x + w.z * uv(2).x, w.x * uv(0).y + w.y * uv(1).y + w.z * uv(2).y, 0);
    return {own.x * painted.x, own.y * painted.y, own.z * painted.z};
}

}  // namespace hilcam
