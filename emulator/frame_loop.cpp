#include "emulator/frame_loop.h"

#include <algorithm>
#include <cmath>

namespace hilcam {
namespace {

constexpr std::int64_t kLongestSleep_ns = 50'000'000;  // how long a stop may have to wait

std::int64_t to_ns(double seconds) { return static_cast<std::int64_t>(std::llround(seconds * 1e9)); }
std::int64_t from_ms(double ms) { return static_cast<std::int64_t>(ms * 1e6); }

}  // namespace

FrameLoop::FrameLoop(Renderer& renderer, SensorChain& chain, const SpectralGrid& grid,
                     const CameraModel& camera, WorldState& world, LiveSettings& settings,
                     const SimulatedClock& clock, std::vector<FrameSink*> sinks, std::uint64_t seed,
                     const LoopLimits& limits)
    : renderer_(renderer),
      chain_(chain),
      bits_(camera.frame_bits()),
      world_(world),
      settings_(settings),
      clock_(clock),
      sinks_(std::move(sinks)),
      seed_(seed),
      limits_(limits) {
    const ImageGeometry& g = renderer.geometry();
    for (Slot& slot : slots_) {
        slot.radiance = RadianceImage(g.padded_width(), g.padded_height(), grid.size());
        slot.points.reserve(renderer.most_points());
    }
    snapshot_.objects.resize(world.placed_objects());
    const auto [array_width, array_height] = array_size(camera);
    electrons_ = ElectronImage(array_width, array_height);
    const auto [width, height] = frame_size(camera);
    frame_ = DnImage(width, height);
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
        CameraSettings settings;
        const bool enough = limits_.frames != 0 && turn >= limits_.frames;
        if (enough || !wait_for_exposure(schedule, record, start_ns, settings)) break;
        Slot& slot = slots_[turn % slots_.size()];
        slot.record = record;
        render_into(slot, start_ns, settings);
        rendered_.release();
    }
    finished_.store(true);
    stopping_.store(true);
    rendered_.release();
}

// False when the loop ends. Also idles while the camera is stopped.
bool FrameLoop::wait_for_exposure(FrameSchedule& schedule, FrameRecord& record, std::int64_t& start_ns,
                                  CameraSettings& settings) {
    bool idle = false;
    while (true) {
        if (stopping_.load(std::memory_order_relaxed)) return false;
        settings = settings_.read_in_loop();
        if (settings.running) break;
        idle = true;
        sleep_until_monotonic_ns(monotonic_now_ns() + 5'000'000);
    }
    if (!limits_.paced) {
        start_ns = monotonic_now_ns();
        ++record.id;
        return true;
    }
    if (idle) schedule.restart(monotonic_now_ns());
    const std::int64_t period_ns = to_ns(std::max(1 / settings.frame_rate_hz, settings.exposure_s));
    const FrameSchedule::Slot due = schedule.take(monotonic_now_ns(), period_ns);
    counters_.deadline_misses.fetch_add(due.skipped, std::memory_order_relaxed);
    record.id += 1 + due.skipped;
    start_ns = due.start_ns;
    while (monotonic_now_ns() < start_ns) {
        if (stopping_.load(std::memory_order_relaxed)) return false;
        sleep_until_monotonic_ns(std::min(start_ns, monotonic_now_ns() + kLongestSleep_ns));
    }
    return true;
}

void FrameLoop::render_into(Slot& slot, std::int64_t start_ns, const CameraSettings& settings) {
    const std::int64_t begun_ns = monotonic_now_ns();
    FrameRecord& record = slot.record;
    record.exposure_s = settings.exposure_s;
    record.gain_db = settings.gain_db;
    record.bits = bits_;
    record.exposure_mid_monotonic_ns = start_ns + to_ns(settings.exposure_s) / 2;
    record.exposure_mid = clock_.at(record.exposure_mid_monotonic_ns);
    slot.exposure_end_ns = limits_.paced ? start_ns + to_ns(settings.exposure_s) : 0;

    ShownCommand shown;
    world_.sample(record.exposure_mid, snapshot_, shown);
    record.pose_sequence = shown.sequence;
    // Latency is that of a command in the first frame that shows it.
    record.command_arrival_monotonic_ns =
        shown.arrival_monotonic_ns > shown_arrival_ns_ ? shown.arrival_monotonic_ns : 0;
    shown_arrival_ns_ = std::max(shown_arrival_ns_, shown.arrival_monotonic_ns);

    renderer_.render(snapshot_, {seed_, record.id}, slot.radiance, slot.points, stats_);
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
    const Exposure exposure{slot.record.exposure_s, slot.record.gain_db, {}, {}};
    chain_.expose(slot.radiance, slot.points, exposure, electrons_);
    chain_.digitise(electrons_, exposure, {seed_, slot.record.id}, frame_);
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

}  // namespace hilcam
