#pragma once
// The views of a member of the zoo: from which side, how far away, and in which light.
//
// The target is turned so that the side faces the camera, and the camera goes to where the light has its
// phase angle. Sun and Earth stay where the scenario has them.

#include <array>
#include <string>
#include <vector>

#include "render/vocabulary/pose.h"

namespace hilcam {

// The first three are phase angles (Sun - target - camera), with the Earth behind the target as far as
// possible. The last one is the shadow side at 150 degrees, seen from the direction of the Earth, which
// lights it.
enum class ZooLight { kSun25, kSun88, kSun150, kEarth };
inline constexpr std::array<const char*, 4> kZooLightNames = {"sun 25", "sun 88", "sun 150", "earth"};
// True when at most half of what the camera sees is sunlit.
inline constexpr bool is_shadow_side(ZooLight light) {
    return light == ZooLight::kSun150 || light == ZooLight::kEarth;
}

inline constexpr std::array<const char*, 6> kZooSideNames = {"+x", "-x", "+y", "-y", "+z", "-z"};

struct ZooView {
    std::size_t side = 0;  // index in kZooSideNames
    double sizes_away = 1.2;
    ZooLight light = ZooLight::kSun25;
};
std::string name_of(const ZooView& view);

// Returns all 72 combinations of sides, distances and lights, or six of them in which each side comes once,
// each distance twice, and each light once or twice.
std::vector<ZooView> zoo_views(bool all);

// The target's bounding box, in its own axes.
struct TargetBox {
    Vec3d min_m, max_m;
};
// Unit vectors from the target, in world axes.
struct LightDirections {
    Vec3d to_sun, to_earth;
};
struct ZooStand {
    Pose camera;  // the camera's pose; its body has the same axes
    Quat world_from_target;
};
// position_world_m: the target's origin. The distance is measured from the plane through the box's corner
// nearest to the camera, in units of the box's longest side. The camera looks at the box's centre.
ZooStand stand_of(const ZooView& view, const TargetBox& box, Vec3d position_world_m,
                  const LightDirections& light);

}  // namespace hilcam
