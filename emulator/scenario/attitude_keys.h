#pragma once
// An attitude in any of the forms that a scenario takes, wherever it takes a quaternion.

#include <string>
#include <vector>

#include "render/vocabulary/attitude.h"
#include "render/vocabulary/config_field.h"

namespace hilcam {

// The forms in which an attitude is given, at most one; none: the frame's own axes.
struct AttitudeForms {
    Quat wxyz;
    Vec3d mrp;
    std::vector<double> dcm;  // row by row
    Vec3d euler_rad;
    std::size_t euler_sequence = 0;  // in kEulerSequences
    Vec3d radec_rad;                 // right ascension, declination, roll
    bool has_wxyz = false, has_mrp = false, has_dcm = false, has_euler = false, has_sequence = false,
         has_radec = false;

    bool given() const { return has_wxyz || has_mrp || has_dcm || has_euler || has_radec; }
};

// The words for the forms in a section: `body` axes are turned into those of `frame`.
struct AttitudeWords {
    const char* body = "body";
    const char* frame = "the world";
    const char* quaternion_key = "attitude_wxyz";
    bool radec = true;  // false: the section's frame is not ICRF, so there is no such key
};

// The keys of the forms.
Fields attitude_keys(AttitudeForms& forms, const AttitudeWords& words);
// The key that is given, or the quaternion's.
const char* given_key(const AttitudeForms& forms, const AttitudeWords& words = {});
// Throws KeyError when two forms are given, one is incomplete, or a matrix is off a rotation by more than
// kDcmTolerance.
void check_attitude(const AttitudeForms& forms, const AttitudeWords& words = {});
// Body axes into the frame's. The forms have passed check_attitude().
Quat frame_from_body(const AttitudeForms& forms);

}  // namespace hilcam
