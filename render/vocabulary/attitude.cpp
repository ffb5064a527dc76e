#include "render/vocabulary/attitude.h"

#include <algorithm>
#include <cmath>

#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

// East and north on the sky, where right ascension and declination grow.
struct SkyAxes {
    Vec3d east, north, ahead;
};
SkyAxes sky_axes(double right_ascension_rad, double declination_rad) {
    const double ca = std::cos(right_ascension_rad), sa = std::sin(right_ascension_rad);
    const double cd = std::cos(declination_rad), sd = std::sin(declination_rad);
    return {{-sa, ca, 0}, {-sd * ca, -sd * sa, cd}, {cd * ca, cd * sa, sd}};
}

double positive_angle(double rad) {
    const double turned = std::fmod(rad, 2 * kPi);
    return turned < 0 ? turned + 2 * kPi : turned;
}

Mat3d scaled_sum(double a, const Mat3d& m, double b, const Mat3d& n) {
    return {a * m.x + b * n.x, a * m.y + b * n.y, a * m.z + b * n.z};
}

}  // namespace

Quat from_mrp(Vec3d sigma) {
    const double s2 = dot(sigma, sigma);
    const double scale = 1 / (1 + s2);
    return normalized(Quat{(1 - s2) * scale, 2 * sigma.x * scale, 2 * sigma.y * scale, 2 * sigma.z * scale});
}

Vec3d mrp_of(Quat q) {
    if (q.w < 0) q = {-q.w, -q.x, -q.y, -q.z};
    return Vec3d{q.x, q.y, q.z} / (1 + q.w);
}

double rotation_error(const Mat3d& m) {
    const Mat3d square = m * transposed(m);
    double error = 0;
    for (const Vec3d row : {square.x - Vec3d{1, 0, 0}, square.y - Vec3d{0, 1, 0}, square.z - Vec3d{0, 0, 1}})
        error = std::max({error, std::abs(row.x), std::abs(row.y), std::abs(row.z)});
    return dot(m.x, cross(m.y, m.z)) > 0 ? error : std::max(error, 2.0);
}

Quat from_dcm(const Mat3d& body_from_frame) {
    // Newton and Schulz's steps to the orthogonal factor of the polar decomposition, the nearest rotation:
    // each squares the error (Higham, Functions of Matrices, 2008, section 8.3).
    Mat3d m = body_from_frame;
    for (int i = 0; i < 3; ++i) m = scaled_sum(1.5, m, -0.5, m * (transposed(m) * m));
    return to_quat(transposed(m));
}

Quat from_euler(std::array<int, 3> sequence, Vec3d angles_rad) {
    const std::array<double, 3> angles = {angles_rad.x, angles_rad.y, angles_rad.z};
    Quat out;
    for (std::size_t i = 0; i < 3; ++i) {
        Vec3d turn;
        (sequence[i] == 1 ? turn.x : sequence[i] == 2 ? turn.y : turn.z) = angles[i];
        out = out * from_rotation_vector(turn);
    }
    return normalized(out);
}

std::array<int, 3> euler_axes(std::size_t index) {
    const char* word = kEulerSequences.at(index);
    return {word[0] - '0', word[1] - '0', word[2] - '0'};
}

Quat from_radec(const RaDecRoll& p) {
    const SkyAxes sky = sky_axes(p.right_ascension_rad, p.declination_rad);
    const Vec3d up = std::cos(p.roll_rad) * sky.north + std::sin(p.roll_rad) * sky.east;
    const Vec3d y = -up;
    return to_quat(transposed(Mat3d{cross(y, sky.ahead), y, sky.ahead}));
}

RaDecRoll radec_of(Quat icrf_from_camera) {
    const Mat3d m = to_matrix(icrf_from_camera);
    const Vec3d ahead{m.x.z, m.y.z, m.z.z}, up{-m.x.y, -m.y.y, -m.z.y};
    const double off_axis = std::hypot(ahead.x, ahead.y);
    RaDecRoll out;
    // Below 1e-12 the direction off the pole is rounding.
    out.right_ascension_rad = off_axis > 1e-12 ? positive_angle(std::atan2(ahead.y, ahead.x)) : 0;
    out.declination_rad = std::atan2(ahead.z, off_axis);
    const SkyAxes sky = sky_axes(out.right_ascension_rad, out.declination_rad);
    out.roll_rad = positive_angle(std::atan2(dot(up, sky.east), dot(up, sky.north)));
    return out;
}

}  // namespace hilcam
