#include "render/scene/coplanar_groups.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <tuple>

#include "render/lod/coverage_map_finder.h"
#include "render/scene/surface.h"

namespace hilcam {
namespace {

constexpr std::size_t kNeighbours = 4096;  // triangles in memory that are searched for groups
constexpr int kMaxElsewhere = 256;         // after this many hits in other planes a triangle stops searching

// Triangles with equal keys may belong to one group.
struct Candidate {
    std::uint64_t key;
    float area;  // twice that of the triangle [m^2]
    std::uint32_t triangle;
    auto order() const { return std::tuple(key, -area, triangle); }
};

class CoplanarGroupFinder {
  public:
    CoplanarGroupFinder(const Mesh& mesh, ObjectSurfaces& surfaces)
        : mesh_(mesh),
          surfaces_(surfaces),
          // Eight times the rounding of a corner in single precision at the body's largest extent. The plane
          // through three such corners is off by several roundings.
          tolerance_m_(0x1p-21 * surfaces.radius_m) {
        surfaces_.coplanar_groups.resize(mesh.triangles.size());
        std::iota(surfaces_.coplanar_groups.begin(), surfaces_.coplanar_groups.end(), 0u);
    }

    void find_among(std::size_t begin, std::size_t end) {
        std::vector<Candidate> all;
        for (std::size_t t = begin; t < end; ++t) add(static_cast<std::uint32_t>(t), all);
        std::sort(all.begin(), all.end(),
                  [](const Candidate& a, const Candidate& b) { return a.order() < b.order(); });
        for (auto first = all.begin(); first != all.end();) {
            const auto last =
                std::find_if(first, all.end(), [&](const Candidate& c) { return c.key != first->key; });
            divide({first, last});
            first = last;
        }
    }

  private:
    const Mesh& mesh_;
    ObjectSurfaces& surfaces_;
    double tolerance_m_;

    std::array<Vec3d, 3> corners(std::uint32_t triangle) const {
        const auto& [a, b, c] = mesh_.triangles[triangle];
        return {to_double(mesh_.vertices_m[a]), to_double(mesh_.vertices_m[b]),
                to_double(mesh_.vertices_m[c])};
    }

    void add(std::uint32_t t, std::vector<Candidate>& all) const {
        const PackedTriangle& packed = surfaces_.triangles[t];
        const auto& n = packed.corner_normals;
        if (surfaces_.materials[packed.surface].texture >= 0) return;
        if (!packed.flat && (n[0] != n[1] || n[0] != n[2])) return;
        if (!surfaces_.lod_normals.empty() && !surfaces_.lod_normals[t].is_flat()) return;
        const auto [a, b, c] = corners(t);
        const Vec3d across = cross(b - a, c - a);
        const double area = length(across);
        if (!(area > 0)) return;
        const std::uint64_t normal = packed.flat ? steps(across / area) : n[0];
        all.push_back({std::uint64_t{packed.surface} << 33 | std::uint64_t{packed.flat} << 32 | normal,
                       static_cast<float>(area), t});
    }
    // A geometric normal in steps so coarse that those of one plane hardly ever differ.
    static std::uint64_t steps(Vec3d normal) {
        const auto step = [](double x) { return static_cast<std::uint64_t>(std::lround(16 * x) + 16); };
        return step(normal.x) | step(normal.y) << 8 | step(normal.z) << 16;
    }

    // Candidates of one key, the largest first.
    void divide(std::span<const Candidate> all) {
        for (std::size_t i = 0; i < all.size(); ++i) {
            const std::uint32_t one = all[i].triangle;
            if (surfaces_.coplanar_groups[one] != one) continue;
            const Plane plane(corners(one));
            int elsewhere = 0;
            for (std::size_t j = i + 1; j < all.size() && elsewhere < kMaxElsewhere; ++j) {
                const std::uint32_t other = all[j].triangle;
                if (surfaces_.coplanar_groups[other] != other) continue;
                if (plane.holds(corners(other), tolerance_m_))
                    surfaces_.coplanar_groups[other] = one, surfaces_.triangles[one].coplanar_group = 1;
                else
                    ++elsewhere;
            }
        }
    }

    class Plane {
      public:
        explicit Plane(const std::array<Vec3d, 3>& corners)
            : corner_(corners[0]),
              u_(corners[1] - corners[0]),
              v_(corners[2] - corners[0]),
              normal_(cross(u_, v_)) {}

        bool holds(const std::array<Vec3d, 3>& corners, double tolerance_m) const {
            if (dot(cross(corners[1] - corners[0], corners[2] - corners[0]), normal_) <= 0) return false;
            const double squared = dot(normal_, normal_), off = tolerance_m * std::sqrt(squared);
            constexpr double kReach =
                static_cast<double>(kCoplanarReach) - 1;  // minus the rounding of a place
            return std::all_of(corners.begin(), corners.end(), [&](Vec3d at) {
                const Vec3d way = at - corner_;
                return std::abs(dot(way, normal_)) <= off &&
                       std::abs(dot(cross(way, v_), normal_)) <= kReach * squared &&
                       std::abs(dot(cross(u_, way), normal_)) <= kReach * squared;
            });
        }

