#pragma once
// The newest known motions of camera and objects, and the world at the instant of a frame.
//
// Poses have time tags and arrive in any order. For a frame at time t, a pose is interpolated between two
// known motions (cubic in position, slerp in attitude). Otherwise the motion before t is propagated with its
// velocity and rate, or, if all known motions are after t, the first of them is propagated backwards. The
// last 8 motions of each thing are kept. A thing with a motion source (motion_source.h) follows it until its
// first command. Lamps (world_lamps.h) move with things.
//
// All values on their way into a frame are checked here: what is not a number, or exceeds the bounds of
// motion (motion_bounds.h), is rejected, whatever its source. The thing keeps its previous state, and that is
// counted.

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "emulator/motion/motion_source.h"
#include "emulator/world/shown_command.h"
#include "emulator/world/world_lamps.h"
#include "render/scene/scene.h"
#include "render/sky/bodies.h"
#include "render/vocabulary/latest.h"

namespace hilcam {

// A part of an object that rotates about an axis (unit vector in the object's axes).
struct Joint {
    std::size_t object = 0;  // 0: the first object
    Vec3d pivot_m;
    Vec3d axis{0, 0, 1};
    double angle_rad = 0;
    double rate_rad_s = 0;
};

// The mount of a camera: fixed to the body that poses of object 0 move, or to an object.
struct Mount {
    std::size_t thing = 0;  // 0: the spacecraft with the cameras; 1, 2, ...: an object
    Vec3d position_m;       // in the thing's axes
    Quat thing_from_camera;
};

class WorldState {
  public:
    // motions[0] is the camera's body, followed by the objects. Owner thread.
    WorldState(std::span<const Motion> motions, const OriginConfig& origin,
               std::span<const Joint> joints = {}, const Mount& mount = {}, MotionSources sources = {},
               std::span<const LampMount> lamps = {});

    // False when the thing does not exist. alone: earlier motions are forgotten. Any thread except the
    // loop's.
    bool set(std::size_t object, const Motion& motion, ShownCommand command, bool alone = false);
    // The angle of an object's joint at an instant, and its rate from then on.
    struct JointMotion {
        TimeTai time;
        double angle_rad = 0;
        double rate_rad_s = 0;
    };
    bool set_joint(std::size_t object, std::size_t joint, const JointMotion& motion, ShownCommand command,
                   bool alone = false);
    // Switches a lamp from an instant on. lamp: from 1. False when the lamp does not exist.
    bool set_lamp(std::size_t lamp, const LampSwitch& order, ShownCommand command, bool alone = false);
    // Return the index of the thing that a command is about, as in shown_numbers(); empty when it does not
    // exist.
    std::optional<std::size_t> thing_of(std::size_t object) const;
    std::optional<std::size_t> thing_of(std::size_t object, std::size_t joint) const;
    std::optional<std::size_t> thing_of_lamp(std::size_t lamp) const;
    // Returns the number of things: the camera's body, objects, joints and lamps.
    std::size_t things() const { return things_.size() + lamps_.size(); }
    // Returns the number of objects and joints, for which `world.objects` must have room.
    std::size_t placed_objects() const { return things_.size() - 1; }
    // Evaluates the world at an instant: first the objects, then the joints' parts. `world.objects` must have
    // room for placed_objects(). Loop, one thread: no allocation, no lock.
    void sample(TimeTai time, WorldSnapshot& world, ShownCommand& shown);
    // Evaluates another instant from the commands that the last sample() used; later commands do not count.
    // with_bodies false: bodies stay as they are in `world`.
    void sample_again(TimeTai time, bool with_bodies, WorldSnapshot& world) const;
    // Sets lamps to their mean brightness over a span of time, from the commands that the last sample() used.
    // Loop.
    void average_lamps(TimeTai from, TimeTai until, WorldSnapshot& world) const {
        lamps_.average(from, until, world);
    }
    // Returns the velocity of the object nearest to the camera; zero without objects. world: as last sampled.
    // Loop.
    Vec3d nearest_velocity_m_s(const WorldSnapshot& world) const;
    // Returns, for each of things(), the number of the newest command that the last sample() used. Loop.
    void shown_numbers(std::span<std::uint64_t> numbers) const;
    // Returns how many times a source was asked for an instant that it does not cover, and stood still. Any
    // thread.
    std::uint64_t held() const { return held_.load(std::memory_order_acquire); }
    // Returns how many times something in the world had an impossible value, and kept its state. Any thread.
    std::uint64_t impossible() const { return impossible_.load(std::memory_order_acquire); }
    // Says what the first of these was, and when; empty: none. Any thread except the loop's.
    std::string first_impossible() const;
    // Says which source did not cover the first such instant, and why; empty: none. Any thread except the
    // loop's.
    std::string first_gap() const {
        return held() == 0 ? std::string() : sources_.gap_at(first_held_.load());
    }

  private:
    struct History {
        static constexpr std::size_t kLength = 8;
        std::array<Motion, kLength> motions;  // oldest first
        std::size_t count = 0;
        ShownCommand command;

        void insert(const Motion& motion);
        Pose at(TimeTai time) const;
        // Returns velocity and body rate as well, from differences over a millisecond, because senders may
        // give poses alone.
        Motion motion_at(TimeTai time) const;
    };
    struct Thing {
        History written;  // written by the senders' threads
        Latest<History> latest;
        const History* sampled = nullptr;  // read by the loop
    };
    std::mutex writers_;
    std::vector<std::unique_ptr<Thing>> things_;
    std::vector<Joint> joints_;  // angles are in the last things_, as x of a position
    std::size_t objects_;
    OriginConfig origin_;
    Mount mount_;
    MotionSources sources_;
    WorldLamps lamps_;
    // Used by the loop: motions of all things at the sampled instant, or their last possible ones; which
    // things are commanded, and which stand still because their source does not cover the instant; the same
    // for the bodies.
    mutable std::vector<Motion> now_;
    mutable Bodies bodies_;
    mutable std::vector<std::uint8_t> live_, standing_;
    mutable std::atomic<std::uint64_t> held_{0};
    mutable std::atomic<TimeTai> first_held_{};
    mutable std::atomic<std::uint64_t> impossible_{0};
    mutable std::atomic<TimeTai> first_impossible_{};
    // An index after those of the things stands for the bodies.
    mutable std::atomic<std::size_t> first_impossible_thing_{0};

    void evaluate_sources(TimeTai time) const;
    void count_impossible(std::size_t thing, TimeTai time, std::uint64_t times = 1) const;
    void take_bodies(TimeTai time) const;
    const Motion& commanded(std::size_t thing, TimeTai time) const;
    const Pose& commanded_pose(std::size_t thing, TimeTai time) const;
    bool follows_source(std::size_t thing) const { return sources_.has(thing) && !live_[thing]; }
    bool write(Thing& thing, const Motion& motion, ShownCommand command, bool alone = false);
};

}  // namespace hilcam
