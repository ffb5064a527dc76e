#include "emulator/world/world_lamps.h"

namespace hilcam {

WorldLamps::WorldLamps(std::span<const LampMount> mounts) {
    for (const LampMount& mount : mounts) {
        auto lamp = std::make_unique<Lamp>();
        lamp->mount = mount;
        lamp->written.switches = LampSwitches(mount.level);
        lamp->latest.write(lamp->written);
        lamp->sampled = &lamp->latest.read();
        lamps_.push_back(std::move(lamp));
    }
}

void WorldLamps::set(std::size_t index, const LampSwitch& order, const ShownCommand& command, bool alone) {
    Lamp& lamp = *lamps_[index];
    State& state = lamp.written;
    if (alone) state.switches.begin_anew();
    state.switches.insert(order);
    state.command = command;
    state.command.time = order.time;
    lamp.latest.write(state);
}

void WorldLamps::read(ShownCommand& shown) {
    for (const auto& lamp : lamps_) {
        lamp->sampled = &lamp->latest.read();
        if (lamp->sampled->command.arrival_monotonic_ns > shown.arrival_monotonic_ns)
            shown = lamp->sampled->command;
    }
}

void WorldLamps::place(TimeTai time, const Pose& camera_body, WorldSnapshot& world) const {
    world.lamps.resize(lamps_.size());
    for (std::size_t i = 0; i < lamps_.size(); ++i) {
        const LampMount& mount = lamps_[i]->mount;
        const Pose& thing = mount.thing == 0 ? camera_body : world.objects[mount.thing - 1];
        const Mat3d world_from_thing = to_matrix(thing.world_from_body);
        world.lamps[i] = {thing.position_world_m + world_from_thing * mount.position_m,
                          world_from_thing * mount.axis, lamps_[i]->sampled->switches.at(time)};
    }
}

void WorldLamps::average(TimeTai from, TimeTai until, WorldSnapshot& world) const {
    for (std::size_t i = 0; i < lamps_.size(); ++i)
        world.lamps[i].level = lamps_[i]->sampled->switches.mean(from, until);
}

void WorldLamps::shown_numbers(std::span<std::uint64_t> numbers) const {
    for (std::size_t i = 0; i < lamps_.size(); ++i) numbers[i] = lamps_[i]->sampled->command.number;
}

}  // namespace hilcam
