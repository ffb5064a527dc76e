#pragma once
// The trajectories, each in a trajectory_*.cpp.

#include "emulator/motion/kepler_orbit.h"
#include "emulator/motion/keyframes.h"
#include "emulator/motion/placed_frame.h"
#include "io/files/element_set.h"
#include "io/files/oem_file.h"
#include "io/spice/spice_kernels.h"

namespace hilcam {

// Makes a thing that is at rest in a frame, or moves at a constant velocity in it from `start` on.
std::unique_ptr<Trajectory> make_fixed(const PlacedFrame& frame, const StateVector& at_start, TimeTai start);
// Makes a motion through keyframes in a frame; it stands still before the first and after the last.
std::unique_ptr<Trajectory> make_keyframed(const PlacedFrame& frame, Keyframes keyframes);
// Makes a drift near a thing on a near-circular orbit (relative_motion.h), in its LVLH frame.
std::unique_ptr<Trajectory> make_drifting(const PlacedFrame& lvlh, const StateVector& at_start,
                                          double mean_motion_rad_s, TimeTai start);
// Makes a Kepler orbit about a centre.
std::unique_ptr<Trajectory> make_kepler(const OrbitCenter& center, const KeplerElements& elements,
                                        TimeTai epoch);
// Makes an SGP4 orbit about the Earth, valid for `valid_s` before and after epoch, or until the theory breaks
// down or the satellite decays. Throws InputError for elements that are not an orbit.
std::unique_ptr<Trajectory> make_tle(const ElementSet& tle, double valid_s);
// An object in the scenario's kernels, relative to a body's centre, or to the origin if the kernels have
// that.
struct SpicePlace {
    int object = 0;  // NAIF's codes
    int about = 0;
    // Centre in the world that `about` stands for; empty: the world's origin.
    std::optional<OrbitCenter> center;
};
// Throws InputError for an object that the kernels do not have.
std::unique_ptr<Trajectory> make_spice_place(std::shared_ptr<SpiceKernels> kernels, const SpicePlace& place,
                                             const std::string& name);
// Follows an orbit ephemeris. Throws InputError for a centre that the program does not have.
std::unique_ptr<Trajectory> make_oem(std::vector<OemSegment> segments, const std::string& name);

}  // namespace hilcam
