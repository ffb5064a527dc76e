#pragma once
// The message that a simulator sends to Vizard at each step (protobuf, io/vizard/vizard.proto): decoded,
// checked and converted to SI and to quaternions as in render/vocabulary/pose.h. Positions and velocities
// stay in the simulator's inertial frame N: ICRF axes ("J2000"), with the origin of its ephemerides.

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "render/vocabulary/pose.h"

namespace hilcam {

// A spacecraft or a celestial body.
struct VizardThing {
    std::string name;
    Vec3d position_n_m, velocity_n_m_s;
    std::optional<Quat> n_from_body;  // none: not in the message
};

struct VizardCamera {
    std::int64_t id = 0;
    std::string parent;  // its spacecraft; empty: the first
    Vec3d position_body_m;
    Quat body_from_camera;
    double field_of_view_rad = 0;  // along the picture's columns, edge to edge; 0: not in the message
    std::int64_t width_px = 0, height_px = 0;
    bool wants_depth = false;  // a map of distances instead of a picture
};

struct VizardUpdate {
    std::int64_t frame_number = 0;
    std::int64_t elapsed_ns = 0;   // since the simulation's start
    std::optional<TimeTai> epoch;  // epoch of that start; only in a run's first message
    std::vector<VizardThing> spacecraft, bodies;
    std::vector<VizardCamera> cameras;
    bool is_last = false;  // Vizard would end after it
};

struct DecodedVizardUpdate {
    VizardUpdate update;
    std::string refusal;  // empty: no refusal; else one line: what, found, accepted
};

// Decodes any bytes; reads up to 8 MiB, 10 000 spacecraft, 10 000 bodies and 255 cameras. Any thread.
DecodedVizardUpdate decode_vizard_update(std::span<const std::uint8_t> bytes);
// Returns the message with the user's input since the last request, which is always empty.
std::string encode_vizard_input(std::int64_t frame_number);

}  // namespace hilcam
