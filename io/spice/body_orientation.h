#pragma once
// The turn of a body, by a planetary constants kernel (NAIF, "PCK Required Reading"): in text the pole, prime meridian
// and periodic terms that the IAU's working group publishes, in binary form Chebyshev polynomials of Euler's angles.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "io/naif/daf_file.h"
#include "io/spice/kernel_pool.h"
#include "render/vocabulary/vec.h"

namespace hilcam {

// Axes that turn: from them into a reference frame's, and their rate against it, in the reference's axes.
struct FrameTurn {
    Mat3d reference_from_frame;
    Vec3d rate_rad_s;
};
// Returns the axes that stand in `outer` as `inner` says. Loop.
FrameTurn composed(const FrameTurn& outer, const FrameTurn& inner);

// Returns the rate at which axes turn, from where they are a little before and after.
// It is in the reference's axes [rad/s]; the matrices take vectors from the axes into the reference's; span_s:
// from the one before to the one after.
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
    // The reference frame's code, NAIF's.
    int frame = 1;
    double start_et_s = -1e30, stop_et_s = 1e30;
    bool covers(double et_s) const { return start_et_s <= et_s && et_s <= stop_et_s; }
    // Loop.
    virtual FrameTurn at(double et_s) const = 0;
};

// Null: the pool has no pole of that body. Throws InputError for one that is not whole.
std::unique_ptr<BodyOrientation> text_orientation(const KernelPool& pool, int body);

// A binary kernel's segment of type 2 or 3. `body` is NAIF's code of the class of frame.
std::unique_ptr<BodyOrientation> load_binary_orientation(const DafFile& file, const DafArray& array);
inline int orientation_class(const DafArray& array) { return array.integers[0]; }

}  // namespace hilcam
