#pragma once
// The attitude laws, each in an attitude_*.cpp.

#include "emulator/motion/keyframes.h"
#include "emulator/motion/placed_frame.h"
#include "io/files/aem_file.h"
#include "io/spice/spice_kernels.h"

namespace hilcam {

// Makes an attitude that is constant relative to a frame's axes, or turns against them at a constant body
// rate from `start` on: inertial, spin, LVLH, fixed to a body or another thing.
std::unique_ptr<AttitudeLaw> make_turning(const PlacedFrame& frame, const AttitudeState& at_start,
                                          TimeTai start);

// A direction or target to which a body axis can point.
struct Aim {
    enum class Kind {
        kNorth,        // the world's +z
        kDirection,    // a fixed direction in the world
        kNadir,        // centre of `center`
        kSun,          // geometric direction, without light time or aberration
        kVelocity,     // relative to `center`
        kOrbitNormal,  // normal of the orbit about `center`
        kThing
    } kind = Kind::kNorth;
    Vec3d direction{0, 0, 1};
    OrbitCenter center;
    std::size_t thing = 0;
};
struct Pointing {
    Vec3d axis{0, 0, 1};  // body axis that points exactly along `aim`
    Aim aim;
    Vec3d second_axis{0, -1, 0};  // body axis that points as closely along `second_aim` as it can
    Aim second_aim;
};
// Throws InputError when the two axes are parallel or zero. While the two aims are parallel, ICRF's +x or +y
// replaces the second aim and fixes the roll.
std::unique_ptr<AttitudeLaw> make_pointing(const Pointing& pointing);

std::unique_ptr<AttitudeLaw> make_keyframed_attitude(const PlacedFrame& frame, Keyframes keyframes);
// Follows a frame of the scenario's kernels; frame_from_body is the body's constant attitude in it. Throws
// InputError for a frame that the kernels do not have.
std::unique_ptr<AttitudeLaw> make_spice_attitude(std::shared_ptr<SpiceKernels> kernels,
                                                 const std::string& frame, Quat frame_from_body);
// Follows an attitude ephemeris. Its LVLH and RTN axes are those of the thing's own orbit about `center`.
std::unique_ptr<AttitudeLaw> make_aem(std::vector<AemSegment> segments, const OrbitCenter& center,
                                      const std::string& name);

}  // namespace hilcam
