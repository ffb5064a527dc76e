#pragma once
// The newest known motions of camera and objects, and the world at the instant of a frame.
//
// Poses come with time tags, in any order. For a frame at time t: between two known motions it interpolates
// (cubic in position, slerp in attitude), else it propagates the motion before t with its velocity and rate,
// or, when all known ones lie after t, the first of them backwards. The last 8 motions of each thing are
// kept.

#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "render/bodies.h"
#include "render/latest.h"
#include "render/scene.h"

namespace hilcam {

// Which command a frame shows at the newest.
struct ShownCommand {
    std::uint32_t sequence = 0;
    std::int64_t arrival_monotonic_ns = 0;  // 0: none yet
};

class WorldState {
  public:
    // motions[0] is the camera, then the objects. Owner thread.
    WorldState(std::span<const Motion> motions, const OriginConfig& origin);

    std::size_t things() const { return things_.size(); }
    // Any thread but the loop. False when there is no such thing.
    bool set(std::size_t thing, const Motion& motion, ShownCommand command);
    // Loop, one thread. `world.objects` must have room for all objects. No allocation, no lock.
    void sample(TimeTai time, WorldSnapshot& world, ShownCommand& shown);

  private:
    struct History {
        static constexpr std::size_t kLength = 8;
        std::array<Motion, kLength> motions;  // by time, oldest first
        std::size_t count = 0;
        ShownCommand command;

        void insert(const Motion& motion);
        Pose at(TimeTai time) const;
        // Velocity and body rate with it: differences over a millisecond, as poses alone may be what is sent.
        Motion motion_at(TimeTai time) const;
    };
    struct Thing {
        History written;  // the writers' copy
        Latest<History> latest;
    };
    std::mutex writers_;
    std::vector<std::unique_ptr<Thing>> things_;
    OriginConfig origin_;
};

}  // namespace hilcam
