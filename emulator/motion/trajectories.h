#pragma once
// The trajectories that there are; each in a trajectory_*.cpp.

#include "emulator/motion/kepler_orbit.h"
#include "emulator/motion/keyframes.h"
#include "emulator/motion/placed_frame.h"
#include "io/files/element_set.h"
#include "io/files/oem_file.h"
#include "io/spice/spice_kernels.h"

namespace hilcam {

// Makes a thing at rest in a frame, or at a constant velocity in it from `start` on.
std::unique_ptr<Trajectory> make_fixed(const PlacedFrame& frame, const StateVector& at_start, TimeTai start);
// Makes a motion from keyframe to keyframe in a frame; before the first and after the last it stands.
std::unique_ptr<Trajectory> make_keyframed(const PlacedFrame& frame, Keyframes keyframes);
// Drift near a thing that is on a near-circular orbit (relative_motion.h), in its LVLH frame.
std::unique_ptr<Trajectory> make_drifting(const PlacedFrame& lvlh, const StateVector& at_start,
                                          double mean_motion_rad_s, TimeTai start);
// Kepler's orbit about a centre.
std::unique_ptr<Trajectory> make_kepler(const OrbitCenter& center, const KeplerElements& elements,
                                        TimeTai epoch);
// SGP4 about the Earth, for `valid_s` before and after epoch, or until the theory breaks down or the
// satellite decays. Throws InputError for elements that are no orbit.
std::unique_ptr<Trajectory> make_tle(const ElementSet& tle, double valid_s);
// A thing of the scenario's kernels about a body's centre, or about the origin where that is a thing of the kernels.
struct SpicePlace {
    int object = 0;  // NAIF's codes
    int about = 0;
    std::optional<OrbitCenter> center;  // where `about` stands in the world; none: at its origin
};
// Throws InputError for a thing that the kernels do not have.
std::unique_ptr<Trajectory> make_spice_place(std::shared_ptr<SpiceKernels> kernels, const SpicePlace& place,
                                             const std::string& name);
// An ephemeris. Throws InputError for a centre that is none of the program's.
std::unique_ptr<Trajectory> make_oem(std::vector<OemSegment> segments, const std::string& name);

}  // namespace hilcam
