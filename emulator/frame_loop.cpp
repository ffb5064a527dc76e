#include "emulator/frame_loop.h"

#include <algorithm>
#include <cmath>

namespace hilcam {
namespace {

constexpr std::int64_t kLongestSleep_ns = 50'000'000;  // how long a stop may have to wait

std::int64_t to_ns(double seconds) { return static_cast<std::int64_t>(std::llround(seconds * 1e9)); }
std::int64_t from_ms(double ms) { return static_cast<std::int64_t>(ms * 1e6); }

}  // namespace

FrameLoop::FrameLoop(ExposureRenderer& exposures, SensorChain& chain, const CameraModel& camera,
                     WorldState& world, LiveSettings& settings, const SimulatedClock& clock,
                     std::vector<FrameSink*> sinks, std::uint64_t seed, const LoopLimits& limits)
    : exposures_(exposures),
      chain_(chain),
      camera_(camera),
      timing_(camera),
      world_(world),
      settings_(settings),
      clock_(clock),
      sinks_(std::move(sinks)),
      seed_(seed),
      limits_(limits) {
    for (const SettingsStep& step : camera.sequence)
        longest_step_s_ = std::max(longest_step_s_, step.exposure_s);
    for (Slot& slot : slots_) {
        slot.radiance = exposures.make_image();
        slot.points.reserve(exposures.most_points());
    }
    const auto [array_width, array_height] = array_size(camera);
    electrons_ = ElectronImage(array_width, array_height);
    const auto [width, height] = frame_size(camera);
    frame_ = DnImage(width, height);
    if (camera.auto_exposure.on) histogram_ = FrameHistogram(camera.frame_bits());
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
    FrameSchedule schedule(monotonic_now_ns());
    FrameRecord record;
    for (std::size_t turn = 0;; ++turn) {
        free_.acquire();
        std::int64_t start_ns = 0;
        const bool enough = limits_.frames != 0 && turn >= limits_.frames;
        Slot& slot = slots_[turn % slots_.size()];
        if (enough || !wait_for_exposure(schedule, slot, record, start_ns)) break;
        slot.record = record;
        render_into(slot, start_ns);
        rendered_.release();
    }
    finished_.store(true);
    stopping_.store(true);
    rendered_.release();
}

// False when the loop ends. Also idles while the camera is stopped.
bool FrameLoop::wait_for_start(FrameSchedule& schedule, CameraSettings& settings) {
    bool idle = false;
    while (true) {
        if (stopping_.load(std::memory_order_relaxed)) return false;
        settings = settings_.read_in_loop();
        if (settings.running) break;
        idle = true;
        sleep_until_monotonic_ns(monotonic_now_ns() + 5'000'000);
    }
    if (idle) schedule.restart(monotonic_now_ns());
    return true;
}

// Waits for the next frame's begin; its id, exposure and gain go into the record. False when the loop ends.
bool FrameLoop::wait_for_exposure(FrameSchedule& schedule, const Slot& slot, FrameRecord& record,
                                  std::int64_t& start_ns) {
    CameraSettings settings;
    if (!wait_for_start(schedule, settings)) return false;
    record.exposure_s = slot.next_exposure_s > 0 ? slot.next_exposure_s : settings.exposure_s;
    record.gain_db = settings.gain_db;
    start_ns = monotonic_now_ns();
    FrameSchedule::Slot due{start_ns, 0};
    if (limits_.paced)
        due = schedule.take(start_ns, to_ns(timing_.period_s(settings.frame_rate_hz,
                                                             std::max(record.exposure_s, longest_step_s_))));
    counters_.deadline_misses.fetch_add(due.skipped, std::memory_order_relaxed);
    record.id += 1 + due.skipped;
    if (!camera_.sequence.empty()) {
        const SettingsStep& step = camera_.sequence[(record.id - 1) % camera_.sequence.size()];
        record.exposure_s = step.exposure_s;
        record.gain_db = step.gain_db;
    }
    settings_.tell_own(record.exposure_s, record.gain_db);
    start_ns = due.start_ns;
    while (limits_.paced && monotonic_now_ns() < start_ns) {
        if (stopping_.load(std::memory_order_relaxed)) return false;
        sleep_until_monotonic_ns(std::min(start_ns, monotonic_now_ns() + kLongestSleep_ns));
    }
    return true;
}

void FrameLoop::render_into(Slot& slot, std::int64_t start_ns) {
    const std::int64_t begun_ns = monotonic_now_ns();
    FrameRecord& record = slot.record;
    record.bits = camera_.frame_bits();
    record.exposure_mid_monotonic_ns = start_ns + to_ns(timing_.middle_s(record.exposure_s));
    record.exposure_mid = clock_.at(record.exposure_mid_monotonic_ns);
    slot.exposure = {record.exposure_s, record.gain_db, {}, {}};
    slot.exposure_end_ns = limits_.paced ? start_ns + to_ns(timing_.end_s(record.exposure_s)) : 0;

    const ExposureRenderer::Result result = exposures_.render(world_, record.exposure_mid, {seed_, record.id},
                                                              slot.radiance, slot.points, slot.exposure);
    const ShownCommand& shown = result.shown;
    record.pose_sequence = shown.sequence;
    // Latency is that of a command in the first frame that shows it.
    record.command_arrival_monotonic_ns =
        shown.arrival_monotonic_ns > shown_arrival_ns_ ? shown.arrival_monotonic_ns : 0;
    shown_arrival_ns_ = std::max(shown_arrival_ns_, shown.arrival_monotonic_ns);

    stats_ = result.stats;
    if (result.parts_limited) counters_.motion_limited.fetch_add(1, std::memory_order_relaxed);
    meters_.setup.record(from_ms(stats_.setup_ms));
    meters_.trace.record(from_ms(stats_.trace_ms));
    meters_.stars.record(from_ms(stats_.points_ms));
    meters_.render.record(monotonic_now_ns() - begun_ns);
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
    const std::int64_t begun_ns = monotonic_now_ns();
    chain_.expose(slot.radiance, slot.points, slot.exposure, electrons_);
    chain_.digitise(electrons_, slot.exposure, {seed_, slot.record.id}, frame_);
    if (camera_.auto_exposure.on) measure_exposure(slot);
    const SensorTimes& times = chain_.times();
    meters_.collapse.record(from_ms(times.collapse_ms));
    meters_.convolve.record(from_ms(times.convolve_ms));
    meters_.points.record(from_ms(times.points_ms));
    meters_.digitise.record(from_ms(times.digitise_ms));
    meters_.sense.record(monotonic_now_ns() - begun_ns);

    while (monotonic_now_ns() < slot.exposure_end_ns && !stopping_.load(std::memory_order_relaxed))
        sleep_until_monotonic_ns(std::min(slot.exposure_end_ns, monotonic_now_ns() + kLongestSleep_ns));
    const std::int64_t publish_ns = monotonic_now_ns();
    for (FrameSink* sink : sinks_) sink->publish(frame_, slot.record);
    const std::int64_t done_ns = monotonic_now_ns();
    meters_.publish.record(done_ns - publish_ns);
    if (last_published_ns_ != 0) meters_.interval.record(done_ns - last_published_ns_);
    last_published_ns_ = done_ns;
    counters_.frames.fetch_add(1, std::memory_order_relaxed);
}

void FrameLoop::measure_exposure(Slot& slot) {
    const auto binned = [](std::int64_t black, std::int64_t binning) {
        return static_cast<int>((black + binning - 1) / binning);
    };
    const Brightness seen =
        histogram_.measure(frame_, binned(camera_.black_columns, camera_.binning_x),
                           binned(camera_.black_rows, camera_.binning_y), camera_.auto_exposure.percentile,
                           dn_scale_of(camera_, slot.exposure.gain_db));
    slot.next_exposure_s = next_exposure_s(camera_.auto_exposure, seen, slot.exposure.exposure_s,
                                           {camera_.exposure_range_s[0], camera_.exposure_range_s[1]});
}

}  // namespace hilcam
