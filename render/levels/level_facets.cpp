#include "render/levels/level_facets.h"

#include <algorithm>
#include <cmath>

namespace hilcam {
namespace {

using Part = LevelFacets::Part;

// Normals that lean less apart than this are one facet: a sixth of the narrowest lobe that is kept
// (kept_light.h).
constexpr double kApart = 0.02;

// Parts together: area, and the moments of how they lean.
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

// The axis in which a group scatters most, by powers of its matrix.
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
    const double variance = length(axis);  // its eigenvalue, as the last power was of a unit vector
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

}  // namespace

LevelFacets LevelFacets::of(std::span<Part> parts) {
    const Group all = group_of(parts);
    std::array<Group, 2> halves;
    std::array<Group, kMax> groups;
    std::size_t count = 0;
    const std::size_t two = divide(all, halves);
    for (std::size_t i = 0; i < two; ++i) count += divide(halves[i], std::span(groups).subspan(count, 2));
    std::array<Facet, kMax> facets{};
    double variance = 0;  // within the groups, of both axes together: alpha squared (Beckmann's)
    for (std::size_t i = 0; i < count; ++i) {
        const Group& g = groups[i];
        const double share = g.area / all.area;
        facets[i] = {to_float(g.mean), static_cast<float>(share)};
        variance += share * (g.scatter.x.x + g.scatter.y.y + g.scatter.z.z);
    }
    if (count == 1 && variance < kApart * kApart && length(groups[0].mean) < kApart) return flat();
    return of(facets, static_cast<float>(std::sqrt(variance)));
}

LevelFacets LevelFacets::of(const std::array<Facet, kMax>& facets, float alpha) {
    LevelFacets out;
    out.alpha_ = alpha;
    const auto whole = [](float lean) {
        return static_cast<std::int16_t>(std::lround(std::clamp(lean, -2.0f, 2.0f) * kLean));
    };
    for (std::size_t i = 0; i < kMax; ++i) {
        out.x_[i] = whole(facets[i].lean.x), out.y_[i] = whole(facets[i].lean.y);
        out.z_[i] = whole(facets[i].lean.z);
        // A facet that is there stays there.
        out.share_[i] = facets[i].share > 0
                            ? static_cast<std::uint8_t>(std::max(1L, std::lround(facets[i].share * kAll)))
                            : std::uint8_t{0};
    }
    return out;
}

}  // namespace hilcam
