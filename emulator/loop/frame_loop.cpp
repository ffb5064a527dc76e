#include "emulator/loop/frame_loop.h"

#include <algorithm>
#include <cmath>

#include "emulator/loop/frame_schedule.h"
#include "emulator/loop/image_faults.h"
#include "io/contract/frame_flags.h"
#include "render/vocabulary/time.h"
#include "sensor/test_pattern.h"

namespace hilcam {
namespace {

std::int64_t from_ms(double ms) { return static_cast<std::int64_t>(ms * 1e6); }

}  // namespace

FrameLoop::FrameLoop(ExposureRenderer& exposures, SensorChain& chain, const CameraModel& camera,
                     WorldState& world, LiveSettings& settings, FaultBoard& faults, SimulatedClock& clock,
                     std::vector<FrameSink*> sinks, std::uint64_t seed, const LoopLimits& limits,
                     const PoseWatch* poses)
    : exposures_(exposures),
      chain_(chain),
      camera_(camera),
      timing_(camera),
      world_(world),
      settings_(settings),
      faults_(faults),
      clock_(clock),
      poses_(poses),
      starter_(camera, settings, clock, limits.paced, poses),
      sinks_(std::move(sinks)),
      seed_(seed),
      limits_(limits),
      lockstep_(settings.limits().lockstep),
      governor_(limits.paced && !lockstep_ ? limits.governor : GovernorSettings{}),
      free_(limits.prefer == LoopPreference::kLatency ? 1 : 2) {
    for (Slot& slot : slots_) {
        slot.radiance = exposures.make_image();
        slot.points.reserve(exposures.max_points());
        if (camera.has_outside_light) ExposureRenderer::reserve_beside(slot.beside);
    }
    // Frames are smaller when they are binned more.
    const auto [width, height] = array_size(camera);
    electrons_ = ElectronImage(width, height);
    frame_ = DnImage(width, height);
    before_ = DnImage(width, height);
    if (settings.limits().has_automatic_exposure) histogram_ = FrameHistogram(camera.frame_bits());
}

void FrameLoop::record_to(FrameRecorder& recorder, std::uint16_t camera) {
    recorder_ = &recorder;
    recorded_camera_ = camera;
    recorded_shown_.resize(world_.things());
    for (Slot& slot : slots_) slot.shown_numbers.resize(world_.things());
}

void FrameLoop::start() {
    sense_thread_ = std::thread([this] { sense_frames(); });
    render_thread_ = std::thread([this] { render_frames(); });
}

void FrameLoop::stop() noexcept {
    stopping_.store(true);
    if (render_thread_.joinable()) render_thread_.join();
    if (sense_thread_.joinable()) sense_thread_.join();
}

// --- stage 1
// -------------------------------------------------------------------------------------------------------

void FrameLoop::render_frames() {
    for (std::size_t turn = 0;; ++turn) {
        free_.acquire();
        const bool enough = limits_.frames != 0 && turn >= limits_.frames;
        Slot& slot = slots_[turn % slots_.size()];
        if (enough || !begin(slot)) break;
        latch(slot);
        notify(CameraEvent::Kind::kExposureStart, slot.use.id, slot.use.begin_ns);
        render_into(slot);
        notify_watcher(slot);
        if (slot.ends_order) settings_.order_done();
        if (script_) script_->seen();
        rendered_.release();
    }
    settings_.close();
    finished_.store(true);
    stopping_.store(true);
    rendered_.release();
}

// Waits for the next frame's begin and says what it depends on; false when there is none.
bool FrameLoop::begin(Slot& slot) {
    if (script_) {
        if (!script_->next(stopping_, slot.use, slot.not_before_ns)) return false;
    } else {
        FrameStarter::Start start;
        if (!starter_.next(slot.next_exposure_s, stopping_, start)) return false;
        take_settings(start, slot);
    }
    use_level(slot.use.quality_level);
    take_light(slot.use);
    last_id_ = slot.use.id;
    counters_.deadline_misses.fetch_add(slot.use.skipped + (slot.use.late ? 1 : 0),
                                        std::memory_order_relaxed);
    return true;
}

void FrameLoop::take_settings(const FrameStarter::Start& start, Slot& slot) {
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
    use.quality_level = choose_level(slot, use.id);
    faults_.begin(use.id);
    use.faults = frame_faults(faults_, use.id);
    use.image = image_faults(faults_, use.id);
    slot.use = use;
    place_in_time(start, slot);
    slot.automatic = s.automatic_exposure;
    slot.ends_order = start.ends_order;
}

// What a frame depends on, from here on its own.
void FrameLoop::latch(Slot& slot) {
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
    record.quality_level = use.quality_level;
    record.reverse_x = use.reverse_x, record.reverse_y = use.reverse_y;
    record.faults = use.faults;
    record.exposure_mid_monotonic_ns = use.middle_ns;
    record.exposure_mid = use.exposure_mid;
    slot.exposure = {use.exposure_s, use.gain_db, use.black_level_dn, use.binning_x, use.binning_y, {}, {}};
    if (use.faults & kTimeStandsBit) counters_.standing.fetch_add(1, std::memory_order_relaxed);
    if (use.faults & kPosesStaleBit) counters_.stale.fetch_add(1, std::memory_order_relaxed);
}

// A frame's instants, and what it shows of the world's time: all of its exposure, part of it when time stops
// on the way, or one instant.
void FrameLoop::place_in_time(const FrameStarter::Start& start, Slot& slot) {
    FrameUse& use = slot.use;
    const std::int64_t middle_ns = to_ns(timing_.middle_s(use.exposure_s));
    const std::int64_t length_ns = to_ns(timing_.end_s(use.exposure_s));
    slot.middle_camera_ns = start.camera_ns + middle_ns;
    slot.end_camera_ns = start.camera_ns + length_ns;
    slot.until_end = start.until_end;
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

// How long the slot's last frame kept the next one waiting.
double FrameLoop::frame_ms(const Slot& slot) const {
    const std::int64_t ns = limits_.prefer == LoopPreference::kLatency
                                ? slot.render_ns + slot.sense_ns
                                : std::max(slot.render_ns, slot.sense_ns);
    return static_cast<double>(ns) * 1e-6;
}

std::uint32_t FrameLoop::choose_level(const Slot& slot, std::uint64_t frame) {
    const std::size_t before = governor_.level();
    std::size_t now = before;
    if (slot.render_ns > 0) now = governor_.take(slot.use.quality_level, frame_ms(slot));
    if (now != before) level_changes_.push({frame, before, now, governor_.mean_ms(before)});
    return static_cast<std::uint32_t>(now);
}

void FrameLoop::use_level(std::uint32_t level) {
    if (level != level_) {
        counters_.level_changes.fetch_add(1, std::memory_order_relaxed);
        exposures_.use_level(level);
    }
    level_ = level;
    counters_.level.store(level, std::memory_order_relaxed);
    counters_.frames_at_level[level].fetch_add(1, std::memory_order_relaxed);
}

void FrameLoop::take_light(FrameUse& use) {
    const bool lacks = !exposures_.take_light();
    counters_.lacks_light.store(lacks, std::memory_order_relaxed);
    if (!lacks) return;
    use.faults |= kNoKeptLightBit;
    counters_.without_light.fetch_add(1, std::memory_order_relaxed);
    counters_.last_without_light.store(use.id, std::memory_order_relaxed);
}

void FrameLoop::notify(CameraEvent::Kind kind, std::uint64_t frame, std::int64_t monotonic_ns) const {
    for (FrameSink* sink : sinks_) sink->happened({kind, frame, monotonic_ns});
}

void FrameLoop::render_into(Slot& slot) {
    const std::int64_t begun_ns = monotonic_ns();
    FrameRecord& record = slot.record;
    if (slot.use.shutter_closed) {
        exposures_.keep_dark(slot.radiance, slot.points, slot.exposure);
        slot.beside.clear();
        slot.render_ns = 0;  // says nothing of what frames cost
        return;
    }
    if (const std::uint64_t flagged = poses_ && !script_ ? poses_->flagged() : 0; flagged != flagged_) {
        slot.use.faults |= kTagsWentBackBit;
        record.faults = slot.use.faults;
        flagged_ = flagged;
    }
    FrameTruth* const truth = truth_ ? truth_->begin(record) : nullptr;
    record.has_truth = truth != nullptr;
    const ShownWorld moment{slot.use.shown_at, slot.use.moving};
    const ExposureRenderer::Result result = exposures_.render(
        world_, moment, {seed_, record.id}, slot.radiance, slot.points, slot.exposure, truth);
    exposures_.look_beside(slot.beside);
    const ShownCommand& shown = result.shown;
    record.camera = exposures_.middle_world().camera;
    record.pose_sequence = shown.sequence;
    record.pose_time = shown.time;
    // Latency is that of a command in the first frame that shows it.
    record.command_arrival_monotonic_ns =
        !script_ && shown.arrival_monotonic_ns > shown_arrival_ns_ ? shown.arrival_monotonic_ns : 0;
    shown_arrival_ns_ = std::max(shown_arrival_ns_, shown.arrival_monotonic_ns);
    if (recorder_) world_.shown_numbers(slot.shown_numbers);

    stats_ = result.stats;
    if (result.parts_limited) counters_.motion_limited.fetch_add(1, std::memory_order_relaxed);
    meters_.setup.record(from_ms(stats_.setup_ms));
    meters_.trace.record(from_ms(stats_.trace_ms));
    meters_.stars.record(from_ms(stats_.points_ms));
    count_budget();
    slot.render_ns = monotonic_ns() - begun_ns;
    meters_.render.record(slot.render_ns);
}

void FrameLoop::count_budget() {
    if (stats_.lit_px == 0) return counters_.within_budget.store(1, std::memory_order_relaxed);
    counters_.lit_px.fetch_add(stats_.lit_px, std::memory_order_relaxed);
    counters_.within_budget_px.fetch_add(stats_.within_budget_px, std::memory_order_relaxed);
    const double share = static_cast<double>(stats_.within_budget_px) / static_cast<double>(stats_.lit_px);
    counters_.within_budget.store(share, std::memory_order_relaxed);
    // One writer.
    if (share < counters_.worst_within_budget.load(std::memory_order_relaxed))
        counters_.worst_within_budget.store(share, std::memory_order_relaxed);
}

void FrameLoop::notify_watcher(const Slot& slot) {
    const FrameUse& use = slot.use;
    if (watcher_)
        watcher_->seen({use.id, use.begin_ns, use.exposure_mid, use.exposure_s, use.shutter_closed},
                       exposures_.middle_world());
}

// --- stage 2
// -------------------------------------------------------------------------------------------------------

void FrameLoop::sense_frames() {
    for (std::size_t turn = 0;; ++turn) {
        rendered_.acquire();
        Slot& slot = slots_[turn % slots_.size()];
        if (slot.record.id == 0) return;  // the last release comes without a frame
        sense(slot);
        slot.record.id = 0;
        free_.release();
    }
}

void FrameLoop::sense(Slot& slot) {
    const std::int64_t begun_ns = monotonic_ns();
    const auto [width, height] = frame_size(camera_, slot.exposure.binning_x, slot.exposure.binning_y);
    frame_.reshape(width, height);
    chain_.expose(slot.radiance, slot.points, slot.exposure, electrons_, slot.beside);
    chain_.digitise(electrons_, slot.exposure, {seed_, slot.record.id}, frame_);
    slot.next_exposure_s = 0;
    if (slot.automatic) measure_exposure(slot);
    const SensorTimes& times = chain_.times();
    meters_.collapse.record(from_ms(times.collapse_ms));
    meters_.convolve.record(from_ms(times.convolve_ms));
    meters_.points.record(from_ms(times.points_ms));
    meters_.digitise.record(from_ms(times.digitise_ms));
    finish_picture(slot);
    const std::uint64_t flipped = strike_image(slot.use.image, slot.record, seed_, before_, frame_);
    if (flipped > 0) faults_.count(FaultKind::kImageBitFlips, slot.record.id, flipped, 0);
    slot.sense_ns = monotonic_ns() - begun_ns;
    meters_.sense.record(slot.sense_ns);

    wait_to_publish(slot);
    if (!script_) know_machine_times(slot);
    if (recorder_) keep(slot);
    notify(CameraEvent::Kind::kExposureEnd, slot.record.id, slot.use.end_ns);
    const std::int64_t publish_ns = monotonic_ns();
    for (FrameSink* sink : sinks_) sink->publish(frame_, slot.record);
    std::swap(frame_, before_);
    const std::int64_t done_ns = monotonic_ns();
    meters_.publish.record(done_ns - publish_ns);
    slot.sense_ns += done_ns - publish_ns;
    meters_.work.record(slot.render_ns + slot.sense_ns);
    if (slot.record.command_arrival_monotonic_ns != 0)
        meters_.latency.record(done_ns - slot.record.command_arrival_monotonic_ns);
    if (last_published_ns_ != 0) meters_.interval.record(done_ns - last_published_ns_);
    last_published_ns_ = done_ns;
    counters_.last_id.store(slot.record.id, std::memory_order_relaxed);
    if (counters_.frames.fetch_add(1, std::memory_order_relaxed) + 1 == limits_.warm_up) {
        meters_.clear();
        warm_processor_ns_ = processor_ns();
    }
}

// When the exposure was, on the machine's clock: the scale of time may have changed since it began.
void FrameLoop::know_machine_times(Slot& slot) const {
    slot.use.middle_ns = clock_.monotonic_of_camera(slot.middle_camera_ns);
    slot.use.end_ns = clock_.monotonic_of_camera(slot.end_camera_ns);
    slot.record.exposure_mid_monotonic_ns = slot.use.middle_ns;
}

// What the frame shows of commands, where that has changed, then the frame.
void FrameLoop::keep(const Slot& slot) {
    for (std::size_t i = 0; i < recorded_shown_.size() && !slot.use.shutter_closed; ++i) {
        const std::uint64_t number = slot.shown_numbers[i];
        if (number == recorded_shown_[i]) continue;
        recorded_shown_[i] = number;
        recorder_->keep_shown(recorded_camera_, static_cast<std::uint32_t>(i), number);
    }
    recorder_->keep_frame(recorded_camera_, slot.use);
}

// What a camera does with its numbers on their way out.
void FrameLoop::finish_picture(const Slot& slot) {
    draw_test_pattern(slot.use.test_pattern, slot.record.bits, slot.record.id, frame_);
    if (slot.use.reverse_x)
        for (int y = 0; y < frame_.height(); ++y) std::reverse(frame_.row(y).begin(), frame_.row(y).end());
    if (slot.use.reverse_y)
        for (int y = 0; y < frame_.height() / 2; ++y)
            std::swap_ranges(frame_.row(y).begin(), frame_.row(y).end(),
                             frame_.row(frame_.height() - 1 - y).begin());
}

// Not before the exposure is over; in lockstep and in a replay not before every output has room, as no frame
// may be lost, the last ones of a run as little as the others.
void FrameLoop::wait_to_publish(const Slot& slot) const {
    const auto go_on = [&] { return !stopping_.load(std::memory_order_relaxed); };
    while (monotonic_ns() < slot.not_before_ns && go_on())
        sleep_until_monotonic_ns(std::min(slot.not_before_ns, monotonic_ns() + kLongestSleep_ns));
    for (std::int64_t now_ns = monotonic_ns();
         slot.until_end && clock_.camera_at(now_ns) < slot.end_camera_ns && go_on(); now_ns = monotonic_ns())
        sleep_until_monotonic_ns(std::min(clock_.when_due(slot.end_camera_ns), now_ns + kLongestSleep_ns));
    if (!lockstep_ && !script_) return;
    constexpr std::int64_t kPoll_ns = 200'000, kPatience_ns = 10'000'000'000;
    const std::int64_t until_ns = monotonic_ns() + kPatience_ns;
    const auto room = [](const FrameSink* sink) { return sink->has_room(); };
    while (!std::all_of(sinks_.begin(), sinks_.end(), room) && monotonic_ns() < until_ns)
        sleep_until_monotonic_ns(monotonic_ns() + kPoll_ns);
}

void FrameLoop::measure_exposure(Slot& slot) {
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

}  // namespace hilcam
