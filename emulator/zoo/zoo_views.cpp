#include "emulator/zoo/zoo_views.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

constexpr std::array kDistances_sizes = {0.5, 1.2, 9.0};
constexpr std::array<double, 4> kPhases_deg = {25, 88, 150, 150};

// Returns the unit vector of the component of `of` perpendicular to `axis`; any perpendicular vector if that
// component is zero.
Vec3d part_across(Vec3d axis, Vec3d of) {
    Vec3d part = of - dot(of, axis) * axis;
    if (!(length(part) > 1e-6)) part = cross(axis, std::abs(axis.x) < 0.9 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0});
    return normalized(part);
}

// Returns an oblique view of a side, so that adjacent walls are visible and no edge is parallel to the
// picture's rows.
Vec3d direction_of_side(std::size_t side) {
    constexpr double kAside = 0.25, kFurtherAside = 0.15;
    const std::size_t axis = side / 2;
    std::array<double, 3> d{};
    d[axis] = side % 2 == 0 ? 1 : -1;
    d[(axis + 1) % 3] = kAside, d[(axis + 2) % 3] = kFurtherAside;
    return normalized(Vec3d{d[0], d[1], d[2]});
}

Vec3d camera_direction(ZooLight light, const LightDirections& at) {
    const double phase_rad = kPhases_deg[static_cast<std::size_t>(light)] * kDegree_rad;
    const Vec3d wanted = light == ZooLight::kEarth ? at.to_earth : -at.to_earth;
    return std::cos(phase_rad) * at.to_sun + std::sin(phase_rad) * part_across(at.to_sun, wanted);
}

// Returns the rotation with columns that are a frame of z and of the vector closest to y_hint perpendicular
// to it.
Mat3d frame_of(Vec3d z, Vec3d y_hint) {
    const Vec3d y = part_across(z, y_hint), x = cross(y, z);
    return {{x.x, y.x, z.x}, {x.y, y.y, z.y}, {x.z, y.z, z.z}};
}

}  // namespace

std::string name_of(const ZooView& view) {
    return fmt::format("{} {:g} {}", kZooSideNames[view.side], view.sizes_away,
                       kZooLightNames[static_cast<std::size_t>(view.light)]);
}

std::vector<ZooView> zoo_views(bool all) {
    if (!all)
        return {{0, 0.5, ZooLight::kSun25},  {1, 1.2, ZooLight::kEarth}, {2, 9, ZooLight::kSun88},
                {3, 1.2, ZooLight::kSun150}, {4, 0.5, ZooLight::kSun88}, {5, 9, ZooLight::kEarth}};
    std::vector<ZooView> views;
    for (std::size_t side = 0; side < kZooSideNames.size(); ++side)
        for (const double sizes : kDistances_sizes)
            for (std::size_t light = 0; light < kZooLightNames.size(); ++light)
                views.push_back({side, sizes, static_cast<ZooLight>(light)});
    return views;
}

ZooStand stand_of(const ZooView& view, const TargetBox& box, Vec3d position_world_m,
                  const LightDirections& light) {
    const Vec3d side = direction_of_side(view.side);
    const Vec3d to_camera = camera_direction(view.light, light);
    const Vec3d up = -light.to_earth;
    const std::size_t axis = view.side / 2;
    const Vec3d next{axis == 2 ? 1.0 : 0.0, axis == 0 ? 1.0 : 0.0, axis == 1 ? 1.0 : 0.0};
    // Rolls the target slightly in the picture, because real targets are not upright.
    constexpr double kRoll_rad = 0.3;
    const Vec3d up_seen = part_across(to_camera, up);
    const Vec3d leaning = std::cos(kRoll_rad) * up_seen + std::sin(kRoll_rad) * cross(to_camera, up_seen);
    ZooStand out;
    const Mat3d world_from_target = frame_of(to_camera, leaning) * transposed(frame_of(side, next));
    out.world_from_target = to_quat(world_from_target);

    const Vec3d half = 0.5 * (box.max_m - box.min_m), middle = 0.5 * (box.max_m + box.min_m);
    const double size_m = 2 * std::max({half.x, half.y, half.z});
    const double reach_m = std::abs(side.x) * half.x + std::abs(side.y) * half.y + std::abs(side.z) * half.z;
    const Vec3d middle_world_m = position_world_m + world_from_target * middle;
    out.camera = {middle_world_m + (reach_m + view.sizes_away * size_m) * to_camera,
                  look_along(-to_camera, up_seen)};
    return out;
}

}  // namespace hilcam
