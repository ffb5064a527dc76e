#pragma once
// Watches whether poses keep coming, and whether their time tags go forwards. A bench has one watch: commands
// report to it, and every camera's loop asks it.
//
// Silence is measured in simulated time, from the arrival of the newest watched pose or angle. A simulator at
// half the speed sends half as often, and none while time stands still, so the result does not depend on the
// run's scale. In lockstep, where frames must not depend on the machine, it is measured from the newest time
// tag. There is no silence before the first pose, because the scenario's own motion is valid then.
//
//     stale at an instant t:  t > newest + stale_after;  since:  newest + stale_after
// Example: stale_after_s 0.5, last pose at 10 s. A frame with an exposure that begins at 10.4 s is normal;
// one that begins at 10.51 s is stale since 10.5 s.
//
//   propagate  things continue with their last velocities and rates
//   hold       the whole world, including bodies, stays as it was at `since`: things do not jump back to the
//              last tag, and the target does not fly away from a camera at rest
//   black      the shutter is closed: dark current, bias and noise remain
//   stop       no exposure begins until a pose arrives; waiting orders are dropped
//
// A tag more than late_s before the newest tag of its thing means that a clock was set back (a simulator
// restarted, a clock stepped). A smaller difference means that a packet was late; it is sorted in among the
// others. Tags of 0 ("on arrival") cannot go back. If a backward tag is accepted, the thing's motion starts
// again: earlier poses are forgotten, because they belong to a future that the sender has given up.
//
// Threads: judge() and took() any except the loop (they lock); all others any, without a lock.

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
// Throws InputError for rules without meaning in lockstep, where each frame is ordered.
void require_lockstep(const PoseRules& rules);

class PoseWatch {
  public:
    explicit PoseWatch(const PoseRules& rules = {}, bool lockstep = false);

    const PoseRules& rules() const { return rules_; }
    std::int64_t horizon_ns() const { return horizon_ns_; }

    // The thing that a pose moves; joint 0: the thing itself. Or a lamp, from 1: its time tags are judged,
    // but a switch is not a pose and does not end a silence.
    struct Subject {
        std::uint16_t object = 0, joint = 0, lamp = 0;
        friend auto operator<=>(const Subject&, const Subject&) = default;
    };
    enum class Verdict : std::uint8_t {
        kForwards,
        kAnew,       // the sender says that its time restarts; judge() never returns this
        kBackwards,  // takes effect anyway
        kRefused,
    };
    Verdict judge(Subject subject, TimeTai tag) const;
    // Call when a pose has taken effect, or was refused for its tag. Only for existing subjects, because each
    // is remembered.
    void took(Subject subject, TimeTai tag, TimeTai arrival, Verdict verdict);

    struct Silence {
        bool stale = false;
        TimeTai since;
    };
    Silence at(TimeTai time) const;
    // True when no exposure may begin.
    bool stops(TimeTai time) const { return rules_.when_stale == WhenStale::kStop && at(time).stale; }
    // Number of tags that went back, and of those among them that frames must show.
    std::uint64_t went_back() const { return went_back_.load(std::memory_order_relaxed); }
    std::uint64_t flagged() const { return rules_.backwards == WhenBackwards::kFlag ? went_back() : 0; }

  private:
    static constexpr std::int64_t kNone_ns = std::numeric_limits<std::int64_t>::min();

    const PoseRules rules_;
    const bool lockstep_;
    const std::int64_t horizon_ns_, stale_after_ns_, late_ns_;
    mutable std::mutex mutex_;
    std::map<Subject, TimeTai> newest_tags_;
    // Arrival, or tag in lockstep, of the newest watched pose.
    std::atomic<std::int64_t> newest_ns_{kNone_ns};
    std::atomic<std::uint64_t> went_back_{0};
};

}  // namespace hilcam
