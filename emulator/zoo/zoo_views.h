#pragma once
// The views of a member of the zoo: from which side, how far away, and by what light.
//
// The target is turned so that the side faces the camera, and the camera goes where the light has its phase
// angle. Sun and Earth stay where the scenario has them.

#include <array>
#include <string>
#include <vector>

#include "render/vocabulary/pose.h"

namespace hilcam {

// The first three are phase angles (Sun - target - camera) with the Earth behind the target as far as that can
// be. The last one is the shadow side, at 150 degrees, from the direction of the Earth, which lights it.
enum class ZooLight { kSun25, kSun88, kSun150, kEarth };
inline constexpr std::array<const char*, 4> kZooLightNames = {"sun 25", "sun 88", "sun 150", "earth"};
// Half or less of what a camera sees there is sunlit.
inline constexpr bool is_shadow_side(ZooLight light) {
    return light == ZooLight::kSun150 || light == ZooLight::kEarth;
}

inline constexpr std::array<const char*, 6> kZooSideNames = {"+x", "-x", "+y", "-y", "+z", "-z"};

struct ZooView {
    std::size_t side = 0;  // into kZooSideNames
    double sizes_away = 1.2;
    ZooLight light = ZooLight::kSun25;
};
std::string name_of(const ZooView& view);

// True: all sides from all distances by every light, 72 of them. False: six of these, in which each side comes once,
// each distance twice, and each light once or twice.
std::vector<ZooView> zoo_views(bool all);

// The target's box, in its own axes.
struct TargetBox {
    Vec3d min_m, max_m;
};
// Unit vectors, world axes, from the target.
struct LightDirections {
    Vec3d to_sun, to_earth;
};
struct ZooStand {
    Pose camera;  // pose of the camera, whose body has the same axes
    Quat world_from_target;
};
// position_world_m: of the target's origin. "Sizes away" is the distance from the plane through the box's corner that is
// nearest to the camera, in the longest side of the box. The camera looks at the box's middle.
ZooStand stand_of(const ZooView& view, const TargetBox& box, Vec3d position_world_m,
                  const LightDirections& light);

}  // namespace hilcam
