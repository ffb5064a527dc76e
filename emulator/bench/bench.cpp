#include "emulator/bench/bench.h"

#include <algorithm>
#include <atomic>
#include <optional>

#include "emulator/bench/pilot.h"
#include "emulator/progress/progress.h"
#include "emulator/run/emulator.h"
#include "render/vocabulary/median.h"

namespace hilcam {
namespace {

struct Run {
    double rate_hz, p50_ms, p99_ms, core_ms, ahead_core_ms;
    StageTimes stages;
    Percentiles latency;
    RenderStats render;
    BenchFloor floor;
    std::size_t triangles;
    std::vector<PathModelSpeed> path_models;
};

// Returns the world at nine places of the circle, beginning at its start; without a circle, the scenario's
// own world.
std::vector<WorldSnapshot> around(Emulator& emulator, const std::optional<CircleFlight>& flight) {
    std::vector<WorldSnapshot> out(9);
    for (std::size_t i = 0; i < out.size(); ++i) {
        const std::int64_t now_ns = monotonic_ns();
        const TimeTai now = emulator.clock().at(now_ns);
        if (flight) {
            const double seconds =
                flight->period_s * static_cast<double>(i) / static_cast<double>(out.size());
            emulator.world().set(0, flight->at(seconds, now), {0, now_ns});
        }
        out[i].objects.resize(emulator.world().placed_objects());
        ShownCommand shown;
        emulator.world().sample(now, out[i], shown);
    }
    return out;
}

double copy_ms(const ScenarioConfig& scenario) {
    const auto [width, height] = frame_size(scenario.camera);
    const DnImage from(width, height);
    DnImage to(from.width(), from.height());
    std::vector<double> times;
    for (int i = 0; i < 9; ++i) {
        const std::int64_t start = monotonic_ns();
        std::copy(from.all().begin(), from.all().end(), to.all().begin());
        times.push_back(static_cast<double>(monotonic_ns() - start) * 1e-6);
    }
    return median(times);
}

// share: receives the finished share of this run during the run.
Run run_once(const ScenarioConfig& scenario, const BenchOptions& options, std::atomic<double>& share) {
    constexpr std::uint64_t kWarmUp = 20;
    RunLimits limits;
    limits.frames = kWarmUp + options.frames;
    limits.warm_up = kWarmUp;
    limits.paced = false;
    limits.outputs = false;
    Emulator emulator(scenario, limits);
    const std::optional<CircleFlight> flight = flight_of_pilot(scenario);
    {
        const auto frames = static_cast<double>(limits.frames);
        const Progress progress("frames", frames, [&emulator, &share, frames] {
            const auto done = static_cast<double>(emulator.loop().counters().frames.load());
            share.store(std::min(1.0, done / frames));
            return done;
        });
        // One round takes exactly the frames of a run, so every run sees the same views, however fast it is.
        const double seconds_per_frame = flight ? flight->period_s / static_cast<double>(limits.frames) : 0;
        std::optional<Pilot> pilot;
        if (flight)
            pilot.emplace(emulator, *flight, [&emulator, seconds_per_frame](std::int64_t) {
                return seconds_per_frame * static_cast<double>(emulator.loop().counters().frames.load());
            });
        emulator.run([] {});
    }
    const auto now = FrameLoop::ProcessorTime::now(), warm = emulator.loop().warm_processor_time();
    const double ms_per_frame = 1e-6 / static_cast<double>(options.frames);
    Run run;
    run.ahead_core_ms = ms_per_frame * static_cast<double>(now.ahead_ns - warm.ahead_ns);
    run.core_ms = ms_per_frame * static_cast<double>(now.all_ns - warm.all_ns) - run.ahead_core_ms;
    const StageMeters& meters = emulator.loop().meters();
    run.p50_ms = meters.interval.quantile_ms(0.5);
    run.p99_ms = meters.interval.quantile_ms(0.99);
    run.rate_hz = static_cast<double>(limits.frames) / emulator.seconds();
    run.stages = stage_times(meters);
    run.latency = percentiles_of(meters.latency);
    run.render = emulator.loop().render_stats();
    const std::vector<WorldSnapshot> snapshots = around(emulator, flight);
    std::vector<double> floor, fft;
    for (const WorldSnapshot& snapshot : snapshots) {
        floor.push_back(emulator.renderer().floor_ms(snapshot));
        fft.push_back(emulator.chain().fft_pair_ms());
    }
    run.floor = {median(floor), median(fft), copy_ms(scenario)};
    run.triangles = emulator.renderer().triangles();
    if (options.path_models)
        run.path_models = emulator.renderer().path_model_speeds(snapshots.front(), Modules(), 5);
    return run;
}

// Returns the median of figure(run) over the runs.
template <class Figure>
double median_of(const std::vector<Run>& runs, const Figure& figure) {
    std::vector<double> values;
    values.reserve(runs.size());
    for (const Run& run : runs) values.push_back(figure(run));
    return median(values);
}

template <class Figure>
Percentiles median_percentiles(const std::vector<Run>& runs, const Figure& figure) {
    Percentiles out;
    for (double Percentiles::*part :
         {&Percentiles::p50_ms, &Percentiles::p99_ms, &Percentiles::p999_ms, &Percentiles::max_ms})
        out.*part = median_of(runs, [&](const Run& run) { return figure(run).*part; });
    return out;
}

Bench over_runs(const std::vector<Run>& runs) {
    Bench out;
    const Run& last = runs.back();
    out.triangles = last.triangles;
    out.rendered = last.render;
    out.frame_rate_hz = median_of(runs, [](const Run& r) { return r.rate_hz; });
    out.p50_ms = median_of(runs, [](const Run& r) { return r.p50_ms; });
    out.p99_ms = median_of(runs, [](const Run& r) { return r.p99_ms; });
    for (const Run& run : runs) out.runs_p50_ms.push_back(run.p50_ms);
    out.core_ms_per_frame = median_of(runs, [](const Run& r) { return r.core_ms; });
    out.ahead_core_ms_per_frame = median_of(runs, [](const Run& r) { return r.ahead_core_ms; });
    for (const auto& entry : last.stages)
        out.stages[entry.first] =
            median_percentiles(runs, [&](const Run& r) { return r.stages.at(entry.first); });
    out.latency = median_percentiles(runs, [](const Run& r) { return r.latency; });
    out.floor = {median_of(runs, [](const Run& r) { return r.floor.embree_ms; }),
                 median_of(runs, [](const Run& r) { return r.floor.fft_pair_ms; }),
                 median_of(runs, [](const Run& r) { return r.floor.copy_ms; })};
    out.path_models = last.path_models;
    return out;
}

}  // namespace

double Bench::spread_of_runs() const {
    const auto [least, most] = std::minmax_element(runs_p50_ms.begin(), runs_p50_ms.end());
    return runs_p50_ms.empty() ? 0 : *most / *least - 1;
}

Bench bench(const ScenarioConfig& scenario, const BenchOptions& options) {
    return bench_variants({{scenario.name, scenario}}, options).front().bench;
}

std::vector<BenchVariant> bench_variants(const std::vector<NamedScenario>& scenarios,
                                         const BenchOptions& options) {
    std::vector<std::vector<Run>> runs(scenarios.size());
    std::atomic<double> done{0}, share{0};
    const double all = static_cast<double>(scenarios.size()) * options.runs;
    const Progress progress("bench", all, [&done, &share] { return done + share; });
    for (int i = 0; i < options.runs; ++i)
        for (std::size_t k = 0; k < scenarios.size(); ++k) {
            runs[k].push_back(run_once(scenarios[k].scenario, options, share));
            share = 0;
            done = done + 1;
        }
    std::vector<BenchVariant> out;
    for (std::size_t k = 0; k < scenarios.size(); ++k) {
        BenchVariant variant{scenarios[k].name, over_runs(runs[k])};
        const ScenarioConfig& scenario = scenarios[k].scenario;
        variant.bench.scenario = scenario.name;
        variant.bench.width_px = scenario.camera.width_px,
        variant.bench.height_px = scenario.camera.height_px;
        variant.bench.options = options;
        std::vector<double> ratios;
        for (std::size_t i = 0; i < runs[k].size(); ++i)
            ratios.push_back(runs[k][i].core_ms / runs[0][i].core_ms);
        variant.ratio = median(ratios);
        const auto [least, most] = std::minmax_element(ratios.begin(), ratios.end());
        variant.least_ratio = *least, variant.most_ratio = *most;
        out.push_back(std::move(variant));
    }
    return out;
}

}  // namespace hilcam
