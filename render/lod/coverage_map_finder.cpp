#include "render/lod/coverage_map_finder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

#include "render/lod/coverage_map_painter.h"
#include "render/lod/plane_rectangle.h"

namespace hilcam {
namespace {

// The largest triangles that are tried as ground. A byte must distinguish all coverage maps
// (PackedTriangle::coplanar_group).
constexpr std::size_t kMaxGrounds = 64;
constexpr int kFinest = 1536, kCoarsest = 16;  // largest and smallest number of texels along the longer side
constexpr double kMinFilled = 0.2;             // the ground must fill this share of its rectangle
constexpr double kMinSeen = 0.005, kMaxSeen = 0.98;  // bounds of the ground's visible share
// Cosine of a degree: limit between corner normals and their triangle's.
constexpr float kFlatGroundCorner = 0.99985f;

struct GroundTriangle {
    std::uint32_t number;
    std::uint16_t surface;
    Vec3d area;  // vector
    double area_m2;
};

std::array<Vec3d, 3> corners_of(const Mesh& mesh, std::uint32_t triangle) {
    const auto& [a, b, c] = mesh.triangles[triangle];
    return {to_double(mesh.vertices_m[a]), to_double(mesh.vertices_m[b]), to_double(mesh.vertices_m[c])};
}

// Returns the triangles that a coverage map may have, the largest first.
std::vector<GroundTriangle> flat_triangles(const Mesh& mesh, std::span<const std::uint8_t> may_be) {
    std::vector<GroundTriangle> out;
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        if (!may_be[t]) continue;
        const Vec3d area = area_vector(mesh, mesh.triangles[t]);
        const double area_m2 = length(area);
        if (!(area_m2 > 0)) continue;
        const Vec3f normal = to_float(area / area_m2);
        const bool curved =
            !mesh.normals.empty() &&
            std::any_of(mesh.triangles[t].begin(), mesh.triangles[t].end(), [&](std::uint32_t v) {
                const Vec3f corner = mesh.normals[v];  // zero: the triangle's own
                return corner != Vec3f{} && std::abs(dot(corner, normal)) < kFlatGroundCorner;
            });
        if (!curved) out.push_back({t, mesh.surface_of_triangle[t], area, area_m2});
    }
    std::sort(out.begin(), out.end(), [](const GroundTriangle& a, const GroundTriangle& b) {
        return a.area_m2 != b.area_m2 ? a.area_m2 > b.area_m2 : a.number < b.number;
    });
    return out;
}

double radius_m(const Mesh& mesh) {
    float squared = 0;
    for (const Vec3f at : mesh.vertices_m) squared = std::max(squared, dot(at, at));
    return static_cast<double>(std::sqrt(squared));
}

class CoverageMapFinder {
  public:
    CoverageMapFinder(const Mesh& mesh, std::span<const std::uint8_t> may_be, double error_m)
        : mesh_(mesh),
          error_m_(error_m),
          rounding_m_(0x1p-20 * radius_m(mesh)),
          flat_(flat_triangles(mesh, may_be)),
          used_(flat_.size()) {}

    std::vector<CoverageMap> find() {
        std::vector<CoverageMap> out;
        std::size_t seeds = 0;
        for (std::size_t s = 0; s < flat_.size() && seeds < kMaxGrounds; ++s) {
            if (used_[s]) continue;
            // The remaining ones are negligibly small.
            if (flat_[s].area_m2 < 8 * error_m_ * error_m_) break;
            ++seeds;
            CoverageMap coverage_map;
            if (make(s, coverage_map)) out.push_back(std::move(coverage_map));
        }
        return out;
    }

  private:
    const Mesh& mesh_;
    double error_m_, rounding_m_;
    std::vector<GroundTriangle> flat_;
    std::vector<std::uint8_t> used_;  // part of a coverage map, or tried as ground
    CoverageMapPainter painter_;

    std::array<Vec3d, 3> corners(std::size_t i) const { return corners_of(mesh_, flat_[i].number); }

