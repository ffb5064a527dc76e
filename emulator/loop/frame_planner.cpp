#include "emulator/loop/frame_planner.h"

#include <algorithm>
#include <limits>

#include "emulator/loop/image_faults.h"
#include "io/contract/frame_flags.h"
#include "render/vocabulary/time.h"

namespace hilcam {
namespace {

bool is_governed(const LoopParts& parts) { return parts.limits.paced && !parts.settings.limits().lockstep; }

}  // namespace

FramePlanner::FramePlanner(const LoopParts& parts)
    : camera_(parts.camera),
      timing_(parts.camera),
      faults_(parts.faults),
      clock_(parts.clock),
      poses_(parts.poses),
      prefer_(parts.limits.prefer),
      starter_(parts.camera, parts.settings, parts.clock, parts.limits, parts.poses),
      budget_is_of_rate_(is_governed(parts) && parts.limits.governor.is_told()),
      governor_(is_governed(parts) ? parts.limits.governor : GovernorSettings{}) {}

bool FramePlanner::next(const std::atomic<bool>& stopping, FrameSlot& slot, bool& ends_order) {
    FrameStarter::Start start;
    if (!starter_.next(slot.next_exposure_s, stopping, start)) return false;
    take_settings(start, slot);
    place_in_time(start, slot);
    last_id_ = slot.use.id;
    ends_order = start.ends_order;
    return true;
}

void FramePlanner::take_settings(const FrameStarter::Start& start, FrameSlot& slot) {
    const CameraSettings& s = start.settings;
    FrameUse use;
    use.id = last_id_ + 1 + start.skipped;
    use.skipped = start.skipped, use.late = start.late;
    use.exposure_s = start.exposure_s;
    use.gain_db = s.gain_db;
    if (!camera_.sequence.empty()) {
        const SettingsStep& step = camera_.sequence[(use.id - 1) % camera_.sequence.size()];
        use.exposure_s = step.exposure_s;
        use.gain_db = step.gain_db;
    }
    use.black_level_dn = s.black_level_dn;
    use.binning_x = s.binning_x, use.binning_y = s.binning_y;
    use.test_pattern = s.test_pattern;
    use.reverse_x = s.reverse_x, use.reverse_y = s.reverse_y;
    use.trigger_sequence = start.trigger_sequence;
    use.sequencer_set = start.sequencer_set;
    use.quality_level = choose_level(start, slot, use.id);
    faults_.begin(use.id);
    use.faults = frame_faults(faults_, use.id);
    use.image = image_faults(faults_, use.id);
    slot.use = use;
    slot.automatic = s.automatic_exposure;
}

// Sets a frame's instants, and what it shows of simulated time: its whole exposure, part of it if time stops
// meanwhile, or one instant.
void FramePlanner::place_in_time(const FrameStarter::Start& start, FrameSlot& slot) const {
    FrameUse& use = slot.use;
    const std::int64_t middle_ns = to_ns(timing_.middle_s(use.exposure_s));
    const std::int64_t length_ns = to_ns(timing_.end_s(use.exposure_s));
    slot.middle_camera_ns = start.camera_ns + middle_ns;
    slot.end_camera_ns = start.camera_ns + length_ns;
    slot.leaves_camera_ns = start.until_end ? std::max(slot.end_camera_ns, start.ready_camera_ns)
                                            : std::numeric_limits<std::int64_t>::min();
    const TimeTai begin = clock_.simulated_of_camera(start.camera_ns);
    const std::int64_t moved_ns = clock_.simulated_of_camera(slot.end_camera_ns) - begin;
    use.moving = moved_ns == length_ns ? 1 : static_cast<double>(moved_ns) / static_cast<double>(length_ns);
    use.begin_ns = start.begin_ns;
    use.middle_ns = clock_.monotonic_of_camera(slot.middle_camera_ns);
    use.end_ns = clock_.monotonic_of_camera(slot.end_camera_ns);
    use.exposure_mid = begin + (use.moving == 1 ? middle_ns : moved_ns / 2);
    use.shown_at = use.exposure_mid;
    if (use.moving == 0) use.faults |= kTimeStandsBit;
    if (!start.silence.stale) return;
    use.faults |= kPosesStaleBit;
    if (poses_->rules().when_stale == WhenStale::kHold) use.shown_at = start.silence.since, use.moving = 0;
    use.shutter_closed = poses_->rules().when_stale == WhenStale::kBlack;
}

// Returns how long the slot's last frame kept the next one waiting.
double FramePlanner::frame_ms(const FrameSlot& slot) const {
    const std::int64_t ns = prefer_ == LoopPreference::kLatency ? slot.render_ns + slot.sense_ns
                                                                : std::max(slot.render_ns, slot.sense_ns);
    return static_cast<double>(ns) * 1e-6;
}

// Returns the machine's time until the next exposure is due.
double FramePlanner::budget_ms(const FrameStarter::Start& start) const {
    if (start.period_ns == 0) return 0;
    const std::int64_t due_ns = clock_.monotonic_of_camera(start.camera_ns + start.period_ns);
    return static_cast<double>(due_ns - clock_.monotonic_of_camera(start.camera_ns)) * 1e-6;
}

std::uint32_t FramePlanner::choose_level(const FrameStarter::Start& start, const FrameSlot& slot,
                                         std::uint64_t frame) {
    const std::size_t before = governor_.level();
    if (budget_is_of_rate_) governor_.use_budget(budget_ms(start));
    const std::size_t now =
        slot.render_ns > 0 ? governor_.take(slot.use.quality_level, frame_ms(slot)) : governor_.level();
    if (now != before && last_id_ > 0)
        level_changes_.push({frame, before, now, governor_.mean_ms(before), governor_.budget_ms()});
    return static_cast<std::uint32_t>(now);
}

}  // namespace hilcam
