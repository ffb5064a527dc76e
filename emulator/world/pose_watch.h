#pragma once
// Watches whether poses still come, and whether their time tags go forwards. A bench has one: commands tell
// it, every camera's loop asks it.
//
// Silence is measured in simulated time, from the arrival of the newest pose or angle that is watched: at
// half the speed a simulator sends half as often, and none while time stands. What a run shows does not
// depend on its speed, so it is the same at another scale. In lockstep, where frames must not depend on the
// machine, it is measured from the newest time tag. Before the first pose there is no silence: the scenario's
// own motion holds.
//
//     stale at an instant t:  t > newest + stale_after;  since:  newest + stale_after
// Example: stale_after_s 0.5, the last pose came at 10 s: a frame whose exposure begins at 10.4 s is as any
// other, one that begins at 10.51 s is stale since 10.5 s.
//
//   propagate  things go on by their last velocities and rates
//   hold       the whole world, bodies too, stands as it was at `since`: no jump back to the last tag, and no
//              target that flies away from a camera that stands
//   black      the shutter is closed: dark current, bias and noise remain
//   stop       no exposure begins until a pose comes; orders that wait are dropped
//
// A tag more than late_s before the newest tag of its thing is a clock that went back (a simulator begun
// anew, a clock stepped); what is less is a packet that came late, and takes its place between the others.
// Tags of 0
// ("on arrival") cannot go back. Accepted, it begins the thing's motion anew: what was known of it is
// forgotten, as the newest of it lies in a future that the sender has given up.
//
// Threads: judge() and took() any but the loop (a lock); the rest any, without one.

#include <atomic>
#include <compare>
#include <cstdint>
#include <limits>
#include <map>
#include <mutex>

#include "render/vocabulary/config_field.h"
#include "render/vocabulary/time.h"

namespace hilcam {

enum class WhenStale : std::uint8_t { kPropagate, kHold, kBlack, kStop };
enum class WatchedPoses : std::uint8_t { kAny, kCamera };
enum class WhenBackwards : std::uint8_t { kFlag, kAccept, kRefuse };

struct PoseRules {
    double horizon_s = 3600;
    double stale_after_s = 0;  // 0: never
    WhenStale when_stale = WhenStale::kPropagate;
    WatchedPoses watch = WatchedPoses::kAny;
    double late_s = 1;
    WhenBackwards backwards = WhenBackwards::kFlag;
};
Fields fields(PoseRules& rules);
// Throws InputError for what makes no sense in lockstep, where each frame is asked for.
void require_lockstep(const PoseRules& rules);

class PoseWatch {
  public:
    explicit PoseWatch(const PoseRules& rules = {}, bool lockstep = false);

    const PoseRules& rules() const { return rules_; }
    std::int64_t horizon_ns() const { return horizon_ns_; }

    // The thing whose pose is told; joint 0: the thing itself. Or a lamp, from 1: its time tags are judged,
    // but it is no pose, and its coming ends no silence.
    struct Subject {
        std::uint16_t object = 0, joint = 0, lamp = 0;
        friend auto operator<=>(const Subject&, const Subject&) = default;
    };
    enum class Verdict : std::uint8_t {
        kForwards,
        kAnew,       // the sender says that its time begins anew; judge() never does
        kBackwards,  // in effect all the same
        kRefused,
    };
    Verdict judge(Subject subject, TimeTai tag) const;
    // A pose is in effect (or was refused for its tag). Only of subjects that exist: each is remembered.
    void took(Subject subject, TimeTai tag, TimeTai arrival, Verdict verdict);

    struct Silence {
        bool stale = false;
        TimeTai since;
    };
    Silence at(TimeTai time) const;
    // No exposure may begin.
    bool stops(TimeTai time) const { return rules_.when_stale == WhenStale::kStop && at(time).stale; }
    // Tags that went back; and of them those that are to be seen in frames.
    std::uint64_t went_back() const { return went_back_.load(std::memory_order_relaxed); }
    std::uint64_t flagged() const { return rules_.backwards == WhenBackwards::kFlag ? went_back() : 0; }

  private:
    static constexpr std::int64_t kNone_ns = std::numeric_limits<std::int64_t>::min();

    const PoseRules rules_;
    const bool lockstep_;
    const std::int64_t horizon_ns_, stale_after_ns_, late_ns_;
    mutable std::mutex mutex_;
    std::map<Subject, TimeTai> newest_tags_;
    std::atomic<std::int64_t> newest_ns_{kNone_ns};  // arrival, or tag, of what is watched
    std::atomic<std::uint64_t> went_back_{0};
};

}  // namespace hilcam
