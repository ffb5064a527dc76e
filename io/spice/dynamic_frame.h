#pragma once
// Dynamic frames of frames kernels, class 5 (NAIF, "Frames Required Reading", section "Dynamic Frame Classes"): axes by two
// vectors, by the Earth's equator or ecliptic of date, or by Euler's angles as polynomials of the time.
//
// Not read: vectors to the nearest point of a body, aberration of vectors, product frames.

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "io/spice/earth_of_date.h"
#include "io/spice/kernel_pool.h"

namespace hilcam {

// A vector that an axis of a frame is along, or towards.
struct FrameVector {
    enum class Kind { kPosition, kVelocity, kConstant } kind = Kind::kConstant;
    std::size_t axis = 0;          // 0 to 2: x, y, z
    double sign = 1;               // -1: the axis points away from it
    int observer = 0, target = 0;  // bodies; positions and velocities of the target about the observer
    int frame = 1;                 // the frame that velocities are measured in, and constants stand in
    Vec3d constant;
};

struct DynamicFrame {
    enum class Family { kTwoVector, kEarth, kEuler } family = Family::kEuler;
    std::optional<double> frozen_et_s;  // the instant whose turn against the base it has for ever
    bool inertial = false;              // turns with the time, but its rate is left out
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

// Returns the turn by Euler's angles from the frame into its base's axes, with its rate. Loop.
FrameTurn euler_turn(const DynamicFrame& frame, double et_s);
// Returns the axes by two vectors, in theirs; none where the vectors are too near to each other. Loop.
std::optional<Mat3d> two_vector_axes(const DynamicFrame& frame, Vec3d primary, Vec3d secondary);

}  // namespace hilcam
