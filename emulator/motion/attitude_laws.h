#pragma once
// The attitude laws that there are; each in an attitude_*.cpp.

#include "emulator/motion/keyframes.h"
#include "emulator/motion/placed_frame.h"
#include "io/files/aem_file.h"
#include "io/spice/spice_kernels.h"

namespace hilcam {

// Held against a frame's axes, or turning at a constant body rate against them from `start` on: inertial,
// spin, LVLH, fixed to a body or another thing.
std::unique_ptr<AttitudeLaw> make_turning(const PlacedFrame& frame, const AttitudeState& at_start,
                                          TimeTai start);

// The target at which a body axis can be made to look.
struct Aim {
    enum class Kind {
        kNorth,        // the world's +z
        kDirection,    // a fixed direction in the world
        kNadir,        // the middle of `center`
        kSun,          // geometric
        kVelocity,     // about `center`
        kOrbitNormal,  // about `center`
        kThing
    } kind = Kind::kNorth;
    Vec3d direction{0, 0, 1};
    OrbitCenter center;
    std::size_t thing = 0;
};
struct Pointing {
    Vec3d axis{0, 0, 1};  // axis of the body that looks exactly along `aim`
    Aim aim;
    Vec3d second_axis{0, -1, 0};  // that looks as near to `second_aim` as it can
    Aim second_aim;
};
// Throws InputError when the two axes are parallel or zero. At an instant when the two aims are parallel the
// roll about the first is that for a second aim along ICRF's +x or +y.
std::unique_ptr<AttitudeLaw> make_pointing(const Pointing& pointing);

std::unique_ptr<AttitudeLaw> make_keyframed_attitude(const PlacedFrame& frame, Keyframes keyframes);
// The axes of a frame of the scenario's kernels, and how the body's axes stand in them. Throws InputError for a frame that
// the kernels do not have.
std::unique_ptr<AttitudeLaw> make_spice_attitude(std::shared_ptr<SpiceKernels> kernels,
                                                 const std::string& frame, Quat frame_from_body);
// An ephemeris of attitudes. LVLH and RTN are those of the thing's own orbit about `center`.
std::unique_ptr<AttitudeLaw> make_aem(std::vector<AemSegment> segments, const OrbitCenter& center,
                                      const std::string& name);

}  // namespace hilcam
