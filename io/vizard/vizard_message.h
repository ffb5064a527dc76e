#pragma once
// The message of a simulator to Vizard at each step (protobuf, io/vizard/vizard.proto), decoded, checked and
// in our terms: SI, quaternions as in render/vocabulary/pose.h. Positions and velocities stay in the
// simulator's inertial frame N: ICRF axes ("J2000"), origin as its ephemerides have it.

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "render/vocabulary/pose.h"

namespace hilcam {

// A spacecraft, or a celestial body.
struct VizardThing {
    std::string name;
    Vec3d position_n_m, velocity_n_m_s;
    std::optional<Quat> n_from_body;  // none: not told
};

struct VizardCamera {
    std::int64_t id = 0;
    std::string parent;  // the spacecraft that it sits on; empty: the first
    Vec3d position_body_m;
    Quat body_from_camera;
    double field_of_view_rad = 0;  // edge to edge along the picture's columns; 0: not told
    std::int64_t width_px = 0, height_px = 0;
    bool wants_depth = false;  // a map of distances instead of a picture
};

struct VizardUpdate {
    std::int64_t frame_number = 0;
    std::int64_t elapsed_ns = 0;   // since the simulation's start
    std::optional<TimeTai> epoch;  // epoch of that start; only a run's first message has it
    std::vector<VizardThing> spacecraft, bodies;
    std::vector<VizardCamera> cameras;
    bool is_last = false;  // Vizard would end now
};

struct DecodedVizardUpdate {
    VizardUpdate update;
    std::string refusal;  // empty: all is well; else one line: what, found, accepted
};

// Any bytes; up to 8 MiB, 10 000 spacecraft, 10 000 bodies and 255 cameras are read. Any thread.
DecodedVizardUpdate decode_vizard_update(std::span<const std::uint8_t> bytes);
// The user's input since the last message, of which there is none.
std::string encode_vizard_input(std::int64_t frame_number);

}  // namespace hilcam
