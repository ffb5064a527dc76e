#include "emulator/bench/bench.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "emulator/bench/pilot.h"
#include "emulator/progress/progress.h"
#include "emulator/recording/machine_report.h"
#include "emulator/run/emulator.h"
#include "emulator/run/report.h"
#include "render/frame/render_bench.h"
#include "render/vocabulary/median.h"

namespace hilcam {
namespace {

using nlohmann::json;

struct Run {
    double rate_hz, p50_ms, p99_ms, core_ms;
    json stages, latency;
    RenderStats render;
    double floor_render_ms, fft_ms, copy_ms;
    std::size_t triangles;
    json path_models, within_budget;
};

// The world at nine places of the circle, the first one where it begins.
std::vector<WorldSnapshot> around(Emulator& emulator, const CircleFlight& flight) {
    std::vector<WorldSnapshot> out(9);
    for (std::size_t i = 0; i < out.size(); ++i) {
        const std::int64_t now_ns = monotonic_ns();
        const TimeTai now = emulator.clock().at(now_ns);
        const double seconds = flight.period_s * static_cast<double>(i) / static_cast<double>(out.size());
        emulator.world().set(0, flight.at(seconds, now), {0, now_ns});
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

json path_models(Renderer& renderer, const WorldSnapshot& world) {
    json out;
    for (const PathModelSpeed& speed : renderer.path_model_speeds(world, Modules(), 5)) {
        const auto rays = static_cast<double>(speed.rays);
        out[speed.name] = {{"rays", speed.rays},
                           {"frame_ms", speed.frame_ms},
                           {"mrays_s", rays / speed.frame_ms * 1e-3},
                           {"bare_mrays_s", rays / speed.bare_ms * 1e-3},
                           {"ratio_to_bare", speed.frame_ms / speed.bare_ms}};
    }
    return out;
}

Run run_once(const ScenarioConfig& scenario, const BenchOptions& options) {
    constexpr std::uint64_t kWarmUp = 20;
    RunLimits limits;
    limits.frames = kWarmUp + options.frames;
    limits.warm_up = kWarmUp;
    limits.paced = false;
    limits.outputs = false;
    Emulator emulator(scenario, limits);
    const CircleFlight flight = flight_around_target(scenario);
    {
        const Progress progress("frames", static_cast<double>(limits.frames), [&emulator] {
            return static_cast<double>(emulator.loop().counters().frames.load());
        });
        // Once round in the frames of a run, so that every run sees the same views however fast it is.
        const double seconds_per_frame = flight.period_s / static_cast<double>(limits.frames);
        const Pilot pilot(emulator, flight, [&emulator, seconds_per_frame](std::int64_t) {
            return seconds_per_frame * static_cast<double>(emulator.loop().counters().frames.load());
        });
        emulator.run([] {});
    }
    const std::int64_t processor = processor_ns() - emulator.loop().warm_processor_ns();
    Run run;
    run.core_ms = static_cast<double>(processor) * 1e-6 / static_cast<double>(options.frames);
    const StageMeters& meters = emulator.loop().meters();
    run.p50_ms = meters.interval.quantile_ms(0.5);
    run.p99_ms = meters.interval.quantile_ms(0.99);
    run.rate_hz = static_cast<double>(limits.frames) / emulator.seconds();
    run.stages = stages_report(meters);
    run.latency = percentiles_report(meters.latency);
    run.render = emulator.loop().render_stats();
    run.within_budget = within_budget(emulator.loop().counters());
    const std::vector<WorldSnapshot> snapshots = around(emulator, flight);
    std::vector<double> floor, fft;
    for (const WorldSnapshot& snapshot : snapshots) {
        floor.push_back(emulator.renderer().floor_ms(snapshot));
        fft.push_back(emulator.chain().fft_pair_ms());
    }
    run.floor_render_ms = median(floor);
    run.fft_ms = median(fft);
    run.copy_ms = copy_ms(scenario);
    run.triangles = emulator.renderer().triangles();
    if (options.path_models) run.path_models = path_models(emulator.renderer(), snapshots.front());
    return run;
}

// Of figures that each run has in an object of the same keys, at any depth.
json medians(const std::vector<json>& runs) {
    if (!runs.front().is_object()) {
        std::vector<double> values;
        for (const json& run : runs) values.push_back(run.get<double>());
        return median(values);
    }
    json out;
    for (const auto& [key, ignored] : runs.front().items()) {
        std::vector<json> parts;
        for (const json& run : runs) parts.push_back(run[key]);
        out[key] = medians(parts);
    }
    return out;
}

}  // namespace

json bench(const ScenarioConfig& scenario, const BenchOptions& options) {
    std::vector<Run> runs;
    Progress progress("bench", options.runs);
    for (int i = 0; i < options.runs; ++i) {
        runs.push_back(run_once(scenario, options));
        progress.done(i + 1);
    }
    const auto median_of = [&](auto member) {
        std::vector<double> values;
        for (const Run& run : runs) values.push_back(run.*member);
        return median(values);
    };
    const auto figures_of = [&](auto member) {
        std::vector<json> values;
        for (const Run& run : runs) values.push_back(run.*member);
        return values;
    };
    const double p50 = median_of(&Run::p50_ms);
    const double floor =
        median_of(&Run::floor_render_ms) + median_of(&Run::fft_ms) + median_of(&Run::copy_ms);
    const Run& last = runs.back();
    return {
        {"scenario", scenario.name},
        {"width", scenario.camera.width_px},
        {"height", scenario.camera.height_px},
        {"triangles", last.triangles},
        {"coverage", last.render.coverage},
        {"frame_rate_hz", median_of(&Run::rate_hz)},
        {"frame_ms",
         {{"p50", p50}, {"p99", median_of(&Run::p99_ms)}, {"runs_p50", figures_of(&Run::p50_ms)}}},
        {"core_ms_per_frame", median_of(&Run::core_ms)},
        {"stages_ms", medians(figures_of(&Run::stages))},
        {"latency_ms", medians(figures_of(&Run::latency))},
        {"floor_ms", floor},
        {"floor_parts_ms",
         {{"embree", median_of(&Run::floor_render_ms)},
          {"fft_pair", median_of(&Run::fft_ms)},
          {"copy", median_of(&Run::copy_ms)}}},
        {"ratio_to_floor", p50 / floor},
        {"rays",
         {{"primary", last.render.primary_rays},
          {"shadow", last.render.shadow_rays},
          {"bounce_shadow", last.render.bounce_shadow_rays},
          {"lamp", last.render.lamp_rays},
          {"path", last.render.secondary_rays}}},
        {"within_noise_budget", last.within_budget},
        {"path_models", last.path_models},
        {"runs", options.runs},
        {"frames_per_run", options.frames},
        {"machine", machine_report()},
    };
}

}  // namespace hilcam
