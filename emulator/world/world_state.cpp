#include "emulator/world/world_state.h"

#include <algorithm>

#include "render/sky/body_bounds.h"
#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

// Returns the pose of a part on a joint: object_from_part takes p to pivot + R (p - pivot).
Pose turned(const Pose& object, const Joint& joint, double angle_rad) {
    const Quat turn = from_rotation_vector(angle_rad * joint.axis);
    const Vec3d shift_m = joint.pivot_m - to_matrix(turn) * joint.pivot_m;
    return {object.position_world_m + to_matrix(object.world_from_body) * shift_m,
            object.world_from_body * turn};
}

// Returns the motion of something mounted on a body: v + w x r, and the body's rate in its own axes.
Motion mounted(const Motion& body, const Mount& mount) {
    const Mat3d world_from_body = to_matrix(body.pose.world_from_body);
    Motion out = body;
    out.pose.position_world_m = body.pose.position_world_m + world_from_body * mount.position_m;
    out.pose.world_from_body = body.pose.world_from_body * mount.thing_from_camera;
    out.velocity_world_m_s =
        body.velocity_world_m_s + world_from_body * cross(body.rate_body_rad_s, mount.position_m);
    out.rate_body_rad_s = to_matrix(conjugate(mount.thing_from_camera)) * body.rate_body_rad_s;
    return out;
}

}  // namespace

