#pragma once
// An attitude in any of the forms that a scenario accepts beside a quaternion.

#include <string>
#include <vector>

#include "render/vocabulary/attitude.h"
#include "render/vocabulary/config_field.h"

namespace hilcam {

// The form in which an attitude is given; at most one. Without any, the attitude is that of the frame's axes.
struct AttitudeForms {
    Quat wxyz;
    Vec3d mrp;
    std::vector<double> dcm;  // row by row
    Vec3d euler_rad;
    std::size_t euler_sequence = 0;  // index in kEulerSequences
    Vec3d radec_rad;                 // right ascension, declination, roll
    bool has_wxyz = false, has_mrp = false, has_dcm = false, has_euler = false, has_sequence = false,
         has_radec = false;

    bool given() const { return has_wxyz || has_mrp || has_dcm || has_euler || has_radec; }
};

// Words for describing the forms in a section: the attitude rotates `body` axes into those of `frame`.
struct AttitudeWords {
    const char* body = "body";
    const char* frame = "the world";
    const char* quaternion_key = "attitude_wxyz";
    bool radec = true;  // false: the section's frame is not ICRF, so the key does not exist
};

// Returns the keys of all forms.
Fields attitude_keys(AttitudeForms& forms, const AttitudeWords& words);
// Returns the key that is given; without any, the quaternion's.
const char* given_key(const AttitudeForms& forms, const AttitudeWords& words = {});
// Throws KeyError when two forms are given, when one is incomplete, or when a matrix deviates from a rotation
// by more than kDcmTolerance.
void check_attitude(const AttitudeForms& forms, const AttitudeWords& words = {});
// Returns the rotation from body axes to the frame's. The forms must have passed check_attitude().
Quat frame_from_body(const AttitudeForms& forms);

}  // namespace hilcam
