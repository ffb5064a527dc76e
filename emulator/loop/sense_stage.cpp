#include "emulator/loop/sense_stage.h"

#include <algorithm>

#include "emulator/loop/frame_schedule.h"
#include "emulator/loop/image_faults.h"
#include "emulator/loop/live_settings.h"
#include "emulator/world/clock.h"
#include "emulator/world/world_state.h"
#include "sensor/test_pattern.h"

namespace hilcam {

// Frames are largest without binning.
SenseStage::SenseStage(const LoopParts& parts, LoopFigures& figures)
    : chain_(parts.chain),
      camera_(parts.camera),
      faults_(parts.faults),
      clock_(parts.clock),
      sinks_(parts.sinks),
      seed_(parts.seed),
      replays_(parts.script != nullptr),
      loses_none_(replays_ || parts.settings.limits().lockstep),
      recorder_(parts.observers.recorder),
      recorded_camera_(parts.observers.recorded_camera),
      recorded_shown_(recorder_ ? parts.world.things() : 0),
      counters_(figures.counters),
      meters_(figures.meters) {
    const auto [width, height] = array_size(camera_);
    electrons_ = ElectronImage(width, height);
    frame_ = DnImage(width, height);
    before_ = DnImage(width, height);
    if (parts.settings.limits().has_automatic_exposure) histogram_ = FrameHistogram(camera_.frame_bits());
}

bool SenseStage::run(FrameSlot& slot, const std::atomic<bool>& stopping) {
    sense(slot);
    if (!wait_for_end(slot, stopping)) return false;
    wait_for_room();
    if (!replays_) know_machine_times(slot);
    if (recorder_) keep(slot);
    publish(slot);
    return true;
}

void SenseStage::sense(FrameSlot& slot) {
    const std::int64_t begun_ns = monotonic_ns();
    const auto [width, height] = frame_size(camera_, slot.exposure.binning_x, slot.exposure.binning_y);
    frame_.reshape(width, height);
    chain_.expose(slot.radiance, slot.points, slot.exposure, electrons_, slot.beside);
    chain_.digitise(electrons_, slot.exposure, {seed_, slot.record.id}, frame_);
    slot.next_exposure_s = 0;
    if (slot.automatic) measure_exposure(slot);
    const SensorTimes& times = chain_.times();
    meters_.collapse.record_ms(times.collapse_ms);
    meters_.convolve.record_ms(times.convolve_ms);
    meters_.points.record_ms(times.points_ms);
    meters_.digitise.record_ms(times.digitise_ms);
    finish_picture(slot);
    const std::uint64_t flipped = strike_image(slot.use.image, slot.record, seed_, before_, frame_);
    if (flipped > 0) faults_.count(FaultKind::kImageBitFlips, slot.record.id, flipped, 0);
    slot.sense_ns = monotonic_ns() - begun_ns;
    meters_.sense.record(slot.sense_ns);
}

void SenseStage::measure_exposure(FrameSlot& slot) {
    const auto binned = [](std::int64_t black, std::int64_t binning) {
        return static_cast<int>((black + binning - 1) / binning);
    };
    const Brightness seen =
        histogram_.measure(frame_, binned(camera_.black_columns, slot.exposure.binning_x),
                           binned(camera_.black_rows, slot.exposure.binning_y),
                           camera_.auto_exposure.percentile, dn_scale_of(camera_, slot.exposure));
    slot.next_exposure_s = next_exposure_s(camera_.auto_exposure, seen, slot.exposure.exposure_s,
                                           {camera_.exposure_range_s[0], camera_.exposure_range_s[1]});
}

// Applies what a camera does to its numbers before output.
void SenseStage::finish_picture(const FrameSlot& slot) {
    draw_test_pattern(slot.use.test_pattern, slot.record.bits, slot.record.id, frame_);
    if (slot.use.reverse_x)
        for (int y = 0; y < frame_.height(); ++y) std::reverse(frame_.row(y).begin(), frame_.row(y).end());
    if (slot.use.reverse_y)
        for (int y = 0; y < frame_.height() / 2; ++y)
            std::swap_ranges(frame_.row(y).begin(), frame_.row(y).end(),
                             frame_.row(frame_.height() - 1 - y).begin());
}

// Waits until the exposure has ended, and until a replay wants the frame. If the run is stopped meanwhile,
// the frame is not published.
bool SenseStage::wait_for_end(const FrameSlot& slot, const std::atomic<bool>& stopping) const {
    for (std::int64_t now_ns = monotonic_ns();; now_ns = monotonic_ns()) {
        const bool over = clock_.camera_at(now_ns) >= slot.leaves_camera_ns;
        if (over && now_ns >= slot.not_before_ns) return true;
        if (stopping.load(std::memory_order_relaxed)) return false;
        const std::int64_t due_ns = over ? slot.not_before_ns : clock_.when_due(slot.leaves_camera_ns);
        sleep_until_monotonic_ns(std::min(due_ns, now_ns + kLongestSleep_ns));
    }
}

// In lockstep and in a replay, waits until every output has room, because no frame may be lost, including the
// last ones of a run. Otherwise waits for outputs that must not lose frames.
void SenseStage::wait_for_room() {
    constexpr std::int64_t kPoll_ns = 200'000, kPatience_ns = 10'000'000'000;
    const auto room = [this](const FrameSink* sink) {
        return (!loses_none_ && !sink->must_be_waited_for()) || sink->has_room();
    };
    const std::int64_t begun_ns = monotonic_ns();
    std::int64_t now_ns = begun_ns;
    while (!std::all_of(sinks_.begin(), sinks_.end(), room) && now_ns < begun_ns + kPatience_ns) {
        sleep_until_monotonic_ns(now_ns + kPoll_ns);
        now_ns = monotonic_ns();
    }
    counters_.waited_for_outputs_ns.fetch_add(now_ns - begun_ns, std::memory_order_relaxed);
}

// Finds the times of the exposure on the machine's clock; the scale of time may have changed since it began.
void SenseStage::know_machine_times(FrameSlot& slot) const {
    slot.use.middle_ns = clock_.monotonic_of_camera(slot.middle_camera_ns);
    slot.use.end_ns = clock_.monotonic_of_camera(slot.end_camera_ns);
    slot.record.exposure_mid_monotonic_ns = slot.use.middle_ns;
}

// Records which commands the frame shows, if that has changed, and then the frame.
void SenseStage::keep(const FrameSlot& slot) {
    for (std::size_t i = 0; i < recorded_shown_.size() && !slot.use.shutter_closed; ++i) {
        const std::uint64_t number = slot.shown_numbers[i];
        if (number == recorded_shown_[i]) continue;
        recorded_shown_[i] = number;
        recorder_->keep_shown(recorded_camera_, static_cast<std::uint32_t>(i), number);
    }
    recorder_->keep_frame(recorded_camera_, slot.use);
}

void SenseStage::publish(FrameSlot& slot) {
    const FrameRecord& record = slot.record;
    for (FrameSink* sink : sinks_)
        sink->on_event({CameraEvent::Kind::kExposureEnd, record.id, slot.use.end_ns});
    const std::int64_t publish_ns = monotonic_ns();
    for (FrameSink* sink : sinks_) sink->publish(frame_, record);
    std::swap(frame_, before_);
    const std::int64_t done_ns = monotonic_ns();
    meters_.publish.record(done_ns - publish_ns);
    slot.sense_ns += done_ns - publish_ns;
    meters_.work.record(slot.render_ns + slot.sense_ns);
    if (record.command_arrival_monotonic_ns != 0)
        meters_.latency.record(done_ns - record.command_arrival_monotonic_ns);
    if (last_published_ns_ != 0) meters_.interval.record(done_ns - last_published_ns_);
    last_published_ns_ = done_ns;
    counters_.last_id.store(record.id, std::memory_order_relaxed);
}

}  // namespace hilcam
