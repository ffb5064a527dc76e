#include "emulator/scenario/attitude_keys.h"

#include "render/vocabulary/plain_number.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

Mat3d matrix_of(const std::vector<double>& m) {
    return {{m[0], m[1], m[2]}, {m[3], m[4], m[5]}, {m[6], m[7], m[8]}};
}

std::vector<const char*> given_keys(const AttitudeForms& a, const AttitudeWords& words) {
    std::vector<const char*> keys;
    if (a.has_wxyz) keys.push_back(words.quaternion_key);
    if (a.has_mrp) keys.push_back("attitude_mrp");
    if (a.has_dcm) keys.push_back("attitude_dcm");
    if (a.has_euler) keys.push_back("attitude_euler_deg");
    if (a.has_radec) keys.push_back("attitude_radec_deg");
    return keys;
}

}  // namespace

Fields attitude_keys(AttitudeForms& a, const AttitudeWords& words) {
    const std::string body = words.body, frame = words.frame;
    Fields list = {
        optional(quaternion(words.quaternion_key, a.wxyz,
                            "quaternion that transforms components in " + body + " axes into components in " +
                                frame + ", scalar first"),
                 a.has_wxyz),
        optional(vector3("attitude_mrp", a.mrp, 1, {-1e3, 1e3},
                         "instead: modified Rodrigues parameters of the " + body + " relative to " + frame +
                             ", like Basilisk's sigma_BN"),
                 a.has_mrp),
        optional(numbers("attitude_dcm", a.dcm, 1, {-1.001, 1.001}, {9, 9},
                         "instead: direction cosine matrix row by row; the rows are the " + body +
                             " axes in " + frame + " ([BN], which transforms components in " + frame +
                             " into components in " + body + " axes)"),
                 a.has_dcm),
        optional(vector3("attitude_euler_deg", a.euler_rad, kDegree_rad, {-360, 360},
                         "instead: Euler angles of successive rotations from axes of " + frame + " to " +
                             body + " axes, each about an already rotated axis; needs euler_sequence"),
                 a.has_euler),
        optional(choice("euler_sequence", a.euler_sequence, {kEulerSequences.begin(), kEulerSequences.end()},
                        "axes of attitude_euler_deg in order (1 x, 2 y, 3 z); 321: yaw, pitch, roll"),
                 a.has_sequence)};
    if (words.radec)
        list.push_back(optional(vector3("attitude_radec_deg", a.radec_rad, kDegree_rad, {-360, 360},
                                        "instead: [right ascension, declination, roll] of +z in ICRF; roll: "
                                        "position angle of -y (up in the picture) from north through east"),
                                a.has_radec));
    return list;
}

const char* given_key(const AttitudeForms& a, const AttitudeWords& words) {
    const auto keys = given_keys(a, words);
    return keys.empty() ? words.quaternion_key : keys.front();
}

void check_attitude(const AttitudeForms& a, const AttitudeWords& words) {
    if (const auto keys = given_keys(a, words); keys.size() > 1)
        throw KeyError(keys[1], std::string("found besides '") + keys[0] + "'; accepted: one of them");
    if (a.has_euler && !a.has_sequence)
        throw KeyError("attitude_euler_deg", "has no 'euler_sequence'; accepted: with one, as 321");
    if (a.has_sequence && !a.has_euler)
        throw KeyError("euler_sequence",
                       "has no effect without 'attitude_euler_deg'; accepted: with it, or no "
                       "'euler_sequence'");
    if (a.has_radec && !(std::abs(a.radec_rad.y) <= 0.5 * kPi))
        throw refused_key("attitude_radec_deg", "a declination of " + plain(a.radec_rad.y / kDegree_rad),
                          "[right ascension, declination, roll] with a declination from -90 to 90");
    if (a.has_dcm)
        if (const double error = rotation_error(matrix_of(a.dcm)); !(error <= kDcmTolerance))
            throw KeyError(
                "attitude_dcm",
                error >= 2
                    ? std::string(
                          "found a matrix that mirrors, or is no rotation; accepted: one with determinant 1")
                    : "found rows that deviate from unit length and right angles by " + plain(error) +
                          "; accepted: " + plain(kDcmTolerance) + " or less");
}

Quat frame_from_body(const AttitudeForms& a) {
    if (a.has_mrp) return from_mrp(a.mrp);
    if (a.has_dcm) return from_dcm(matrix_of(a.dcm));
    if (a.has_euler) return from_euler(euler_axes(a.euler_sequence), a.euler_rad);
    if (a.has_radec) return from_radec({a.radec_rad.x, a.radec_rad.y, a.radec_rad.z});
    return a.wxyz;
}

}  // namespace hilcam
