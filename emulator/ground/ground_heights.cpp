#include "emulator/ground/ground_heights.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

#include "emulator/ground/globe_loader.h"
#include "emulator/ground/ground_things.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

constexpr std::size_t kMapBytes = std::size_t{64} << 20;

}  // namespace

LocalPlane::LocalPlane(const Geodetic& middle, const Figure& figure) : radius_m(figure.equatorial_radius_m) {
    const Mat3d axes = transposed(body_fixed_from_local(middle));
    east = axes.x, north = axes.y, up = axes.z;
}

Vec3d LocalPlane::place(double east_m, double north_m) const {
    return normalized(up + east_m / radius_m * east + north_m / radius_m * north);
}

Vec2d LocalPlane::along(Vec3d place) const {
    const double scale = radius_m / dot(place, up);
    return {scale * dot(place, east), scale * dot(place, north)};
}

std::string LocalPlane::text_of(Vec3d place) const {
    const Vec2d at_m = along(place);
    return fmt::format("{:.8f},{:.8f},{:.4f},{:.4f}", std::atan2(place.y, place.x) / kDegree_rad,
                       std::asin(std::clamp(place.z, -1.0, 1.0)) / kDegree_rad, at_m.x, at_m.y);
}

GroundSlope HeightSquare::slope(int column, int row) const {
    double east = 0, north = 0;
    for (int k = -1; k <= 1; ++k) {
        east += (height_m(column + 1, row + k) - height_m(column - 1, row + k)) / (6 * spacing_m);
        north += (height_m(column + k, row + 1) - height_m(column + k, row - 1)) / (6 * spacing_m);
    }
    GroundSlope out;
    out.slope_rad = std::atan(std::hypot(east, north));
    for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x)
            out.step_m = std::max(out.step_m, std::abs(height_m(column + x, row + y) - height_m(column, row) -
                                                       spacing_m * (x * east + y * north)));
    return out;
}

GroundHeights::GroundHeights(const GlobeConfig& globe, const MappedBody& body)
    : surface_(body.figure, open_maps(globe, body), kMapBytes), details_(details_of(globe, body)) {}

void GroundHeights::find(std::span<const Vec3d> places, int side, double reach_m, double spacing_m,
                         std::span<double> heights_m) {
    surface_.find_heights(places, spacing_m, heights_m);
    const GroundPatch patch{side,
                            places,
                            heights_m,
                            {},
                            places[places.size() / 2],
                            reach_m / surface_.figure().equatorial_radius_m,
                            spacing_m};
    for (const auto& detail : details_) detail->add_wide(patch), detail->add(patch);
}

HeightSquare GroundHeights::square(const LocalPlane& plane, double within_m, double spacing_m) {
    HeightSquare out;
    out.half = static_cast<int>(std::min(std::floor(within_m / spacing_m), kMaxListed));
    out.spacing_m = spacing_m;
    require_few(1.0 * out.side() * out.side(), "heights", "--within-m, --spacing-m");
    std::vector<Vec3d> places;
    for (int y = -out.half - 1; y <= out.half + 1; ++y)
        for (int x = -out.half - 1; x <= out.half + 1; ++x)
            places.push_back(plane.place(x * spacing_m, y * spacing_m));
    out.heights_m.resize(places.size());
    find(places, out.side(), (within_m + 2 * spacing_m) * std::sqrt(2), spacing_m, out.heights_m);
    return out;
}

double GroundHeights::height_m(Vec3d place, double spacing_m) {
    double height_m = 0;
    find({&place, 1}, 1, 0, spacing_m, {&height_m, 1});
    return height_m;
}

}  // namespace hilcam