      private:
        Vec3d corner_, u_, v_, normal_;
    };
};

}  // namespace

void find_coplanar_groups(const Mesh& mesh, ObjectSurfaces& surfaces) {
    if (!mesh.colors.empty() || !mesh.hapke.empty()) return;
    CoplanarGroupFinder finder(mesh, surfaces);
    const std::size_t count = mesh.triangles.size();
    tbb::parallel_for(std::size_t{0}, (count + kNeighbours - 1) / kNeighbours, [&](std::size_t part) {
        finder.find_among(part * kNeighbours, std::min(count, (part + 1) * kNeighbours));
    });
    if (std::none_of(surfaces.triangles.begin(), surfaces.triangles.end(),
                     [](const PackedTriangle& t) { return t.coplanar_group != 0; }))
        surfaces.coplanar_groups = {};
}

std::vector<std::uint8_t> may_be_in_coverage_maps(const Mesh& mesh, const ObjectSurfaces& surfaces) {
    std::vector<std::uint8_t> out(mesh.triangles.size());
    if (!mesh.colors.empty() || !mesh.hapke.empty()) return out;
    // The picture in a mirror depends on its exact position: radiator tiles had more false lights as coverage
    // maps than as tiles.
    constexpr float kMirror = 0.02f;  // alpha
    for (std::size_t t = 0; t < out.size(); ++t) {
        const Material& material = surfaces.materials[surfaces.triangles[t].surface];
        const bool is_mirror = material.is_bare() && material.ggx_alpha < kMirror;
        out[t] = material.texture < 0 && !material.transmits() && !is_mirror &&
                 (surfaces.lod_normals.empty() || surfaces.lod_normals[t].is_flat());
    }
    return out;
}

namespace {

// The most by which texels may be coarser than a level's error. Where an object is nearest that is at most
// four times lod_error_px, six tenths of a pixel at real time. It blurs gaps but keeps their light, while
// samples lit from the middles of gaps lose it (docs/decisions.md#coverage-maps-of-flat-parts).
constexpr double kTexelOverError = 4;

// Places on a coverage map are computed from its ground's triangle, by the edges of that triangle.
bool reaches_all(const Mesh& mesh, std::uint32_t triangle, const CoverageMap& coverage_map) {
    const auto& [a, b, c] = mesh.triangles[triangle];
    const Vec3f u = mesh.vertices_m[b] - mesh.vertices_m[a], v = mesh.vertices_m[c] - mesh.vertices_m[a];
    const float height_m = length(cross(u, v)) / std::max({length(u), length(v), length(u - v)});
    return kCoplanarReach * height_m > std::hypot(coverage_map.width_m, coverage_map.height_m);
}

}  // namespace

void attach_coverage_maps(const std::shared_ptr<const std::vector<CoverageMap>>& coverage_maps,
                          const Mesh& mesh, double error_m, ObjectSurfaces& surfaces) {
    if (!coverage_maps || coverage_maps->empty()) return;
    const std::vector<CoverageMapParts> parts =
        coverage_map_parts(*coverage_maps, mesh, may_be_in_coverage_maps(mesh, surfaces));
    for (std::size_t m = 0; m < parts.size(); ++m) {
        const CoverageMap& coverage_map = (*coverage_maps)[m];
        if (kTexelOverError * error_m < static_cast<double>(coverage_map.texel_m) || parts[m].ground.empty())
            continue;
        const std::uint32_t ground = parts[m].ground.front();
        if (!reaches_all(mesh, ground, coverage_map)) continue;
        if (surfaces.coplanar_groups.empty()) {
            surfaces.coplanar_groups.resize(mesh.triangles.size());
            std::iota(surfaces.coplanar_groups.begin(), surfaces.coplanar_groups.end(), 0u);
        }
        // Triangles that continue the ground's plane outside the coverage map represent themselves.
        for (std::uint32_t t = 0; t < surfaces.coplanar_groups.size(); ++t)
            if (surfaces.coplanar_groups[t] == ground) surfaces.coplanar_groups[t] = t;
        for (const std::uint32_t t : parts[m].ground) surfaces.coplanar_groups[t] = ground;
        for (const std::uint32_t t : parts[m].upon) surfaces.coplanar_groups[t] = kNotShown;
        surfaces.triangles[ground].coplanar_group = static_cast<std::uint8_t>(m + 2);
        surfaces.coverage_maps = coverage_maps;
    }
}

}  // namespace hilcam
