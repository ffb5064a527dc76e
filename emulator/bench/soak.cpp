#include "emulator/bench/soak.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "emulator/bench/pilot.h"
#include "emulator/progress/progress.h"
#include "emulator/run/emulator.h"
#include "io/system/resident_memory.h"

namespace hilcam {
namespace {

// All counters of a run at an instant.
struct Snapshot {
    std::int64_t monotonic_ns = 0;
    std::uint64_t frames = 0, deadline_misses = 0;
    DurationHistogram::Counts work{}, interval{}, latency{};

    void read(const FrameLoop& loop) {
        monotonic_ns = hilcam::monotonic_ns();
        frames = loop.counters().frames.load();
        deadline_misses = loop.counters().deadline_misses.load();
        loop.meters().work.read(work);
        loop.meters().interval.read(interval);
        loop.meters().latency.read(latency);
    }
};

SoakPercentiles percentiles(const DurationHistogram::Counts& from, DurationHistogram::Counts to) {
    for (std::size_t i = 0; i < to.size(); ++i) to[i] -= from[i];
    const auto quantile = [&](double q) { return DurationHistogram::quantile_ms(to, q); };
    return {quantile(0.5), quantile(0.99), quantile(0.999), quantile(1)};
}

SoakSlice slice_between(const Snapshot& from, const Snapshot& to, std::int64_t start_ns, double memory_mb) {
    SoakSlice slice;
    slice.start_s = static_cast<double>(from.monotonic_ns - start_ns) * 1e-9;
    slice.length_s = static_cast<double>(to.monotonic_ns - from.monotonic_ns) * 1e-9;
    slice.frames = to.frames - from.frames;
    slice.deadline_misses = to.deadline_misses - from.deadline_misses;
    slice.memory_mb = memory_mb;
    slice.work = percentiles(from.work, to.work);
    slice.interval = percentiles(from.interval, to.interval);
    slice.latency = percentiles(from.latency, to.latency);
    return slice;
}

// Records the slices from an instant on, in its own thread.
class SliceWatch {
  public:
    SliceWatch(const FrameLoop& loop, std::int64_t start_ns, double slice_s, std::vector<SoakSlice>& slices)
        : loop_(loop),
          start_ns_(start_ns),
          slice_ns_(static_cast<std::int64_t>(slice_s * 1e9)),
          slices_(slices) {
        thread_ = std::thread([this] { watch(); });
    }
    ~SliceWatch() { stop(); }
    void stop() {
        stop_.store(true);
        if (thread_.joinable()) thread_.join();
    }

    // Call after stop().
    std::size_t finished() const { return finished_; }
    SoakSlice whole() const {
        return slice_between(first_, before_, start_ns_, slices_[finished_ - 1].memory_mb);
    }

  private:
    void watch() {
        if (!sleep_until(start_ns_)) return;
        first_.read(loop_);
        before_ = first_;
        for (; finished_ < slices_.size(); ++finished_) {
            if (!sleep_until(start_ns_ + static_cast<std::int64_t>(finished_ + 1) * slice_ns_)) return;
            now_.read(loop_);
            slices_[finished_] = slice_between(before_, now_, start_ns_, memory_.megabytes());
            before_ = now_;
        }
    }
    bool sleep_until(std::int64_t ns) const {
        constexpr std::int64_t kLongestSleep_ns = 50'000'000;  // the longest that a stop may have to wait
        while (!stop_.load() && monotonic_ns() < ns)
            sleep_until_monotonic_ns(std::min(ns, monotonic_ns() + kLongestSleep_ns));
        return !stop_.load();
    }

    const FrameLoop& loop_;
    std::int64_t start_ns_, slice_ns_;
    std::vector<SoakSlice>& slices_;
    std::size_t finished_ = 0;
    ResidentMemory memory_;
    Snapshot first_, before_, now_;
    std::atomic<bool> stop_{false};
    std::thread thread_;
};

// Returns the number of slices, which have equal lengths.
std::size_t slices_of(const SoakOptions& options) {
    const double wanted_s = options.slice_s > 0 ? options.slice_s : std::max(10.0, options.seconds / 60);
    return static_cast<std::size_t>(
        std::clamp(std::floor(options.seconds / wanted_s + 1e-9), 1.0, SoakOptions::kMaxSlices));
}

SoakCourse course(const std::vector<SoakSlice>& slices, double (*figure)(const SoakSlice&)) {
    if (slices.empty()) return {};
    std::vector<double> values;
    values.reserve(slices.size());
    for (const SoakSlice& slice : slices) values.push_back(figure(slice));
    const Trend trend = trend_of(values);
    const auto steps = static_cast<double>(values.size() - 1);
    return {values.front(), values.back(), trend.per_step * 3600 / slices.front().length_s,
            trend.per_step * steps, trend.sigma};
}

bool steady(const SoakCourse& c) {
    return std::abs(c.sigma) < kSignificant_sigma ||
           std::abs(c.growth) <= SoakVerdict::kSteady_fraction * c.first;
}

}  // namespace

Soak soak(const ScenarioConfig& configured, const SoakOptions& options) {
    ScenarioConfig scenario = configured;
    scenario.mode = CameraMode::kFreeRun;
    require_timed_output(scenario.loop.fail_on, options.outputs && have_live(scenario.outputs));
    Soak soak;
    soak.slices.resize(slices_of(options));
    soak.slice_s = options.seconds / static_cast<double>(soak.slices.size());
    soak.round_s = soak.slice_s / std::max(1.0, std::round(soak.slice_s / 60));

    RunLimits limits;
    limits.outputs = options.outputs;
    // The watch ends with its slices; the run lasts one second longer in case the watch is late.
    limits.seconds = soak.round_s + options.seconds + 1;
    Emulator emulator(scenario, limits);
    std::optional<CircleFlight> flight = flight_of_pilot(scenario);
    if (flight) flight->period_s = soak.round_s;
    std::optional<SliceWatch> watch;
    {
        std::optional<Pilot> pilot;
        const std::int64_t begun_ns = monotonic_ns();
        const Progress progress("soak", limits.seconds,
                                [begun_ns] { return static_cast<double>(monotonic_ns() - begun_ns) * 1e-9; });
        emulator.run([&] {
            const std::int64_t ready_ns = monotonic_ns();
            if (flight)
                pilot.emplace(emulator, *flight, [ready_ns](std::int64_t ns) {
                    return static_cast<double>(ns - ready_ns) * 1e-9;
                });
            watch.emplace(emulator.loop(), ready_ns + static_cast<std::int64_t>(soak.round_s * 1e9),
                          soak.slice_s, soak.slices);
        });
    }
    watch->stop();
    soak.slices.resize(watch->finished());
    if (!soak.slices.empty()) soak.whole = watch->whole();
    soak.triangles = emulator.renderer().triangles();
    soak.broken = broken_bounds(emulator.stations());
    return soak;
}

SoakVerdict judge(const Soak& soak) {
    SoakVerdict v;
    v.memory_mb = course(soak.slices, [](const SoakSlice& s) { return s.memory_mb; });
    v.latency_p50_ms = course(soak.slices, [](const SoakSlice& s) { return s.latency.p50_ms; });
    v.latency_p99_ms = course(soak.slices, [](const SoakSlice& s) { return s.latency.p99_ms; });
    v.enough = soak.slices.size() >= kMinForTrend;
    v.memory_flat =
        std::max(v.memory_mb.growth, v.memory_mb.last - v.memory_mb.first) <= SoakVerdict::kFlat_mb;
    v.latency_steady = steady(v.latency_p50_ms) && steady(v.latency_p99_ms);
    return v;
}

}  // namespace hilcam