    bool make(std::size_t seed, CoverageMap& out) {
        const std::vector<std::size_t> ground = ground_about(seed);
        for (const std::size_t i : ground) used_[i] = 1;
        const std::vector<Vec3d> edges = border(ground);
        const Vec3d normal = flat_[seed].area / flat_[seed].area_m2;
        for (const Vec3d up : {normal, -normal}) {
            if (!lay_out(ground, edges, up, out)) return false;
            const std::vector<std::size_t> upon = upon_ground(out);
            if (!upon.empty()) return paint(ground, upon, out);
        }
        return false;
    }

    // Returns everything connected to the seed in its plane by common corners.
    std::vector<std::size_t> ground_about(std::size_t seed) const {
        const Vec3d normal = flat_[seed].area / flat_[seed].area_m2, at = corners(seed)[0];
        std::vector<std::size_t> all;
        for (std::size_t i = 0; i < flat_.size(); ++i) {
            if (used_[i] || flat_[i].surface != flat_[seed].surface) continue;
            const auto three = corners(i);
            if (std::all_of(three.begin(), three.end(),
                            [&](Vec3d c) { return std::abs(dot(c - at, normal)) <= rounding_m_; }))
                all.push_back(i);
        }
        std::map<std::tuple<double, double, double>, std::vector<std::size_t>> at_place;
        for (const std::size_t i : all)
            for (const Vec3d c : corners(i)) at_place[{c.x, c.y, c.z}].push_back(i);
        std::vector<std::size_t> out{seed};
        std::vector<std::uint8_t> taken(flat_.size());
        taken[seed] = 1;
        for (std::size_t next = 0; next < out.size(); ++next)
            for (const Vec3d c : corners(out[next]))
                for (const std::size_t i : at_place[{c.x, c.y, c.z}])
                    if (!std::exchange(taken[i], 1)) out.push_back(i);
        return out;
    }

    // Takes the smallest of the rectangles along an edge. Returns false if it is too small or not filled.
    bool lay_out(const std::vector<std::size_t>& ground, std::span<const Vec3d> edges, Vec3d up,
                 CoverageMap& out) const {
        if (edges.empty()) return false;  // it has no border
        std::vector<std::array<Vec3d, 3>> triangles;
        double area_m2 = 0;
        for (const std::size_t i : ground) triangles.push_back(corners(i)), area_m2 += flat_[i].area_m2;
        const PlaneRectangle r = smallest_rectangle(triangles, edges, up);
        out.surface[0] = flat_[ground.front()].surface, out.layers = 1;
        out.normal = to_float(up), out.across = to_float(r.across), out.down = to_float(r.down);
        out.width_m = static_cast<float>(r.width()), out.height_m = static_cast<float>(r.height());
        out.corner_m = to_float(dot(triangles[0][0], up) * up + r.x0 * r.across + r.y0 * r.down);
        const double longer_m = std::max(r.width(), r.height());
        out.texel_m = static_cast<float>(std::max(error_m_, longer_m / kFinest));
        return area_m2 > kMinFilled * r.area() && longer_m > kCoarsest * static_cast<double>(out.texel_m);
    }
    // Returns the longest of the edges that belong to one triangle only.
    std::vector<Vec3d> border(const std::vector<std::size_t>& ground) const {
        constexpr std::size_t kMaxEdges = 64;
        using Place = std::tuple<double, double, double>;
        std::map<std::pair<Place, Place>, int> found;
        const auto place = [](Vec3d at) { return Place{at.x, at.y, at.z}; };
        for (const std::size_t i : ground) {
            const auto three = corners(i);
            for (std::size_t k = 0; k < 3; ++k) {
                const Place a = place(three[k]), b = place(three[(k + 1) % 3]);
                ++found[{std::min(a, b), std::max(a, b)}];
            }
        }
        std::vector<Vec3d> out;
        for (const auto& [ends, triangles] : found) {
            const auto& [ax, ay, az] = ends.first;
            const auto& [bx, by, bz] = ends.second;
            if (triangles == 1) out.push_back({bx - ax, by - ay, bz - az});
        }
        std::stable_sort(out.begin(), out.end(), [](Vec3d a, Vec3d b) { return dot(a, a) > dot(b, b); });
        out.resize(std::min(out.size(), kMaxEdges));
        return out;
    }

