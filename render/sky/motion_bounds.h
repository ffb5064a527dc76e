#pragma once
// The bounds of motion hold for every place, velocity, attitude and rate, wherever they come from: files, kernels, commands,
// configured poses, motions, joints. Beyond them a number is a mistake.
//
// They keep arithmetic safe. Ray space is single precision (frame_context.h), and the acceleration structure ends the program at
// places from 1.8e18 m on, the root of the largest float. Things at opposite bounds are 3e15 m apart, whose square is 1e31.
// What is no number lies outside of all bounds. Any thread; loop.

#include <cmath>
#include <string>

#include "render/vocabulary/pose.h"

namespace hilcam {

// 10 000 au from the world's origin: Voyager 1 is at 170 au, and a double is good to 0.2 m there.
inline constexpr double kFarthestPlace_m = 1.5e15;
// The Sun may be farther, as parallel light of far away: nothing is placed there.
inline constexpr double kFarthestSun_m = 1e18;
// The speed of light, rounded up.
inline constexpr double kFastestMotion_m_s = 3e8;
// A thousand turns a second, and a hundred thousand turns of a joint.
inline constexpr double kFastestTurn_rad_s = 6300, kMaxTurned_rad = 6.3e5;
// A quaternion's norm may differ from 1 by so much: it may have been written in four digits.
inline constexpr double kNormTolerance = 1e-3;

// True when the vector is at most that long.
inline bool is_within(Vec3d v, double most) { return dot(v, v) <= most * most; }
// True when the quaternion is a rotation.
bool is_turn(Quat q);
bool is_possible(const Pose& pose);
bool is_possible(const Motion& motion);
// Takes over what can be of a motion: in place of a place or an attitude that cannot be, `kept` keeps its own, and a velocity or rate
// that cannot be is 0, as that of a place that is kept. False: something could not be.
bool take_possible(const Motion& found, Motion& kept);
inline bool is_possible_turn_of_joint(double angle_rad, double rate_rad_s) {
    return std::abs(angle_rad) <= kMaxTurned_rad && std::abs(rate_rad_s) <= kFastestTurn_rad_s;
}

// Says what of a motion is out of its bounds, and what is accepted: "a place 2e+20 m from the world's origin; accepted: at most
// 1.5e+15 m". Empty: nothing is. Not for the loop.
std::string impossible_part(const Motion& motion);

}  // namespace hilcam
