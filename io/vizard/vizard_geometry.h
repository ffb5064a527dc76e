#pragma once
// Converts the rotations of Basilisk's messages to ours.
//
// Basilisk writes attitudes as Modified Rodrigues Parameters sigma_YX of the passive matrix [YX], which takes
// a vector's components in frame X to those in frame Y. Ours are quaternions that take a vector's components
// in the body to those in the world; the same parameters then give the transposed matrix.
//
// A camera's rotation comes as sigma_UB, from the body B to a frame U of Vizard's graphics: its -x axis is
// the boresight, y points right along a picture's rows, and z points up along its columns. Basilisk computes
// it from the script's sigma_CB (C: x right, y down, z along the boresight, as ours) as [UB] = [UC] [CB] with
// sigma_UC = (1/3, 1/3, -1/3).

#include "render/vocabulary/attitude.h"

namespace hilcam {

// Returns our rotation for a message's camera rotation.
Quat body_from_camera(Vec3d sigma_ub);
// Returns the angle of the rotation from one attitude to the other, 0..pi; accurate for small angles.
double turn_between_rad(const Mat3d& a, const Mat3d& b);

}  // namespace hilcam
