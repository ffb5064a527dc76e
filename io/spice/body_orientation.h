#pragma once
// The orientation of a body from a planetary constants kernel (NAIF, "PCK Required Reading"). A text kernel
// has the pole, prime meridian and periodic terms of the IAU's working group, a binary one Chebyshev
// polynomials of Euler angles.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "io/naif/daf_file.h"
#include "io/spice/kernel_pool.h"
#include "render/vocabulary/vec.h"

namespace hilcam {

// The rotation of a frame's axes into those of a reference frame, and their rate against it, in the
// reference's axes.
struct FrameTurn {
    Mat3d reference_from_frame;
    Vec3d rate_rad_s;
};
// Returns the rotation of `inner`, which is relative to the axes of `outer`, relative to the reference of
// `outer`. Loop.
FrameTurn composed(const FrameTurn& outer, const FrameTurn& inner);

// Returns the rate of rotating axes by a central difference, in the reference's axes [rad/s]. The matrices
// take vectors from the axes to the reference. span_s: time from `before` to `after`.
inline Vec3d rate_of(const Mat3d& now, const Mat3d& before, const Mat3d& after, double span_s) {
    const Mat3d axes = transposed(now), from = transposed(before), to = transposed(after);
    Vec3d rate_rad_s{0, 0, 0};
    for (const Vec3d Mat3d::*axis : {&Mat3d::x, &Mat3d::y, &Mat3d::z})
        rate_rad_s = rate_rad_s + 0.5 / span_s * cross(axes.*axis, to.*axis - from.*axis);
    return rate_rad_s;
}

class BodyOrientation {
  public:
    virtual ~BodyOrientation() = default;
    // NAIF's code of the reference frame.
    int frame = 1;
    double start_et_s = -1e30, stop_et_s = 1e30;
    bool covers(double et_s) const { return start_et_s <= et_s && et_s <= stop_et_s; }
    // Returns the rotation at a time. Loop.
    virtual FrameTurn at(double et_s) const = 0;
};

// Returns null when the pool has no pole of that body. Throws InputError when its variables are incomplete.
std::unique_ptr<BodyOrientation> text_orientation(const KernelPool& pool, int body);

// Loads a segment of type 2 or 3 of a binary kernel, and returns the frame class code of a segment.
std::unique_ptr<BodyOrientation> load_binary_orientation(const DafFile& file, const DafArray& array);
inline int orientation_class(const DafArray& array) { return array.integers[0]; }

}  // namespace hilcam
