#pragma once
// The newest known motions of camera and objects, and the world at the instant of a frame.
//
// Poses come with time tags, in any order. For a frame at time t: between two known motions it interpolates
// (cubic in position, slerp in attitude), else it propagates the motion before t with its velocity and rate,
// or, when all known ones lie after t, the first of them backwards. The last 8 motions of each thing are
// kept. A thing with a source of motion (motion_source.h) is where that says until its first command. Lamps
// (world_lamps.h) ride on things.
//
// This is the door into frames: what is no number or out of the bounds of motion (motion_bounds.h), from whatever source, does not get
// in. The thing stays as it was when it was last asked for, and that is counted.

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

// A part of an object that turns about an axis (object's axes, unit).
struct Joint {
    std::size_t object = 0;  // 0: the first object
    Vec3d pivot_m;
    Vec3d axis{0, 0, 1};
    double angle_rad = 0;
    double rate_rad_s = 0;
};

// The mount of a camera: fixed to the body that object 0's poses move, or to an object.
struct Mount {
    std::size_t thing = 0;  // 0: the spacecraft with the cameras; 1, 2, ...: an object
    Vec3d position_m;       // in the thing's axes
    Quat thing_from_camera;
};

class WorldState {
  public:
    // motions[0] is the camera's body, then the objects. Owner thread.
    WorldState(std::span<const Motion> motions, const OriginConfig& origin,
               std::span<const Joint> joints = {}, const Mount& mount = {}, MotionSources sources = {},
               std::span<const LampMount> lamps = {});

    // Any thread but the loop. False when there is no such thing. `alone`: what was known of it is forgotten.
    bool set(std::size_t object, const Motion& motion, ShownCommand command, bool alone = false);
    // The angle of an object's joint at an instant, and how fast it turns from then on. object, joint:
    // from 1. False when there is no such joint.
    struct JointMotion {
        TimeTai time;
        double angle_rad = 0;
        double rate_rad_s = 0;
    };
    bool set_joint(std::size_t object, std::size_t joint, const JointMotion& motion, ShownCommand command,
                   bool alone = false);
    // A lamp, from 1, from an instant on. False when there is no such lamp.
    bool set_lamp(std::size_t lamp, const LampSwitch& order, ShownCommand command, bool alone = false);
    // The thing that a command is about, counted as shown_numbers() does; none when there is no such one.
    std::optional<std::size_t> thing_of(std::size_t object) const;
    std::optional<std::size_t> thing_of(std::size_t object, std::size_t joint) const;
    std::optional<std::size_t> thing_of_lamp(std::size_t lamp) const;
    // The camera's body, objects, joints and lamps.
    std::size_t things() const { return things_.size() + lamps_.size(); }
    // Objects and joints: what `world.objects` must have room for.
    std::size_t placed_objects() const { return things_.size() - 1; }
    // Loop, one thread. `world.objects` must have room for placed_objects(): the objects, then the joints'
    // parts. No allocation, no lock.
    void sample(TimeTai time, WorldSnapshot& world, ShownCommand& shown);
    // Another instant, told from what the last sample() knew: commands that came since do not count. Without
    // bodies they stay as they are in `world`.
    void sample_again(TimeTai time, bool with_bodies, WorldSnapshot& world) const;
    // Lamps as bright as on average from then until then; of what the last sample() knew. Loop.
    void average_lamps(TimeTai from, TimeTai until, WorldSnapshot& world) const {
        lamps_.average(from, until, world);
    }
    // Returns how the object that is nearest to the camera moves in the world; none: not at all. world: as it
    // was sampled last. Loop.
    Vec3d nearest_velocity_m_s(const WorldSnapshot& world) const;
    // Returns, for each of things(), the number of the newest command that the last sample() knew. Loop.
    void shown_numbers(std::span<std::uint64_t> numbers) const;
    // Returns how often a source was asked for an instant that it does not know, and stood still. Any thread.
    std::uint64_t held() const { return held_.load(std::memory_order_acquire); }
    // Returns how often something in the world could not be, and stayed as it was. Any thread.
    std::uint64_t impossible() const { return impossible_.load(std::memory_order_acquire); }
    // Says what that was at first, and when; empty: there was nothing. Any thread but the loop's.
    std::string first_impossible() const;
    // Says which source did not know the first such instant, and why; empty: there was none. Any thread but the loop's.
    std::string first_gap() const {
        return held() == 0 ? std::string() : sources_.gap_at(first_held_.load());
    }

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
        const History* sampled = nullptr;  // the loop's
    };
    std::mutex writers_;
    std::vector<std::unique_ptr<Thing>> things_;
    std::vector<Joint> joints_;  // their angles are the last of things_, as the x of a position
    std::size_t objects_;
    OriginConfig origin_;
    Mount mount_;
    MotionSources sources_;
    WorldLamps lamps_;
    // The loop's: where all things are at the instant that is being sampled, or were when they could be last; which are commanded,
    // and which stand because their source does not know the instant; the bodies likewise.
    mutable std::vector<Motion> now_;
    mutable Bodies bodies_;
    mutable std::vector<std::uint8_t> live_, standing_;
    mutable std::atomic<std::uint64_t> held_{0};
    mutable std::atomic<TimeTai> first_held_{};
    mutable std::atomic<std::uint64_t> impossible_{0};
    mutable std::atomic<TimeTai> first_impossible_{};
    mutable std::atomic<std::size_t> first_impossible_thing_{0};  // after the things: the bodies

    void evaluate_sources(TimeTai time) const;
    void count_impossible(std::size_t thing, TimeTai time, std::uint64_t times = 1) const;
    void take_bodies(TimeTai time) const;
    const Motion& commanded(std::size_t thing, TimeTai time) const;
    const Pose& commanded_pose(std::size_t thing, TimeTai time) const;
    bool follows_source(std::size_t thing) const { return sources_.has(thing) && !live_[thing]; }
    bool write(Thing& thing, const Motion& motion, ShownCommand command, bool alone = false);
};

}  // namespace hilcam
