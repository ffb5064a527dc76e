#pragma once
// A motion source says where a thing is and how it is turned at any instant, by what the scenario says of it:
// a trajectory, an attitude law and jitter, each a pure function of the instant and of the things that it
// follows.
//
// Outside the instants that a part knows (an ephemeris's end, a gap in it) it stands still as it was at the
// nearest one that it knows, and says so. Axes of its orbit stand with it. Where what a part gives is no number, or out of the
// bounds of motion (motion_bounds.h), its thing stays as it was when it was last asked for, and that is said, too.

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "emulator/motion/attitude_jitter.h"
#include "emulator/motion/world_frame.h"

namespace hilcam {

enum class MotionStatus : std::uint8_t {
    kOk,
    kBefore,
    kAfter,
    kGap,
    kImpossible  // it gives what cannot be (motion_bounds.h); no validity() has this
};

// Says whether a part knows an instant, and the nearest that it knows.
struct MotionValidity {
    MotionStatus status = MotionStatus::kOk;
    TimeTai nearest;
};
// A part gives this of an instant inside its span that it turns out not to know: no numbers, which no thing takes over.
inline constexpr StateVector kUnknownState{{std::numeric_limits<double>::quiet_NaN(), 0, 0}, {}};
// Returns the validity of a span whose ends count.
MotionValidity validity_of(TimeTai time, TimeTai first, TimeTai last);

// The part of the world at one instant that a part may look at.
struct MotionContext {
    const WorldFrame& frame;
    std::span<const Motion> things;  // the camera's body, then the objects; what needs() names is right
    // Flags of those that stand still where their source does not know the instant. The velocity of such a
    // thing is that of its way, so that its orbit has axes; it does not move with it. Empty: none.
    std::span<const std::uint8_t> standing = {};

    bool stands(std::size_t thing) const { return thing < standing.size() && standing[thing] != 0; }
};

// The thing whose attitude is asked for: its own state in the world, as above.
struct OwnMotion {
    OwnMotion(const StateVector& s, bool still = false, std::optional<Vec3d> change = {})
        : state(s), stands(still), acceleration_m_s2(change) {}

    StateVector state;
    bool stands;
    std::optional<Vec3d> acceleration_m_s2;  // none: it falls freely
};

// Another thing's part that must be known first.
struct MotionNeed {
    std::size_t thing = 0;
    bool attitude = false;  // true: its attitude, false: its position
};

class Trajectory {
  public:
    virtual ~Trajectory() = default;
    // Everywhere, unless it says otherwise. Loop.
    virtual MotionValidity validity(TimeTai time) const { return {MotionStatus::kOk, time}; }
    // Returns the state in the world; only called for valid instants. Loop: no allocation, no lock.
    virtual StateVector at(const MotionContext& context) const = 0;
    // Returns the acceleration of what does not fall freely about a body's centre, as far as it is known.
    // Loop.
    virtual std::optional<Vec3d> acceleration(const MotionContext&) const { return {}; }
    virtual std::vector<MotionNeed> needs() const { return {}; }
    // Returns where the motion comes from, for messages.
    virtual std::string name() const = 0;
};

struct AttitudeState {
    Quat world_from_body;
    Vec3d rate_body_rad_s;
};
inline constexpr AttitudeState kUnknownAttitude{{0, 0, 0, 0}, {}};  // no rotation, which no thing takes over

class AttitudeLaw {
  public:
    virtual ~AttitudeLaw() = default;
    virtual MotionValidity validity(TimeTai time) const { return {MotionStatus::kOk, time}; }
    // Loop.
    virtual AttitudeState at(const MotionContext& context, const OwnMotion& self) const = 0;
    virtual std::vector<MotionNeed> needs() const { return {}; }
    virtual std::string name() const = 0;
};

// The whole of a thing.
class MotionSource {
  public:
    MotionSource(std::unique_ptr<Trajectory> trajectory, std::unique_ptr<AttitudeLaw> attitude,
                 AttitudeJitter jitter = {});

    // Position and velocity of `out`, the latter also where it stands; then, from them, attitude and rate. `out` keeps what it
    // has in place of what cannot be. Loop.
    MotionStatus place(const MotionContext& context, Motion& out) const;
    MotionStatus turn(const MotionContext& context, Motion& out) const;
    // Does so at the scenario's start, place or attitude. Throws InputError for what cannot be.
    void begin(const MotionContext& context, bool attitude, Motion& out) const;
    std::vector<MotionNeed> place_needs() const { return trajectory_->needs(); }
    std::vector<MotionNeed> turn_needs() const { return attitude_->needs(); }
    // Says which part does not know the instant, and the nearest that it knows; empty: all know it. Not for the loop.
    std::string gap_at(TimeTai time) const;
    // Throws InputError when a part does not know the instant: what, where, accepted.
    void require(TimeTai time) const;

  private:
    std::unique_ptr<Trajectory> trajectory_;
    std::unique_ptr<AttitudeLaw> attitude_;
    AttitudeJitter jitter_;

    // These take over what the parts give, whether it can be or not.
    MotionStatus given_place(const MotionContext& context, Motion& out) const;
    MotionStatus given_attitude(const MotionContext& context, Motion& out) const;
};

// The sources of a scenario's things, in an order in which each part comes after what it needs. Two things
// may look at each other; what cannot be is a position by way of itself.
class MotionSources {
  public:
    MotionSources() = default;
    // One per thing: the camera's body, then the objects; null: none. Throws InputError when parts need each
    // other in a circle; `names` are for that message.
    MotionSources(std::vector<std::unique_ptr<MotionSource>> sources, std::span<const std::string> names);

    bool empty() const { return order_.empty(); }
    bool has(std::size_t thing) const { return thing < sources_.size() && sources_[thing]; }
    // Counts the parts that stood still because they do not know the instant, and those that gave what cannot be.
    struct Held {
        std::uint64_t unknown = 0, impossible = 0;
        std::size_t first_impossible = 0;  // thing
    };
    // Fills the motions of all things with a source for which live[thing] is 0. motions: those of the others
    // are right, and those of things with a source as they were last. standing: room for a flag of each thing. Loop.
    Held evaluate(const WorldFrame& frame, std::span<const std::uint8_t> live, std::span<Motion> motions,
                  std::span<std::uint8_t> standing) const;

    // Says what the first source that does not know the instant lacks; empty: all know it. Any thread but the loop's.
    std::string gap_at(TimeTai time) const;
    // Evaluates all of them at the scenario's start. Throws InputError for what cannot be. Owner thread.
    void begin(const WorldFrame& frame, std::span<Motion> motions) const;

  private:
    std::vector<std::string> names_;
    std::vector<std::unique_ptr<MotionSource>> sources_;
    std::vector<MotionNeed> order_;
};

}  // namespace hilcam
