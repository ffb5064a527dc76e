#include "render/lod/lod_normals.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "render/lod/closest_triangle.h"

namespace hilcam {
namespace {

// Normals that differ less than this count as one: a sixth of the narrowest cached lobe (irradiance_cache.h).
constexpr double kApart = 0.02;

// Returns the shading normal at a place in a triangle; `geometric` if it has none.
Vec3f normal_at(const Mesh& mesh, std::uint32_t triangle, float u, float v, Vec3f geometric) {
    if (mesh.normals.empty()) return geometric;
    const auto& t = mesh.triangles[triangle];
    for (const std::uint32_t corner : t)
        if (!(dot(mesh.normals[corner], mesh.normals[corner]) > 0)) return geometric;
    const Vec3f n = (1 - u - v) * mesh.normals[t[0]] + u * mesh.normals[t[1]] + v * mesh.normals[t[2]];
    return dot(n, n) > 1e-6f ? normalized(n) : geometric;
}

// A triangle of the mesh, with the level's triangle that represents it.
struct Part {
    std::uint32_t owner = std::numeric_limits<std::uint32_t>::max();  // none
    std::uint32_t number = 0;
    float area = 0;
    Vec3f lean;
};

Part part_of(const Mesh& mesh, const Mesh& level, const ClosestTriangle& near, std::uint32_t number,
             float radius_m) {
    const auto& corners = mesh.triangles[number];
    const Vec3f area = to_float(area_vector(mesh, corners));
    const float size = length(area);
    if (!(size > 0 && std::isfinite(size))) return {};
    const Vec3f middle_m =
        (mesh.vertices_m[corners[0]] + mesh.vertices_m[corners[1]] + mesh.vertices_m[corners[2]]) / 3.0f;
    const auto found = near.find({middle_m, area, mesh.surface_of_triangle[number], radius_m});
    if (!found) return {};
    const Vec3f flat = to_float(normalized(area_vector(level, level.triangles[found->triangle])));
    const Vec3f lean = normal_at(mesh, number, 1.0f / 3, 1.0f / 3, area / size) -
                       normal_at(level, found->triangle, found->u, found->v, flat);
    return {found->triangle, number, size, lean};
}

// Several parts: their area, and the moments of their normals.
struct Group {
    std::span<Part> parts;
    double area = 0;
    Vec3d mean;
    Mat3d scatter{{}, {}, {}};  // covariance
};
Group group_of(std::span<Part> parts) {
    Group g{parts, 0, {}, {{}, {}, {}}};
    for (const Part& p : parts) {
        const double a = static_cast<double>(p.area);
        g.area += a, g.mean = g.mean + a * to_double(p.lean);
    }
    if (!(g.area > 0)) return g;
    g.mean = g.mean / g.area;
    for (const Part& p : parts) {
        const Vec3d d = to_double(p.lean) - g.mean;
        const double w = static_cast<double>(p.area) / g.area;
        g.scatter.x = g.scatter.x + (w * d.x) * d;
        g.scatter.y = g.scatter.y + (w * d.y) * d;
        g.scatter.z = g.scatter.z + (w * d.z) * d;
    }
    return g;
}

// Returns the axis along which a group varies most, by powers of its matrix.
Vec3d widest_axis(const Mat3d& scatter) {
    const Vec3d rows[3] = {scatter.x, scatter.y, scatter.z};
    Vec3d axis = *std::max_element(std::begin(rows), std::end(rows),
                                   [](Vec3d a, Vec3d b) { return length(a) < length(b); });
    for (int i = 0; i < 12; ++i) {
        const double size = length(axis);
        if (!(size > 0)) return {};
        axis = scatter * (axis / size);
    }
    return axis;
}

std::size_t divide(const Group& group, std::span<Group> halves) {
    const Vec3d axis = widest_axis(group.scatter);
    // Its eigenvalue, because the last power was applied to a unit vector.
    const double variance = length(axis);
    if (group.parts.size() < 2 || !(variance > kApart * kApart)) {
        halves[0] = group;
        return 1;
    }
    const auto beyond = std::stable_partition(group.parts.begin(), group.parts.end(), [&](const Part& p) {
        return dot(to_double(p.lean) - group.mean, axis) < 0;
    });
    halves[0] = group_of({group.parts.begin(), beyond});
    halves[1] = group_of({beyond, group.parts.end()});
    return 2;
}

LodNormals facets_of_parts(std::span<Part> parts) {
    const Group all = group_of(parts);
    std::array<Group, 2> halves;
    std::array<Group, LodNormals::kMax> groups;
    std::size_t count = 0;
    const std::size_t two = divide(all, halves);
    for (std::size_t i = 0; i < two; ++i) count += divide(halves[i], std::span(groups).subspan(count, 2));
    std::array<LodNormals::Normal, LodNormals::kMax> normals{};
    double variance = 0;  // within the groups, sum over both axes: alpha squared (Beckmann's)
    for (std::size_t i = 0; i < count; ++i) {
        const Group& g = groups[i];
        const double share = g.area / all.area;
        normals[i] = {to_float(g.mean), static_cast<float>(share)};
        variance += share * (g.scatter.x.x + g.scatter.y.y + g.scatter.z.z);
    }
    if (count == 1 && variance < kApart * kApart && length(groups[0].mean) < kApart)
        return LodNormals::flat();
    return LodNormals::of(normals, static_cast<float>(std::sqrt(variance)));
}

}  // namespace

LodNormals LodNormals::of(const std::array<Normal, kMax>& normals, float alpha) {
    LodNormals out;
    out.alpha_ = alpha;
    const auto whole = [](float lean) {
        return static_cast<std::int16_t>(std::lround(std::clamp(lean, -2.0f, 2.0f) * kLean));
    };
    for (std::size_t i = 0; i < kMax; ++i) {
        out.x_[i] = whole(normals[i].lean.x), out.y_[i] = whole(normals[i].lean.y);
        out.z_[i] = whole(normals[i].lean.z);
        // A normal with any share keeps at least one unit.
        out.share_[i] = normals[i].share > 0
                            ? static_cast<std::uint8_t>(std::max(1L, std::lround(normals[i].share * kAll)))
                            : std::uint8_t{0};
    }
    return out;
}

std::vector<LodNormals> lod_normals_of(const Mesh& mesh, const Mesh& level, double error_m) {
    std::vector<LodNormals> out(level.triangles.size(), LodNormals::flat());
    const ClosestTriangle near(level);
    const auto radius_m = static_cast<float>(4 * error_m);
    std::vector<Part> parts(mesh.triangles.size());
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, parts.size(), 1024), [&](const auto& range) {
        for (std::size_t i = range.begin(); i < range.end(); ++i)
            parts[i] = part_of(mesh, level, near, static_cast<std::uint32_t>(i), radius_m);
    });
    // By owner; equal ones keep the mesh's order, whatever the number of threads.
    tbb::parallel_sort(parts.begin(), parts.end(), [](const Part& a, const Part& b) {
        return a.owner != b.owner ? a.owner < b.owner : a.number < b.number;
    });
    for (std::size_t first = 0; first < parts.size() && parts[first].owner < out.size();) {
        std::size_t end = first + 1;
        while (end < parts.size() && parts[end].owner == parts[first].owner) ++end;
        out[parts[first].owner] = facets_of_parts({&parts[first], end - first});
        first = end;
    }
    return out;
}

}  // namespace hilcam
