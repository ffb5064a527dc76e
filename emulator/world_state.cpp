#include "emulator/world_state.h"

#include <algorithm>

#include "render/check.h"

namespace hilcam {

void WorldState::History::insert(const Motion& motion) {
    auto* const end = motions.data() + count;
    auto* at = std::lower_bound(motions.data(), end, motion,
                                [](const Motion& a, const Motion& b) { return a.time < b.time; });
    if (at != end && at->time == motion.time) {
        *at = motion;  // a correction of the same instant
        return;
    }
    if (count < kLength) {
        std::move_backward(at, end, end + 1);
        *at = motion;
        ++count;
    } else if (at != motions.data()) {
        std::move(motions.data() + 1, at, motions.data());  // the oldest makes room
        *(at - 1) = motion;
    }
}

Pose WorldState::History::at(TimeTai time) const {
    const auto* const begin = motions.data();
    const auto* const end = begin + count;
    const auto* after =
        std::upper_bound(begin, end, time, [](TimeTai t, const Motion& m) { return t < m.time; });
    if (after == begin) return propagate(*begin, time);
    if (after == end) return propagate(*(end - 1), time);
    return interpolate(*(after - 1), *after, time);
}

WorldState::WorldState(std::span<const Motion> motions, const OriginConfig& origin) : origin_(origin) {
    for (const Motion& motion : motions) {
        auto thing = std::make_unique<Thing>();
        thing->written.insert(motion);
        thing->latest.write(thing->written);
        things_.push_back(std::move(thing));
    }
    HILCAM_CHECK(!things_.empty());
}

bool WorldState::set(std::size_t thing, const Motion& motion, ShownCommand command) {
    if (thing >= things_.size()) return false;
    const std::lock_guard lock(writers_);
    History& history = things_[thing]->written;
    // What the scenario file said holds only until the first command.
    if (history.command.arrival_monotonic_ns == 0) history.count = 0;
    history.insert(motion);
    history.command = command;
    things_[thing]->latest.write(history);
    return true;
}

void WorldState::sample(TimeTai time, WorldSnapshot& world, ShownCommand& shown) {
    world.time = time;
    world.bodies = bodies_at(time, origin_);
    shown = {};
    for (std::size_t i = 0; i < things_.size(); ++i) {
        const History& history = things_[i]->latest.read();
        (i == 0 ? world.camera : world.objects[i - 1]) = history.at(time);
        if (history.command.arrival_monotonic_ns > shown.arrival_monotonic_ns) shown = history.command;
    }
}

}  // namespace hilcam
