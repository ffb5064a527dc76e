#pragma once
// The lamps of the world state: the things that carry them, and their switches.

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "emulator/world/lamp_switches.h"
#include "emulator/world/shown_command.h"
#include "render/scene/scene.h"
#include "render/vocabulary/latest.h"

namespace hilcam {

// The mount of a lamp on a thing, in that thing's axes.
struct LampMount {
    // 0: the body with the cameras; 1, 2, ...: index in WorldSnapshot::objects, from 1
    std::size_t thing = 0;
    Vec3d position_m;
    Vec3d axis{0, 0, 1};  // unit
    double level = 1;     // at the begin of the run
};

class WorldLamps {
  public:
    // Owner thread.
    explicit WorldLamps(std::span<const LampMount> mounts);

    std::size_t size() const { return lamps_.size(); }
    // Sets a lamp. alone: earlier switches are forgotten. One thread at a time, not the loop.
    void set(std::size_t lamp, const LampSwitch& order, const ShownCommand& command, bool alone);

    // --- for the loop; no allocation, no lock

    // Takes over the newest switches. shown: replaced by the newest command if that is newer.
    void read(ShownCommand& shown);
    // Places the lamps at an instant for which the objects have been placed, and sets their brightness.
    void place(TimeTai time, const Pose& camera_body, WorldSnapshot& world) const;
    // Sets their mean brightness over a span of time.
    void average(TimeTai from, TimeTai until, WorldSnapshot& world) const;
    // Returns, for each lamp, the number of the newest command at the last read().
    void shown_numbers(std::span<std::uint64_t> numbers) const;

  private:
    struct State {
        LampSwitches switches;
        ShownCommand command;
    };
    struct Lamp {
        LampMount mount;
        State written;  // written by the senders' threads
        Latest<State> latest;
        const State* sampled = nullptr;  // read by the loop
    };
    std::vector<std::unique_ptr<Lamp>> lamps_;
};

}  // namespace hilcam
