#pragma once
// The forms that people write attitudes in, as the program's own: the unit quaternion that turns body axes
// into a frame's (vec.h). docs/conventions.md has one attitude in all of them.

#include <array>

#include "render/vocabulary/vec.h"

namespace hilcam {

// Modified Rodrigues parameters of the body against the frame, Basilisk's sigma_BN: e tan(angle/4) of the
// turn by `angle` about e that takes the frame's axes to the body's. Any length: beyond 1 it is the long way
// round. Schaub & Junkins, Analytical Mechanics of Space Systems, 2018, section 3.7.
Quat from_mrp(Vec3d sigma);
// The short way round: of length 1 at most.
Vec3d mrp_of(Quat frame_from_body);

// Returns how far a matrix is from being a rotation: the largest entry of |M M^T - 1|, or 2 when it mirrors.
double rotation_error(const Mat3d& m);
// A matrix within this error is taken for a rotation that was written with few digits.
inline constexpr double kDcmTolerance = 1e-4;
// A direction cosine matrix [BN], which takes a vector's components in the frame to those in the body: its
// rows are the body's axes in the frame. Of a matrix that is nearly one the nearest rotation counts.
Quat from_dcm(const Mat3d& body_from_frame);

// Euler angles [rad]: the frame's axes are turned about their own axis `sequence[0]` (1 x, 2 y, 3 z), then,
// as they stand by then, about sequence[1] and about sequence[2], and are the body's. 3-2-1 is yaw, pitch,
// roll. Schaub & Junkins 2018, section 3.3.
Quat from_euler(std::array<int, 3> sequence, Vec3d angles_rad);
// The twelve sequences, "121" to "323".
inline constexpr std::array<const char*, 12> kEulerSequences = {"121", "123", "131", "132", "212", "213",
                                                                "231", "232", "312", "313", "321", "323"};
std::array<int, 3> euler_axes(std::size_t index);

// The direction that camera axes (x right, y down, z ahead) look in, in ICRF [rad]: right ascension,
// declination, and roll, the position angle of the image's up direction: from north (ICRF's +z) through east.
// At roll 0 the image has north up and east left.
struct RaDecRoll {
    double right_ascension_rad = 0, declination_rad = 0, roll_rad = 0;
};
Quat from_radec(const RaDecRoll& pointing);
// Right ascension and roll lie in [0, 2 pi). At a pole right ascension is 0 and roll takes the rest.
RaDecRoll radec_of(Quat icrf_from_camera);

}  // namespace hilcam
