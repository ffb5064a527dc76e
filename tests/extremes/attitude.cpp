// Quaternions where they are least sure of themselves: no turn, half a turn, whole turns, nearly parallel,
// unnormalised, denormal. Truth is worked out in extended precision (64 bits of mantissa on x86).

#include <array>
#include <limits>

#include "io/commands/command_codec.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/units.h"
#include "tests/extremes/groups.h"

namespace hilcam::extremes {
namespace {

constexpr double kDenormal = std::numeric_limits<double>::denorm_min();

// The angle between two attitudes [rad]; by the sine, which keeps its digits where it is small.
double angle_between(Quat a, Quat b) {
    const Quat d = conjugate(a) * b;
    return 2 * std::atan2(std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z), std::abs(d.w));
}
Quat about(Vec3d unit_axis, long double angle_rad) {
    const auto s = static_cast<double>(std::sin(angle_rad / 2));
    return {static_cast<double>(std::cos(angle_rad / 2)), s * unit_axis.x, s * unit_axis.y, s * unit_axis.z};
}
// Its components are exact in binary, and so is its length.
constexpr Vec3d kAxis{0.5, 0.5, 0.70710678118654752};

std::string components_of(Quat q) {
    std::string out(1, '[');
    return out.append(text(q.w))
        .append(", ")
        .append(text(q.x))
        .append(", ")
        .append(text(q.y))
        .append(", ")
        .append(text(q.z))
        .append("]");
}

}  // namespace

Group rotation_vectors() {
    Group group{
        "RotationVectors",
        "Attitude: rotation vectors",
        "angle [rad]",
        {"its quaternion's real part", "its quaternion's vector part"},
        "cos(a/2) and sin(a/2) in extended precision; the error of the vector part is relative where it is "
        "below 1.",
        "4 roundings to double precision, and those of the angle itself.",
        {}};
    for (const double angle :
         {0.0, kDenormal, 1e-310, 1e-160, 1e-8, 0.99e-4, 1.01e-4, 1.0, kPi, 2 * kPi, 1e3, 1e6})
        group.cases.push_back(
            {text(angle), {4 * kDoubleGrain * (1 + angle), 4 * kDoubleGrain * (1 + angle)}, [angle] {
                 const Quat q = from_rotation_vector({angle, 0, 0});
                 const long double half = static_cast<long double>(angle) / 2;
                 const auto c = static_cast<double>(std::cos(half)), s = static_cast<double>(std::sin(half));
                 // Half of the least denormal is no number of its own.
                 const double scale = std::abs(s) < 1e-300 ? 1 : std::min(1.0, std::abs(angle));
                 return std::vector<Found>{{c, std::abs(q.w - c)},
                                           {s, std::abs(q.x - s) / scale + std::abs(q.y) + std::abs(q.z)}};
             }});
    return group;
}

Group interpolated_attitudes() {
    Group group{
        "InterpolatedAttitudes",
        "Attitude: a quarter of the way between two",
        "angle between them [rad]",
        {"angle from the first [rad]"},
        "a quarter of the angle about the same axis.",
        "8 roundings to double precision; below 1e-4 rad the chord stands for the arc, which is off by 0.02 "
        "angle^3 at most. Beyond half a turn the short way is a quarter of what is missing.",
        {}};
    for (const double angle :
         {0.0, 1e-300, 1e-12, 1e-8, 0.99e-4, 1.01e-4, 1e-3, 1.0, 3.0, 3.3, 6.28, 2 * kPi})
        group.cases.push_back(
            {text(angle),
             {8 * kDoubleGrain * (1 + angle) + (angle < 2e-4 ? 0.02 * std::pow(angle, 3) : 0)},
             [angle] {
                 const Quat a = about({0, 1, 0}, 0.3L), turn = about({0, 1, 0}, angle), b = a * turn;
                 const Quat found = slerp(a, b, 0.25);
                 const double way = angle <= kPi ? 0.25 * angle : 0.25 * (angle - 2 * kPi);
                 return std::vector<Found>{{way, angle_between(a * about({0, 1, 0}, way), found)}};
             }});
    return group;
}

Group half_turns() {
    Group group{"HalfTurns",
                "Attitude: matrix to quaternion near half a turn",
                "angle short of half a turn [rad]; axis",
                {"angle [rad]"},
                "the quaternion that the matrix was made of.",
                "16 roundings to double precision: nine elements of two products each, and a root that is at "
                "least 1/2.",
                {}};
    struct Axis {
        const char* name;
        Vec3d dir;
    };
    for (const Axis axis : {Axis{"x", {1, 0, 0}}, {"y", {0, 1, 0}}, {"z", {0, 0, 1}}, {"all", kAxis}})
        for (const double less : {0.0, 1e-16, 1e-8, 1e-3})
            group.cases.push_back(
                {text(less) + "; " + axis.name, {16 * kDoubleGrain}, [axis, less] {
                     const Quat q = normalized(about(axis.dir, kPi - less));
                     return std::vector<Found>{{kPi - less, angle_between(q, to_quat(to_matrix(q)))}};
                 }});
    return group;
}

// What comes over the wire.
Group attitude_commands() {
    Group group{"AttitudeCommands",
                "Attitude: quaternions in pose commands",
                "quaternion [w, x, y, z]",
                {"accepted (1) or refused (0)", "norm of what the world gets, less 1"},
                "docs/protocol.md: a norm within 0.001 of 1 is accepted and made 1.",
                "2 roundings to double precision.",
                {}};
    struct Row {
        Quat q;
        bool right;
    };
    constexpr double kHuge = 1e200, kNone = std::numeric_limits<double>::quiet_NaN();
    for (const Row& row : {Row{{1, 0, 0, 0}, true},
                           {{-1, 0, 0, 0}, true},
                           {{0, 0, 0, -1}, true},
                           {{1.0009, 0, 0, 0}, true},
                           {{0.9991, 0, 0, 0}, true},
                           {{0.5, 0.5, 0.5, 0.5}, true},
                           {{1, kDenormal, 0, 0}, true},
                           {{kDenormal, 1, 0, 0}, true},
                           {{1.0011, 0, 0, 0}, false},
                           {{0.9989, 0, 0, 0}, false},
                           {{2, 0, 0, 0}, false},
                           {{0, 0, 0, 0}, false},
                           {{kDenormal, kDenormal, 0, 0}, false},
                           {{1e-160, 0, 0, 0}, false},
                           {{kHuge, 0, 0, 0}, false},
                           {{1, 0, kNone, 0}, false},
                           {{1, 0, 0, std::numeric_limits<double>::infinity()}, false}})
        group.cases.push_back(
            {components_of(row.q), {0, 2 * kDoubleGrain}, [row] {
                 PoseCommand pose;
                 pose.motion.pose.world_from_body = row.q;
                 std::array<std::uint8_t, kMaxCommandBytes> bytes;
                 const std::size_t size = encode_command(pose, 1, bytes);
                 const DecodedCommand decoded = decode_command(std::span(bytes).first(size));
                 const bool accepted = decoded.status == CommandStatus::kAccepted;
                 double beside = 0;
                 if (accepted)
                     beside = std::abs(
                         norm(std::get<PoseCommand>(decoded.command).motion.pose.world_from_body) - 1);
                 return std::vector<Found>{{row.right ? 1.0 : 0.0, accepted == row.right ? 0.0 : 1.0},
                                           {0, beside}};
             }});
    return group;
}

}  // namespace hilcam::extremes
