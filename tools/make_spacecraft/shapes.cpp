#include "tools/make_spacecraft/shapes.h"

#include <algorithm>
#include <cmath>

#include "render/vocabulary/units.h"

namespace spacecraft {
namespace {

// Linear interpolation on the triangular lattice with the given cell: flat facets that meet in sharp creases.
double facets(std::uint32_t seed, double x, double y, double cell) {
    // Skew the plane so that triangles become halves of unit squares.
    const double sx = (x - y / std::sqrt(3.0)) / cell;
    const double sy = 2 * y / std::sqrt(3.0) / cell;
    const double fx = std::floor(sx), fy = std::floor(sy);
    const auto i = static_cast<std::int64_t>(fx), j = static_cast<std::int64_t>(fy);
    const double u = sx - fx, v = sy - fy;
    const double b = lattice_value(seed, i + 1, j), c = lattice_value(seed, i, j + 1);
    if (u + v < 1) {
        const double a = lattice_value(seed, i, j);
        return a + u * (b - a) + v * (c - a);
    }
    const double d = lattice_value(seed, i + 1, j + 1);
    return d + (1 - u) * (c - d) + (1 - v) * (b - d);
}

}  // namespace

double lattice_value(std::uint32_t seed, std::int64_t i, std::int64_t j) {
    // Finalizer of MurmurHash3 (A. Appleby, public domain) over the mixed coordinates.
    std::uint64_t h = seed * 0x9E3779B97F4A7C15u ^ static_cast<std::uint64_t>(i) * 0xC2B2AE3D27D4EB4Fu ^
                      static_cast<std::uint64_t>(j) * 0x165667B19E3779F9u;
    h = (h ^ (h >> 33)) * 0xFF51AFD7ED558CCDu;
    h = (h ^ (h >> 33)) * 0xC4CEB9FE1A85EC53u;
    h ^= h >> 33;
    return static_cast<double>(h >> 11) * 0x1p-53;
}

Patch sheet(std::string part, std::string material, Vec3d corner, Vec3d along_u, Vec3d along_v,
            double detail) {
    return {std::move(part),
            std::move(material),
            [=](double u, double v) { return corner + u * along_u + v * along_v; },
            1,
            1,
            detail,
            length(along_u) / length(along_v)};
}

Patch blanket(std::string part, std::string material, Vec3d corner, Vec3d along_u, Vec3d along_v,
              double detail, std::uint32_t seed) {
    const double width = length(along_u), height = length(along_v);
    const Vec3d normal = normalized(cross(along_u, along_v));
    auto at = [=](double u, double v) {
        const double x = u * width, y = v * height;
        // Zero at the seams, one a few centimetres inside.
        const double edge = std::min({x, width - x, y, height - y});
        const double free = std::clamp(edge / 0.06, 0.0, 1.0);
        const double bulge = 0.018 * 4 * u * (1 - u) * 4 * v * (1 - v);
        const double crumple = 0.016 * (facets(seed, x, y, 0.18) - 0.5) +
                               0.007 * (facets(seed + 1, x, y, 0.06) - 0.5) +
                               0.0018 * (facets(seed + 2, x, y, 0.02) - 0.5);
        return corner + u * along_u + v * along_v + (bulge + free * crumple + 0.012) * normal;
    };
    return {std::move(part), std::move(material), at, 2, 2, detail * width * height, width / height};
}

void add_box(std::vector<Patch>& patches, const std::string& part, const std::string& material,
             const Placement& place, Vec3d size, double detail) {
    const Vec3d ex = size.x * place.x, ey = size.y * place.y, ez = size.z * place.z;
    const Vec3d low = place.origin - 0.5 * (ex + ey + ez);
    patches.push_back(sheet(part, material, low, ey, ex, detail));
    patches.push_back(sheet(part, material, low + ez, ex, ey, detail));
    patches.push_back(sheet(part, material, low, ex, ez, detail));
    patches.push_back(sheet(part, material, low + ey, ez, ex, detail));
    patches.push_back(sheet(part, material, low, ez, ey, detail));
    patches.push_back(sheet(part, material, low + ex, ey, ez, detail));
}

Patch revolution(std::string part, std::string material, const Placement& place,
                 std::function<std::array<double, 2>(double)> profile, int min_around, int min_along,
                 double detail) {
    auto at = [=](double u, double v) {
        const auto [radius, z] = profile(v);
        const double angle = 2 * hilcam::kPi * u;
        return place({radius * std::cos(angle), radius * std::sin(angle), z});
    };
    return {std::move(part), std::move(material), at, min_around, min_along, detail, 2};
}

Patch tube(std::string part, std::string material, Vec3d a, Vec3d b, double radius, double detail) {
    const Vec3d z = normalized(b - a);
    const Vec3d x = normalized(std::abs(z.z) < 0.9 ? cross(Vec3d{0, 0, 1}, z) : cross(Vec3d{1, 0, 0}, z));
    const double span = length(b - a);
    Patch patch = revolution(
        std::move(part), std::move(material), {a, x, cross(z, x)},
        [=](double t) -> std::array<double, 2> {
            return {radius, t * span};
        },
        6, 1, detail);
    patch.aspect = 2 * hilcam::kPi * radius / span * 8;
    return patch;
}

}  // namespace spacecraft
