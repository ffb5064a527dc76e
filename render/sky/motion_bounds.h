#pragma once
// The bounds of every position, velocity, attitude and rate, from any source: files, kernels, commands,
// configured poses, motions, joints. A number outside them is a mistake.
//
// They keep arithmetic safe. Ray space is single precision (frame_context.h), and the acceleration structure
// ends the program at positions from 1.8e18 m on, the root of the largest float. Things at opposite bounds
// are 3e15 m apart, whose square is 1e31. Values that are not finite are outside all bounds. Any thread;
// loop.

#include <cmath>
#include <string>

#include "render/vocabulary/pose.h"

namespace hilcam {

// 10 000 au from the world's origin: Voyager 1 is at 170 au, and a double resolves 0.2 m there.
inline constexpr double kFarthestPlace_m = 1.5e15;
// The Sun may be farther, for parallel light: nothing is placed there.
inline constexpr double kFarthestSun_m = 1e18;
// The speed of light, rounded up.
inline constexpr double kFastestMotion_m_s = 3e8;
// A thousand turns per second, and a hundred thousand turns of a joint.
inline constexpr double kFastestTurn_rad_s = 6300, kMaxTurned_rad = 6.3e5;
// The amount by which a quaternion's norm may differ from 1: it may have been written with four digits.
inline constexpr double kNormTolerance = 1e-3;

// True when the vector is at most this long.
inline bool is_within(Vec3d v, double most) { return dot(v, v) <= most * most; }
// True when the quaternion is a rotation.
bool is_turn(Quat q);
bool is_possible(const Pose& pose);
bool is_possible(const Motion& motion);
// Copies what is possible from a motion to `kept`, which keeps its own position or attitude if the new one is
// impossible; an impossible velocity or rate becomes 0, as does that of a kept position. Returns false if
// something was impossible.
bool take_possible(const Motion& found, Motion& kept);
inline bool is_possible_turn_of_joint(double angle_rad, double rate_rad_s) {
    return std::abs(angle_rad) <= kMaxTurned_rad && std::abs(rate_rad_s) <= kFastestTurn_rad_s;
}

// Describes what is out of bounds and what is accepted: "a place 2e+20 m from the world's origin; accepted:
// at most 1.5e+15 m". Empty: nothing is. Not for the loop.
std::string impossible_part(const Motion& motion);

}  // namespace hilcam
