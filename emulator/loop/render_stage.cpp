#include "emulator/loop/render_stage.h"

#include <algorithm>

#include "io/contract/frame_flags.h"
#include "io/system/monotonic.h"
#include "io/truth/sink_truth.h"

namespace hilcam {

RenderStage::RenderStage(const LoopParts& parts, LoopFigures& figures)
    : exposures_(parts.exposures),
      world_(parts.world),
      settings_(parts.settings),
      camera_(parts.camera),
      poses_(parts.script ? nullptr : parts.poses),
      sinks_(parts.sinks),
      seed_(parts.seed),
      script_(parts.script),
      observers_(parts.observers),
      counters_(figures.counters),
      meters_(figures.meters),
      missed_(figures.missed),
      planner_(parts) {}

void RenderStage::prepare(FrameSlot& slot) const {
    slot.radiance = exposures_.make_image();
    slot.points.reserve(exposures_.max_points());
    if (camera_.outside_light) ExposureRenderer::reserve_beside(slot.beside);
    if (observers_.recorder) slot.shown_numbers.resize(world_.things());
}

bool RenderStage::run(FrameSlot& slot, const std::atomic<bool>& stopping) {
    if (!begin(slot, stopping)) return false;
    latch(slot);
    const FrameUse& use = slot.use;
    for (FrameSink* sink : sinks_)
        sink->on_event({CameraEvent::Kind::kExposureStart, use.id, use.begin_ns, use.end_ns});
    render(slot);
    if (observers_.watcher)
        observers_.watcher->seen({use.id, use.begin_ns, use.exposure_mid, use.exposure_s, use.shutter_closed},
                                 exposures_.middle_world());
    if (ends_order_) settings_.order_done();
    if (script_) script_->seen();
    return true;
}

void RenderStage::close() {
    settings_.close();
    if (observers_.light_parts) observers_.light_parts->close();
}

// Waits for the next frame's begin and finds what the frame depends on; false when there are no more frames.
bool RenderStage::begin(FrameSlot& slot, const std::atomic<bool>& stopping) {
    const bool begun = script_ ? script_->next(stopping, slot.use, slot.not_before_ns)
                               : planner_.next(stopping, slot, ends_order_);
    if (!begun) return false;
    if (!script_) counters_.budget_ms.store(planner_.budget_ms(), std::memory_order_relaxed);
    use_level(slot.use.quality_level);
    take_light(slot.use);
    counters_.deadline_misses.fetch_add(slot.use.skipped + (slot.use.late ? 1 : 0),
                                        std::memory_order_relaxed);
    missed_.note(slot.use.id, slot.use.skipped, slot.use.late, slot.use.exposure_mid.ns);
    return true;
}

void RenderStage::use_level(std::uint32_t level) {
    if (level != level_) {
        // The level of the first frame is not a change.
        if (has_begun_) counters_.level_changes.fetch_add(1, std::memory_order_relaxed);
        exposures_.use_level(level);
    }
    level_ = level, has_begun_ = true;
    counters_.level.store(level, std::memory_order_relaxed);
    counters_.frames_at_level[level].fetch_add(1, std::memory_order_relaxed);
}

void RenderStage::take_light(FrameUse& use) {
    const bool lacks = !exposures_.take_light();
    counters_.lacks_light.store(lacks, std::memory_order_relaxed);
    if (!lacks) return;
    use.faults |= kNoCachedLightBit;
    counters_.without_light.fetch_add(1, std::memory_order_relaxed);
    counters_.last_without_light.store(use.id, std::memory_order_relaxed);
}

// Copies what the frame depends on into it; later changes do not affect it.
void RenderStage::latch(FrameSlot& slot) {
    const FrameUse& use = slot.use;
    settings_.report_own(use.exposure_s, use.gain_db);
    FrameRecord& record = slot.record;
    record = {};
    record.id = use.id;
    record.exposure_s = use.exposure_s;
    record.gain_db = use.gain_db;
    record.black_level_dn = use.black_level_dn;
    record.bits = camera_.frame_bits();
    record.binning_x = use.binning_x, record.binning_y = use.binning_y;
    record.trigger_sequence = use.trigger_sequence;
    record.sequencer_set = use.sequencer_set;
    record.quality_level = use.quality_level;
    record.reverse_x = use.reverse_x, record.reverse_y = use.reverse_y;
    record.faults = use.faults;
    record.exposure_mid_monotonic_ns = use.middle_ns;
    record.exposure_mid = use.exposure_mid;
    slot.exposure = {use.exposure_s, use.gain_db, use.black_level_dn, use.binning_x, use.binning_y, {}, {}};
    if (use.faults & kTimeStandsBit) counters_.standing.fetch_add(1, std::memory_order_relaxed);
    if (use.faults & kPosesStaleBit) counters_.stale.fetch_add(1, std::memory_order_relaxed);
}

void RenderStage::render(FrameSlot& slot) {
    LightPartOrders::Order* const order = observers_.light_parts ? observers_.light_parts->begin() : nullptr;
    if (slot.use.shutter_closed) {
        // The order's new buffer stays without light.
        exposures_.keep_dark(slot.radiance, slot.points, slot.exposure);
        slot.beside.clear();
        slot.render_ns = 0;  // does not count as the cost of a frame
    } else {
        if (order) exposures_.keep_parts(order->buffer.get());
        render_light(slot, order);
        if (order) exposures_.keep_parts(nullptr);
    }
    if (order) observers_.light_parts->done(slot.record);
}

void RenderStage::render_light(FrameSlot& slot, const LightPartOrders::Order* order) {
    const std::int64_t begun_ns = monotonic_ns();
    FrameRecord& record = slot.record;
    report_pose_tags(slot);
    const bool with_truth = order && order->with_truth;
    FrameTruth* const truth = observers_.truth ? observers_.truth->begin(record, with_truth) : nullptr;
    record.has_truth = truth != nullptr;
    const ExposureRenderer::Result result =
        exposures_.render(world_, {slot.use.shown_at, slot.use.moving}, {seed_, record.id}, slot.radiance,
                          slot.points, slot.exposure, truth);
    report_impossible(slot);
    exposures_.look_beside(slot.beside);
    record.camera = exposures_.middle_world().camera;
    report_commands(result.shown, slot);

    stats_ = result.stats;
    if (result.parts_limited) counters_.motion_limited.fetch_add(1, std::memory_order_relaxed);
    meters_.setup.record_ms(stats_.setup_ms);
    meters_.trace.record_ms(stats_.trace_ms);
    meters_.stars.record_ms(stats_.points_ms);
    slot.render_ns = monotonic_ns() - begun_ns;
    meters_.render.record(slot.render_ns);
}

// Flags the first frame after time tags went backwards.
void RenderStage::report_pose_tags(FrameSlot& slot) {
    const std::uint64_t flagged = poses_ ? poses_->flagged() : 0;
    if (flagged == flagged_) return;
    slot.use.faults |= kTagsWentBackBit;
    slot.record.faults = slot.use.faults;
    flagged_ = flagged;
}

void RenderStage::report_impossible(FrameSlot& slot) {
    const std::uint64_t impossible = world_.impossible();
    if (impossible == impossible_) return;
    slot.use.faults |= kImpossibleMotionBit;
    slot.record.faults = slot.use.faults;
    counters_.impossible.fetch_add(1, std::memory_order_relaxed);
    impossible_ = impossible;
}

void RenderStage::report_commands(const ShownCommand& shown, FrameSlot& slot) {
    FrameRecord& record = slot.record;
    record.pose_sequence = shown.sequence;
    record.pose_time = shown.time;
    // Latency counts for a command in the first frame that shows it.
    record.command_arrival_monotonic_ns =
        !script_ && shown.arrival_monotonic_ns > shown_arrival_ns_ ? shown.arrival_monotonic_ns : 0;
    shown_arrival_ns_ = std::max(shown_arrival_ns_, shown.arrival_monotonic_ns);
    if (observers_.recorder) world_.shown_numbers(slot.shown_numbers);
}

}  // namespace hilcam
