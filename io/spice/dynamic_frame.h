#pragma once
// Dynamic frames of frames kernels, class 5 (NAIF, "Frames Required Reading", section "Dynamic Frame
// Classes"): axes from two vectors, from the Earth's equator or ecliptic of date, or from Euler angles that
// are polynomials of time.
//
// Not supported: vectors to the nearest point of a body, aberration of vectors, product frames.

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "io/spice/earth_of_date.h"
#include "io/spice/kernel_pool.h"

namespace hilcam {

// A vector that an axis of a frame follows, exactly or as nearly as possible.
struct FrameVector {
    enum class Kind { kPosition, kVelocity, kConstant } kind = Kind::kConstant;
    std::size_t axis = 0;  // 0 to 2: x, y, z
    double sign = 1;       // -1: the axis points the opposite way
    // Bodies; positions and velocities are the target's relative to the observer.
    int observer = 0, target = 0;
    int frame = 1;  // frame in which velocities are measured and constants are given
    Vec3d constant;
};

struct DynamicFrame {
    enum class Family { kTwoVector, kEarth, kEuler } family = Family::kEuler;
    std::optional<double> frozen_et_s;  // time at which the rotation to the base is frozen
    bool inertial = false;              // rotates with time, but its rate is ignored
    // kTwoVector
    std::array<FrameVector, 2> vectors;
    double min_angle_rad = 1e-3;  // between the vectors; NAIF's value
    // kEarth
    EarthAxes earth = EarthAxes::kMeanEquator;
    // kEuler
    double epoch_et_s = 0;
    std::array<int, 3> axes{};                      // 1 to 3
    std::array<std::vector<double>, 3> angles_rad;  // coefficients by powers of seconds
};

// Reads the definition of a frame of class 5. frame_where: "file:line: frame 'NAME'". Throws InputError.
std::shared_ptr<const DynamicFrame> read_dynamic_frame(const KernelPool& pool, const std::string& code,
                                                       const std::string& name,
                                                       const std::string& frame_where);

// Returns the rotation from the frame into its base's axes by Euler angles, with its rate. Loop.
FrameTurn euler_turn(const DynamicFrame& frame, double et_s);
// Returns the axes from two vectors, in the vectors' axes; nothing when these are too close to parallel.
// Loop.
std::optional<Mat3d> two_vector_axes(const DynamicFrame& frame, Vec3d primary, Vec3d secondary);

}  // namespace hilcam
