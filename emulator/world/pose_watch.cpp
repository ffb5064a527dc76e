#include "emulator/world/pose_watch.h"

#include <algorithm>

#include "render/vocabulary/check.h"
#include "render/vocabulary/time.h"

namespace hilcam {

Fields fields(PoseRules& r) {
    return {
        number("horizon_s", r.horizon_s, 1, {1e-3, 1e8},
               "largest difference between a time tag and simulated time; poses beyond it are refused"),
        number("stale_after_s", r.stale_after_s, 1, {0, 1e7},
               "simulated time without a pose after which frames are stale; 0: never. In lockstep: since the "
               "newest time tag"),
        choice("when_stale", r.when_stale, {"propagate", "hold", "black", "stop"},
               "treatment of stale frames. propagate: motion continues; hold: the world stands still; black: "
               "the shutter stays closed; stop: no frames"),
        choice("watch", r.watch, {"any", "camera"},
               "poses that reset stale_after_s: those of any thing or joint, or of the camera's body alone"),
        number("late_s", r.late_s, 1, {0, 1e6},
               "largest time by which a tag may precede the newest tag of its thing and count as late; "
               "beyond it, time goes backwards"),
        choice("backwards", r.backwards, {"flag", "accept", "refuse"},
               "treatment of poses whose time goes backwards. flag: the pose is used, and frame and "
               "acknowledgement report it; accept: it is used; refuse: it is not used"),
    };
}

void require_lockstep(const PoseRules& r) {
    if (r.when_stale == WhenStale::kStop)
        throw InputError(
            "commands.poses.when_stale: found 'stop'; accepted with 'mode: lockstep': propagate, hold, "
            "black, "
            "as each frame is asked for");
}

PoseWatch::PoseWatch(const PoseRules& rules, bool lockstep)
    : rules_(rules),
      lockstep_(lockstep),
      horizon_ns_(to_ns(rules.horizon_s)),
      stale_after_ns_(to_ns(rules.stale_after_s)),
      late_ns_(to_ns(rules.late_s)) {}

PoseWatch::Verdict PoseWatch::judge(Subject subject, TimeTai tag) const {
    const std::lock_guard lock(mutex_);
    const auto newest = newest_tags_.find(subject);
    // Tags in lockstep may have any value, so they are compared without overflow.
    if (newest == newest_tags_.end() || tag >= newest->second) return Verdict::kForwards;
    const auto back_ns = static_cast<std::uint64_t>(newest->second.ns) - static_cast<std::uint64_t>(tag.ns);
    if (back_ns <= static_cast<std::uint64_t>(late_ns_)) return Verdict::kForwards;
    return rules_.backwards == WhenBackwards::kRefuse ? Verdict::kRefused : Verdict::kBackwards;
}

void PoseWatch::took(Subject subject, TimeTai tag, TimeTai arrival, Verdict verdict) {
    if (verdict == Verdict::kBackwards || verdict == Verdict::kRefused)
        went_back_.fetch_add(1, std::memory_order_relaxed);
    if (verdict == Verdict::kRefused) return;
    const std::lock_guard lock(mutex_);
    TimeTai& newest = newest_tags_.try_emplace(subject, tag).first->second;
    const bool anew = verdict != Verdict::kForwards;
    newest = anew ? tag : std::max(newest, tag);
    if (subject.lamp != 0) return;
    if (rules_.watch == WatchedPoses::kCamera && (subject.object != 0 || subject.joint != 0)) return;
    const std::int64_t at_ns = lockstep_ ? newest.ns : arrival.ns;
    newest_ns_.store(anew && lockstep_ ? at_ns : std::max(at_ns, newest_ns_.load(std::memory_order_relaxed)),
                     std::memory_order_release);
}

PoseWatch::Silence PoseWatch::at(TimeTai time) const {
    const std::int64_t newest_ns = newest_ns_.load(std::memory_order_acquire);
    if (stale_after_ns_ == 0 || newest_ns == kNone_ns) return {};
    // In lockstep both values may be anything, so the sum must not overflow.
    if (newest_ns > std::numeric_limits<std::int64_t>::max() - stale_after_ns_) return {};
    const TimeTai since{newest_ns + stale_after_ns_};
    return {since < time, since};
}

}  // namespace hilcam