void WorldState::History::insert(const Motion& motion) {
    auto* const end = motions.data() + count;
    auto* at = std::lower_bound(motions.data(), end, motion,
                                [](const Motion& a, const Motion& b) { return a.time < b.time; });
    if (at != end && at->time == motion.time) {
        *at = motion;  // corrects a pose with the same time tag
        return;
    }
    if (count < kLength) {
        std::move_backward(at, end, end + 1);
        *at = motion;
        ++count;
    } else if (at != motions.data()) {
        std::move(motions.data() + 1, at, motions.data());  // drops the oldest
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

Motion WorldState::History::motion_at(TimeTai time) const {
    constexpr std::int64_t kHalf_ns = 500'000;
    const Pose before = at(time + -kHalf_ns), after = at(time + kHalf_ns);
    constexpr double kStep_s = 2 * kHalf_ns * kSecondsPerNs;
    const Quat turn = conjugate(before.world_from_body) * after.world_from_body;
    // For a small rotation, the rotation vector is twice the quaternion's vector part, up to the quaternion's
    // sign.
    const double twice = turn.w < 0 ? -2 : 2;
    return {time, at(time), (after.position_world_m - before.position_world_m) / kStep_s,
            (twice / kStep_s) * Vec3d{turn.x, turn.y, turn.z}};
}

WorldState::WorldState(std::span<const Motion> motions, const OriginConfig& origin,
                       std::span<const Joint> joints, const Mount& mount, MotionSources sources,
                       std::span<const LampMount> lamps)
    : joints_(joints.begin(), joints.end()),
      objects_(motions.size() - 1),
      origin_(origin),
      mount_(mount),
      sources_(std::move(sources)),
      lamps_(lamps),
      now_(motions.begin(), motions.end()),
      bodies_(bodies_at(motions.front().time, origin)),
      live_(motions.size()),
      standing_(motions.size()) {
    HILCAM_CHECK(mount.thing <= objects_);
    const auto add = [&](const Motion& motion) {
        auto thing = std::make_unique<Thing>();
        thing->written.insert(motion);
        thing->latest.write(thing->written);
        things_.push_back(std::move(thing));
    };
    for (const Motion& motion : motions) add(motion);
    for (const Joint& joint : joints)
        add({motions.front().time, {{joint.angle_rad, 0, 0}, {}}, {joint.rate_rad_s, 0, 0}, {}});
    HILCAM_CHECK(!things_.empty());
    for (const LampMount& lamp : lamps) HILCAM_CHECK(lamp.thing <= placed_objects());
    sources_.evaluate({motions.front().time, origin_}, live_, now_, standing_);
}

std::optional<std::size_t> WorldState::thing_of(std::size_t object) const {
    if (object > objects_) return {};
    return object;
}

std::optional<std::size_t> WorldState::thing_of(std::size_t object, std::size_t joint) const {
    std::size_t number = 0;
    for (std::size_t i = 0; i < joints_.size(); ++i)
        if (joints_[i].object + 1 == object && ++number == joint) return 1 + objects_ + i;
    return {};
}

std::optional<std::size_t> WorldState::thing_of_lamp(std::size_t lamp) const {
    if (lamp < 1 || lamp > lamps_.size()) return {};
    return things_.size() + lamp - 1;
}

bool WorldState::set(std::size_t object, const Motion& motion, ShownCommand command, bool alone) {
    const auto thing = thing_of(object);
    return thing && write(*things_[*thing], motion, command, alone);
}

bool WorldState::set_joint(std::size_t object, std::size_t joint, const JointMotion& m, ShownCommand command,
                           bool alone) {
    const auto thing = thing_of(object, joint);
    return thing && write(*things_[*thing], {m.time, {{m.angle_rad, 0, 0}, {}}, {m.rate_rad_s, 0, 0}, {}},
                          command, alone);
}

bool WorldState::set_lamp(std::size_t lamp, const LampSwitch& order, ShownCommand command, bool alone) {
    if (!thing_of_lamp(lamp)) return false;
    const std::lock_guard lock(writers_);
    lamps_.set(lamp - 1, order, command, alone);
    return true;
}

bool WorldState::write(Thing& thing, const Motion& motion, ShownCommand command, bool alone) {
    const std::lock_guard lock(writers_);
    History& history = thing.written;
    // The pose from the scenario file is valid only until the first command.
    if (alone || history.command.arrival_monotonic_ns == 0) history.count = 0;
    history.insert(motion);
    history.command = command;
    history.command.time = motion.time;
    thing.latest.write(history);
    return true;
}

void WorldState::sample(TimeTai time, WorldSnapshot& world, ShownCommand& shown) {
    shown = {};
    for (const auto& thing : things_) {
        thing->sampled = &thing->latest.read();
        if (thing->sampled->command.arrival_monotonic_ns > shown.arrival_monotonic_ns)
            shown = thing->sampled->command;
    }
    lamps_.read(shown);
    sample_again(time, true, world);
}

void WorldState::shown_numbers(std::span<std::uint64_t> numbers) const {
    for (std::size_t i = 0; i < things_.size(); ++i) numbers[i] = things_[i]->sampled->command.number;
    lamps_.shown_numbers(numbers.subspan(things_.size()));
}

// Evaluates the motions of things with sources, after those that are commanded or at rest, because sources
// may follow them.
void WorldState::evaluate_sources(TimeTai time) const {
    if (sources_.empty()) return;
    for (std::size_t i = 0; i <= objects_; ++i) {
        live_[i] = things_[i]->sampled->command.arrival_monotonic_ns != 0;
        if (!follows_source(i)) commanded(i, time);
    }
    const MotionSources::Held held = sources_.evaluate({time, origin_}, live_, now_, standing_);
    count_impossible(held.first_impossible, time, held.impossible);
    if (held.unknown == 0) return;
    if (held_.load(std::memory_order_relaxed) == 0) first_held_.store(time, std::memory_order_relaxed);
    held_.fetch_add(held.unknown, std::memory_order_release);
}

// The loop is the only writer.
void WorldState::count_impossible(std::size_t thing, TimeTai time, std::uint64_t times) const {
    if (times == 0) return;
    if (impossible_.load(std::memory_order_relaxed) == 0) {
        first_impossible_.store(time, std::memory_order_relaxed);
        first_impossible_thing_.store(thing, std::memory_order_relaxed);
    }
    impossible_.fetch_add(times, std::memory_order_release);
}

std::string WorldState::first_impossible() const {
    if (impossible() == 0) return {};
    const std::size_t thing = first_impossible_thing_.load(std::memory_order_relaxed);
    std::string what = "a body of the sky";
    if (thing == 0)
        what = "the camera's body";
    else if (thing < things_.size())
        what = thing <= objects_ ? "object " + std::to_string(thing) : "a joint";
    return what + " at " + format_utc(first_impossible_.load(std::memory_order_relaxed));
}

void WorldState::take_bodies(TimeTai time) const {
    if (!take_possible(bodies_at(time, origin_), bodies_)) count_impossible(things_.size(), time);
}

// Returns the motion of a commanded thing, or the scenario's pose.
const Motion& WorldState::commanded(std::size_t thing, TimeTai time) const {
    if (!take_possible(things_[thing]->sampled->motion_at(time), now_[thing])) count_impossible(thing, time);
    return now_[thing];
}

const Pose& WorldState::commanded_pose(std::size_t thing, TimeTai time) const {
    const Motion found{time, things_[thing]->sampled->at(time), {}, {}};
    if (!take_possible(found, now_[thing])) count_impossible(thing, time);
    return now_[thing].pose;
}

void WorldState::sample_again(TimeTai time, bool with_bodies, WorldSnapshot& world) const {
    world.time = time;
    if (with_bodies) take_bodies(time), world.bodies = bodies_;
    evaluate_sources(time);
    // evaluate_sources() has computed what sources may follow.
    const auto motion = [&](std::size_t thing) -> const Motion& {
        return sources_.empty() ? commanded(thing, time) : now_[thing];
    };
    const Motion camera = mounted(motion(mount_.thing), mount_);
    world.camera = camera.pose;
    world.camera_velocity_m_s = world.rows_velocity_m_s = camera.velocity_world_m_s;
    world.camera_rate_rad_s = camera.rate_body_rad_s;
    for (std::size_t i = 0; i < objects_; ++i)
        world.objects[i] = sources_.empty() ? commanded_pose(1 + i, time) : now_[1 + i].pose;
    for (std::size_t i = 0; i < joints_.size(); ++i) {
        const Joint& joint = joints_[i];
        const double angle_rad = things_[1 + objects_ + i]->sampled->at(time).position_world_m.x;
        const Pose part = turned(world.objects[joint.object], joint, angle_rad);
        const bool can_be = is_possible(part);
        world.objects[objects_ + i] = can_be ? part : world.objects[joint.object];
        count_impossible(1 + objects_ + i, time, can_be ? 0 : 1);
    }
    lamps_.place(time, lamps_.size() > 0 ? motion(0).pose : Pose{}, world);
}

// Compares distances to the objects' origins, without the object that carries the camera.
Vec3d WorldState::nearest_velocity_m_s(const WorldSnapshot& world) const {
    std::size_t nearest = objects_;
    double min_m = 0;
    for (std::size_t i = 0; i < objects_; ++i) {
        if (1 + i == mount_.thing) continue;
        const double away_m = length(world.objects[i].position_world_m - world.camera.position_world_m);
        if (nearest == objects_ || away_m < min_m) nearest = i, min_m = away_m;
    }
    if (nearest == objects_) return {};
    const std::size_t thing = 1 + nearest;
    if (follows_source(thing)) return now_[thing].velocity_world_m_s;
    Motion kept = now_[thing];
    take_possible(things_[thing]->sampled->motion_at(world.time), kept);
    return kept.velocity_world_m_s;
}

}  // namespace hilcam
