#pragma once
// Converts the forms in which people write attitudes to and from the program's own, the unit quaternion that
// turns body axes into a frame's axes (vec.h). docs/conventions.md writes one attitude in all of these forms.

#include <array>

#include "render/vocabulary/vec.h"

namespace hilcam {

// Returns the quaternion of modified Rodrigues parameters, Basilisk's sigma_BN: e tan(angle/4), where a turn
// by `angle` about e takes the frame's axes to the body's. Any length is accepted; a length above 1 is a turn
// by more than 180 degrees. Schaub & Junkins, Analytical Mechanics of Space Systems, 2018, section 3.7.
Quat from_mrp(Vec3d sigma);
// Returns the set for the shorter turn, with a length of at most 1.
Vec3d mrp_of(Quat frame_from_body);

// Returns how far a matrix is from being a rotation: the largest entry of |M M^T - 1|, or 2 when it mirrors.
double rotation_error(const Mat3d& m);
// A matrix within this error counts as a rotation that was written with few digits.
inline constexpr double kDcmTolerance = 1e-4;
// Returns the quaternion of a direction cosine matrix [BN], which takes a vector's components in the frame to
// those in the body: its rows are the body's axes in the frame. A matrix that is nearly a rotation is
// replaced by the nearest one.
Quat from_dcm(const Mat3d& body_from_frame);

// Returns the quaternion of Euler angles [rad]. The frame's axes are turned about their axis `sequence[0]` (1
// x, 2 y, 3 z), the turned axes about sequence[1], and those about sequence[2]; the result is the body's
// axes. 3-2-1 is yaw, pitch, roll. Schaub & Junkins 2018, section 3.3.
Quat from_euler(std::array<int, 3> sequence, Vec3d angles_rad);
// The twelve sequences, "121" to "323".
inline constexpr std::array<const char*, 12> kEulerSequences = {"121", "123", "131", "132", "212", "213",
                                                                "231", "232", "312", "313", "321", "323"};
std::array<int, 3> euler_axes(std::size_t index);

// The pointing of a camera with axes x right, y down, z ahead, in ICRF [rad]: right ascension and declination
// of the boresight, and roll, the position angle of the image's up direction, from north (ICRF's +z) through
// east. At roll 0 north is up in the image and east is left.
struct RaDecRoll {
    double right_ascension_rad = 0, declination_rad = 0, roll_rad = 0;
};
Quat from_radec(const RaDecRoll& pointing);
// Right ascension and roll are in [0, 2 pi). At a pole right ascension is 0 and roll has the whole angle.
RaDecRoll radec_of(Quat icrf_from_camera);

}  // namespace hilcam
