#pragma once
// The rotations of Basilisk's messages as ours.
//
// Basilisk writes attitudes as Modified Rodrigues Parameters sigma_YX, which stand for the passive matrix
// [YX]: it takes a vector's components in frame X to those in frame Y. Ours are quaternions that turn a
// vector's components in the body to those in the world; of the same parameters they are the transposed
// matrix.
//
// A camera's rotation comes as sigma_UB, from the body B to a frame U of Vizard's graphics, whose -x axis is
// the boresight, y lies along a picture's rows to the right and z along its columns upwards. Basilisk makes
// it of the script's own sigma_CB (C: x right, y down, z along the boresight, as ours) as [UB] = [UC] [CB]
// with sigma_UC = (1/3, 1/3, -1/3).

#include "render/vocabulary/attitude.h"

namespace hilcam {

// Ours of a message's camera rotation.
Quat body_from_camera(Vec3d sigma_ub);
// The angle between two vectors, 0..pi; accurate for small ones too. 0 when one of them is zero.
// The angle that takes one attitude to the other, 0..pi.
double turn_between_rad(const Mat3d& a, const Mat3d& b);

}  // namespace hilcam