    // Returns the triangles of other surfaces inside the ground's rectangle and less than a texel high.
    std::vector<std::size_t> upon_ground(const CoverageMap& ground) const {
        CoverageMap space = ground;
        const Vec3d up = to_double(ground.normal);
        space.above_m = ground.texel_m;
        space.corner_m = to_float(to_double(ground.corner_m) + static_cast<double>(space.above_m) * up);
        std::vector<std::size_t> out;
        for (std::size_t i = 0; i < flat_.size(); ++i) {
            if (used_[i] || flat_[i].surface == ground.surface[0]) continue;
            const auto three = corners(i);
            const double height_m = dot(three[0] - to_double(ground.corner_m), up);
            if (!(height_m > 2 * rounding_m_ && height_m < 2 * static_cast<double>(space.above_m))) continue;
            space.surface[0] = flat_[i].surface;
            if (space.holds(flat_[i].surface, three)) out.push_back(i);
        }
        return out;
    }

    bool paint(const std::vector<std::size_t>& ground, const std::vector<std::size_t>& upon,
               CoverageMap& out) {
        struct Layer {
            std::uint16_t surface;
            double area_m2 = 0, height_m3 = 0;
        };
        std::map<std::uint16_t, Layer> found;
        const Vec3d base = to_double(out.corner_m), up = to_double(out.normal);
        for (const std::size_t i : upon) {
            Layer& layer = found[flat_[i].surface];
            layer.surface = flat_[i].surface;
            layer.area_m2 += flat_[i].area_m2;
            for (const Vec3d c : corners(i)) layer.height_m3 += flat_[i].area_m2 / 3 * dot(c - base, up);
        }
        std::vector<Layer> layers;
        for (const auto& [surface, layer] : found) layers.push_back(layer);
        std::sort(layers.begin(), layers.end(),
                  [](const Layer& a, const Layer& b) { return a.area_m2 > b.area_m2; });
        layers.resize(std::min(layers.size(), CoverageMap::kMaxLayers - 1));
        std::sort(layers.begin(), layers.end(), [](const Layer& a, const Layer& b) {
            return a.height_m3 / a.area_m2 < b.height_m3 / b.area_m2;
        });
        for (const Layer& layer : layers) out.surface[out.layers++] = layer.surface;
        const auto layer_of = [&](std::size_t i) {
            return static_cast<std::size_t>(
                std::find(out.surface.begin(), out.surface.begin() + out.layers, flat_[i].surface) -
                out.surface.begin());
        };
        double top_m = 0;
        painter_.begin(out);
        for (const std::size_t i : ground) painter_.add(0, corners(i));
        for (const std::size_t i : upon) {
            const std::size_t layer = layer_of(i);
            if (layer == out.layers) continue;
            painter_.add(layer, corners(i));
            for (const Vec3d c : corners(i)) top_m = std::max(top_m, dot(c - base, up));
        }
        double area_m2 = 0, height_m3 = 0;
        for (const Layer& layer : layers) area_m2 += layer.area_m2, height_m3 += layer.height_m3;
        out.upper_m = static_cast<float>(height_m3 / area_m2);
        const double seen = painter_.fill();
        if (seen < kMinSeen || seen > kMaxSeen) return false;
        painter_.finish();
        for (const std::size_t i : upon)
            if (layer_of(i) < out.layers && out.covers(corners(i))) used_[i] = 1;
        out.above_m = static_cast<float>(top_m);
        out.corner_m = to_float(base + top_m * up);
        return true;
    }
};

}  // namespace

std::vector<CoverageMap> find_coverage_maps(const Mesh& mesh, std::span<const std::uint8_t> may_be,
                                            double error_m) {
    return CoverageMapFinder(mesh, may_be, error_m).find();
}

std::vector<CoverageMapParts> coverage_map_parts(std::span<const CoverageMap> coverage_maps, const Mesh& mesh,
                                                 std::span<const std::uint8_t> may_be) {
    const std::vector<GroundTriangle> flat = flat_triangles(mesh, may_be);
    std::vector<CoverageMapParts> out;
    for (const CoverageMap& coverage_map : coverage_maps) {
        CoverageMapParts& parts = out.emplace_back();
        for (const GroundTriangle& t : flat) {
            const auto three = corners_of(mesh, t.number);
            if (coverage_map.holds(t.surface, three) && coverage_map.covers(three))
                (t.surface == coverage_map.surface[0] ? parts.ground : parts.upon).push_back(t.number);
        }
    }
    return out;
}

}  // namespace hilcam
