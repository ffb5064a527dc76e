#pragma once
// The lamps of the world state: what carries them, and how they are switched.

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "emulator/world/lamp_switches.h"
#include "emulator/world/shown_command.h"
#include "render/scene/scene.h"
#include "render/vocabulary/latest.h"

namespace hilcam {

// The thing that a lamp is fixed to, in that thing's axes.
struct LampMount {
    std::size_t thing = 0;  // 0: the body with the cameras; 1, 2, ...: of WorldSnapshot::objects
    Vec3d position_m;
    Vec3d axis{0, 0, 1};  // unit
    double level = 1;     // when the run begins
};

class WorldLamps {
  public:
    // Owner thread.
    explicit WorldLamps(std::span<const LampMount> mounts);

    std::size_t size() const { return lamps_.size(); }
    // One thread at a time, not the loop. alone: what was known of it is forgotten.
    void set(std::size_t lamp, const LampSwitch& order, const ShownCommand& command, bool alone);

    // --- the loop's; no allocation, no lock

    // Takes the newest switches; `shown` becomes the newest command of all, if that is newer.
    void read(ShownCommand& shown);
    // Places them at an instant of which the objects are placed already, and finds how bright they are then.
    void place(TimeTai time, const Pose& camera_body, WorldSnapshot& world) const;
    // Finds how bright they are from then until then, on average.
    void average(TimeTai from, TimeTai until, WorldSnapshot& world) const;
    // Returns, for each, the number of the newest command that the last read() knew.
    void shown_numbers(std::span<std::uint64_t> numbers) const;

  private:
    struct State {
        LampSwitches switches;
        ShownCommand command;
    };
    struct Lamp {
        LampMount mount;
        State written;  // the writers' copy
        Latest<State> latest;
        const State* sampled = nullptr;  // the loop's
    };
    std::vector<std::unique_ptr<Lamp>> lamps_;
};

}  // namespace hilcam
