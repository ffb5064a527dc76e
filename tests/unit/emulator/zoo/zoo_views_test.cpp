#include "emulator/zoo/zoo_views.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

// The Sun stands 57 degrees from the zenith, which is +z here.
const LightDirections kLight{{std::sin(57 * kDegree_rad), 0, std::cos(57 * kDegree_rad)}, {0, 0, -1}};
const TargetBox kBox{{-1, -2, -6}, {3, 2, 4}};
const Vec3d kTarget_m{100, -50, 20};

Vec3d middle_world_m(const ZooStand& stand) {
    return kTarget_m + to_matrix(stand.world_from_target) * (0.5 * (kBox.min_m + kBox.max_m));
}

TEST(ZooViews, FewHaveEachSideOnceAndEachDistanceTwice) {
    std::set<std::size_t> sides;
    std::map<double, int> distances;
    std::map<ZooLight, int> lights;
    for (const ZooView& view : zoo_views(false))
        sides.insert(view.side), ++distances[view.sizes_away], ++lights[view.light];
    EXPECT_EQ(sides.size(), 6u);
    EXPECT_EQ(distances, (std::map<double, int>{{0.5, 2}, {1.2, 2}, {9, 2}}));
    EXPECT_EQ(lights.size(), 4u);
    for (const auto& [light, count] : lights) EXPECT_LE(count, 2);
}

TEST(ZooViews, AllAreEverySideFromEveryDistanceByEveryLight) {
    std::set<std::string> names;
    for (const ZooView& view : zoo_views(true)) names.insert(name_of(view));
    EXPECT_EQ(names.size(), 6u * 3 * 4);
    for (const ZooView& view : zoo_views(false)) EXPECT_TRUE(names.contains(name_of(view))) << name_of(view);
    EXPECT_EQ(name_of({3, 1.2, ZooLight::kEarth}), "-y 1.2 earth");
}

TEST(ZooViews, TheLightHasItsPhaseAndTheEarthItsPlace) {
    const double phases_deg[] = {25, 88, 150, 150};
    for (const ZooView& view : zoo_views(true)) {
        const ZooStand stand = stand_of(view, kBox, kTarget_m, kLight);
        const Vec3d to_camera = normalized(stand.camera.position_world_m - middle_world_m(stand));
        EXPECT_NEAR(angle_between_rad(to_camera, kLight.to_sun),
                    phases_deg[static_cast<std::size_t>(view.light)] * kDegree_rad, 1e-9);
        // The camera looks at it.
        EXPECT_NEAR(angle_between_rad(to_matrix(stand.camera.world_from_body) * Vec3d{0, 0, 1}, -to_camera),
                    0, 1e-7);
        // Of the phase's circle about the Sun it is the place that is farthest from the Earth, or nearest to it.
        const double phase_rad = phases_deg[static_cast<std::size_t>(view.light)] * kDegree_rad;
        const double nadir_rad = angle_between_rad(to_camera, kLight.to_earth);
        const double sun_nadir_rad = 123 * kDegree_rad;
        const double expected_rad =
            view.light == ZooLight::kEarth
                ? std::abs(sun_nadir_rad - phase_rad)
                : std::min(sun_nadir_rad + phase_rad, 2 * kPi - sun_nadir_rad - phase_rad);
        EXPECT_NEAR(nadir_rad, expected_rad, 1e-9) << name_of(view);
    }
}

TEST(ZooViews, TheSideFacesTheCamera) {
    const Vec3d axes[] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    for (const ZooView& view : zoo_views(false)) {
        const ZooStand stand = stand_of(view, kBox, kTarget_m, kLight);
        const Vec3d to_camera = normalized(stand.camera.position_world_m - middle_world_m(stand));
        const Vec3d axis = to_matrix(stand.world_from_target) * axes[view.side];
        // atan(hypot(0.25, 0.15)) = 16.2 degrees aslant.
        EXPECT_NEAR(angle_between_rad(axis, to_camera), 16.25 * kDegree_rad, 0.01 * kDegree_rad)
            << name_of(view);
    }
}

// Away from the nearest corner, in the direction of the camera, by so many times the longest side: 10 m.
TEST(ZooViews, SizesAreCountedFromTheNearestCorner) {
    for (const ZooView& view : zoo_views(true)) {
        const ZooStand stand = stand_of(view, kBox, kTarget_m, kLight);
        const Vec3d to_camera = normalized(stand.camera.position_world_m - middle_world_m(stand));
        double nearest_m = 1e9;
        for (const double x : {kBox.min_m.x, kBox.max_m.x})
            for (const double y : {kBox.min_m.y, kBox.max_m.y})
                for (const double z : {kBox.min_m.z, kBox.max_m.z}) {
                    const Vec3d corner_m = kTarget_m + to_matrix(stand.world_from_target) * Vec3d{x, y, z};
                    nearest_m = std::min(nearest_m, dot(stand.camera.position_world_m - corner_m, to_camera));
                }
        EXPECT_NEAR(nearest_m, 10 * view.sizes_away, 1e-9) << name_of(view);
    }
}

}  // namespace
}  // namespace hilcam
