#pragma once
// A camera's motion along x, and where a world has it.

#include <cstdint>

#include "emulator/world/world_state.h"

namespace hilcam {

inline Motion motion_at(std::int64_t ns, double x, double velocity = 0) {
    Motion m;
    m.time = {ns};
    m.pose.position_world_m = {x, 0, 0};
    m.velocity_world_m_s = {velocity, 0, 0};
    return m;
}

inline double camera_x_m(WorldState& world, std::int64_t ns) {
    WorldSnapshot snapshot;
    ShownCommand shown;
    world.sample({ns}, snapshot, shown);
    return snapshot.camera.position_world_m.x;
}

}  // namespace hilcam
