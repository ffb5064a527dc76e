#pragma once
// A motion source gives a thing's position and attitude at any instant. It consists of a trajectory, an
// attitude law and jitter from the scenario; each is a pure function of the instant and of the things that it
// follows.
//
// Outside the instants that a part covers (before or after an ephemeris, or in a gap) the thing stays as it
// was at the nearest covered instant, and the status says so; the axes of its orbit stay as well. If a part
// returns something that is not a number, or exceeds the bounds of motion (motion_bounds.h), the thing keeps
// its previous state, and the status says that, too.

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
    kImpossible  // the part returned an impossible value (motion_bounds.h); validity() never returns this
};

// Says whether a part covers an instant, and the nearest instant that it covers.
struct MotionValidity {
    MotionStatus status = MotionStatus::kOk;
    TimeTai nearest;
};
// A part returns this for an instant inside its span that it turns out not to know. No thing takes over these
// values.
inline constexpr StateVector kUnknownState{{std::numeric_limits<double>::quiet_NaN(), 0, 0}, {}};
// Returns the validity for a span that includes both ends.
MotionValidity validity_of(TimeTai time, TimeTai first, TimeTai last);

// The part of the world at one instant that trajectories and attitude laws may use.
struct MotionContext {
    const WorldFrame& frame;
    std::span<const Motion> things;  // the camera's body, then the objects; correct for everything in needs()
    // Flags of things that stand still because their source does not cover the instant. Such a thing's
    // velocity is that of its trajectory, so that its orbit has axes, but it does not move with it. Empty:
    // none.
    std::span<const std::uint8_t> standing = {};

    bool stands(std::size_t thing) const { return thing < standing.size() && standing[thing] != 0; }
};

// The thing that the attitude is asked for: its state in the world, and whether it stands still, as above.
struct OwnMotion {
    OwnMotion(const StateVector& s, bool still = false, std::optional<Vec3d> change = {})
        : state(s), stands(still), acceleration_m_s2(change) {}

    StateVector state;
    bool stands;
    std::optional<Vec3d> acceleration_m_s2;  // empty: it falls freely
};

// A part of another thing that must be evaluated first.
struct MotionNeed {
    std::size_t thing = 0;
    bool attitude = false;  // true: its attitude, false: its position
};

class Trajectory {
  public:
    virtual ~Trajectory() = default;
    // Covers every instant unless overridden. Loop.
    virtual MotionValidity validity(TimeTai time) const { return {MotionStatus::kOk, time}; }
    // Returns the state in the world; called only for valid instants. Loop: no allocation, no lock.
    virtual StateVector at(const MotionContext& context) const = 0;
    // Returns the acceleration of a thing that does not fall freely about a body's centre, if it is known.
    // Loop.
    virtual std::optional<Vec3d> acceleration(const MotionContext&) const { return {}; }
    virtual std::vector<MotionNeed> needs() const { return {}; }
    // Returns the origin of the motion, for messages.
    virtual std::string name() const = 0;
};

struct AttitudeState {
    Quat world_from_body;
    Vec3d rate_body_rad_s;
};
inline constexpr AttitudeState kUnknownAttitude{{0, 0, 0, 0}, {}};  // not a rotation; no thing takes it over

class AttitudeLaw {
  public:
    virtual ~AttitudeLaw() = default;
    virtual MotionValidity validity(TimeTai time) const { return {MotionStatus::kOk, time}; }
    // Loop.
    virtual AttitudeState at(const MotionContext& context, const OwnMotion& self) const = 0;
    virtual std::vector<MotionNeed> needs() const { return {}; }
    virtual std::string name() const = 0;
};

// All motion of one thing.
class MotionSource {
  public:
    MotionSource(std::unique_ptr<Trajectory> trajectory, std::unique_ptr<AttitudeLaw> attitude,
                 AttitudeJitter jitter = {});

    // place() sets position and velocity of `out`, the velocity also while the thing stands still. turn()
    // sets attitude and rate and needs the result of place(). Impossible values leave `out` unchanged. Loop.
    MotionStatus place(const MotionContext& context, Motion& out) const;
    MotionStatus turn(const MotionContext& context, Motion& out) const;
    // Does the same at the scenario's start, for position or attitude. Throws InputError for impossible
    // values.
    void begin(const MotionContext& context, bool attitude, Motion& out) const;
    std::vector<MotionNeed> place_needs() const { return trajectory_->needs(); }
    std::vector<MotionNeed> turn_needs() const { return attitude_->needs(); }
    // Says which part does not cover the instant, and the nearest instant that it covers; empty: all cover
    // it. Not for the loop.
    std::string gap_at(TimeTai time) const;
    // Throws InputError when a part does not cover the instant; the message says what, where and what is
    // accepted.
    void require(TimeTai time) const;

  private:
    std::unique_ptr<Trajectory> trajectory_;
    std::unique_ptr<AttitudeLaw> attitude_;
    AttitudeJitter jitter_;

    // Set what the parts return, possible or not.
    MotionStatus given_place(const MotionContext& context, Motion& out) const;
    MotionStatus given_attitude(const MotionContext& context, Motion& out) const;
};

// The sources of all things in a scenario, ordered so that each part comes after the parts it needs. Two
// things may point at each other; a position must not depend on itself.
class MotionSources {
  public:
    MotionSources() = default;
    // sources: one for each thing, the camera's body first, then the objects; null: none. names: for
    // messages. Throws InputError when parts need each other in a circle.
    MotionSources(std::vector<std::unique_ptr<MotionSource>> sources, std::span<const std::string> names);

    bool empty() const { return order_.empty(); }
    bool has(std::size_t thing) const { return thing < sources_.size() && sources_[thing]; }
    // Counts parts that stood still because they do not cover the instant, and parts that returned impossible
    // values.
    struct Held {
        std::uint64_t unknown = 0, impossible = 0;
        std::size_t first_impossible = 0;  // first thing with impossible values
    };
    // Updates the motions of all things that have a source and for which live[thing] is 0. motions: current
    // for all other things; for things with a source, as they were last. standing: receives a flag for each
    // thing. Loop.
    Held evaluate(const WorldFrame& frame, std::span<const std::uint8_t> live, std::span<Motion> motions,
                  std::span<std::uint8_t> standing) const;

    // Says what the first source lacks that does not cover the instant; empty: all cover it. Any thread
    // except the loop's.
    std::string gap_at(TimeTai time) const;
    // Evaluates all sources at the scenario's start. Throws InputError for impossible values. Owner thread.
    void begin(const WorldFrame& frame, std::span<Motion> motions) const;

  private:
    std::vector<std::string> names_;
    std::vector<std::unique_ptr<MotionSource>> sources_;
    std::vector<MotionNeed> order_;
};

}  // namespace hilcam
