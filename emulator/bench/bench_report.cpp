#include "emulator/bench/bench_report.h"

#include <spdlog/fmt/fmt.h>

#include <nlohmann/json.hpp>

#include "emulator/recording/machine_report.h"

namespace hilcam {
namespace {

using nlohmann::json;

double mrays_s(const PathModelSpeed& s) { return static_cast<double>(s.rays) / s.frame_ms * 1e-3; }
double bare_mrays_s(const PathModelSpeed& s) { return static_cast<double>(s.rays) / s.bare_ms * 1e-3; }

// Puts the models' speeds in a map by name.
std::map<std::string, PathModelSpeed> by_name(const std::vector<PathModelSpeed>& speeds) {
    std::map<std::string, PathModelSpeed> out;
    for (const PathModelSpeed& speed : speeds) out[speed.name] = speed;
    return out;
}

json path_models_json(const std::vector<PathModelSpeed>& speeds) {
    json out;
    for (const PathModelSpeed& s : speeds)
        out[s.name] = {{"rays", s.rays},
                       {"frame_ms", s.frame_ms},
                       {"mrays_s", mrays_s(s)},
                       {"bare_mrays_s", bare_mrays_s(s)},
                       {"ratio_to_bare", s.frame_ms / s.bare_ms}};
    return out;
}

}  // namespace

// --- a scenario ---

json bench_json(const Bench& b) {
    return {
        {"scenario", b.scenario},
        {"width", b.width_px},
        {"height", b.height_px},
        {"triangles", b.triangles},
        {"coverage", b.rendered.coverage},
        {"frame_rate_hz", b.frame_rate_hz},
        {"frame_ms", {{"p50", b.p50_ms}, {"p99", b.p99_ms}, {"runs_p50", b.runs_p50_ms}}},
        {"core_ms_per_frame", b.core_ms_per_frame},
        {"ahead_core_ms_per_frame", b.ahead_core_ms_per_frame},
        {"runs_differ_by_fraction", b.spread_of_runs()},
        {"stages_ms", b.stages},
        {"latency_ms", b.latency},
        {"floor_ms", b.floor.sum_ms()},
        {"floor_parts_ms",
         {{"embree", b.floor.embree_ms}, {"fft_pair", b.floor.fft_pair_ms}, {"copy", b.floor.copy_ms}}},
        {"ratio_to_floor", b.ratio_to_floor()},
        {"rays",
         {{"primary", b.rendered.primary_rays},
          {"shadow", b.rendered.shadow_rays},
          {"bounce_shadow", b.rendered.bounce_shadow_rays},
          {"lamp", b.rendered.lamp_rays},
          {"path", b.rendered.secondary_rays}}},
        {"path_models", path_models_json(b.path_models)},
        {"runs", b.options.runs},
        {"frames_per_run", b.options.frames},
        {"machine", machine_report()},
    };
}

std::string bench_text(const Bench& b) {
    const RenderStats& r = b.rendered;
    std::string out = fmt::format("{}: {}x{}, {} triangles, {:.1f} % covered\n", b.scenario, b.width_px,
                                  b.height_px, b.triangles, 100 * r.coverage);
    out += fmt::format("{:.1f} frames/s; frame p50 {:.2f} ms, p99 {:.2f} ms; floor {:.2f} ms; ratio {:.2f}\n",
                       b.frame_rate_hz, b.p50_ms, b.p99_ms, b.floor.sum_ms(), b.ratio_to_floor());
    out += fmt::format("{:.2f} core-ms a frame, and {:.2f} of threads that work ahead\n", b.core_ms_per_frame,
                       b.ahead_core_ms_per_frame);
    if (b.spread_of_runs() > Bench::kBusy)
        out += fmt::format(
            "the slowest run took {:.0f} % longer than the fastest: this machine has other work\n",
            100 * b.spread_of_runs());
    out += fmt::format(
        "rays of the last frame: {} primary, {} shadow, {} shadow behind a bounce, {} to lamps and "
        "bodies, {} of paths\n",
        r.primary_rays, r.shadow_rays, r.bounce_shadow_rays, r.lamp_rays, r.secondary_rays);
    for (const auto& [stage, times] : b.stages)
        out += fmt::format("  {:<10} p50 {:7.3f} ms  p99 {:7.3f} ms\n", stage, times.p50_ms, times.p99_ms);
    for (const auto& [name, s] : by_name(b.path_models))
        out += fmt::format(
            "  path model {:<10} {:9} rays  {:8.1f} ms  {:6.2f} Mrays/s, bare Embree {:6.2f} Mrays/s, ratio "
            "{:.2f}\n",
            name, s.rays, s.frame_ms, mrays_s(s), bare_mrays_s(s), s.frame_ms / s.bare_ms);
    return out;
}

// --- variants ---

json bench_json(const std::vector<BenchVariant>& variants) {
    json out = json::array();
    for (const BenchVariant& v : variants) {
        json entry = bench_json(v.bench);
        entry["variant"] = v.name;
        entry["core_ms_ratio"] = {{"median", v.ratio}, {"least", v.least_ratio}, {"most", v.most_ratio}};
        out.push_back(std::move(entry));
    }
    return out;
}

std::string bench_text(const std::vector<BenchVariant>& variants) {
    std::string out = "ratio (least, most)  core-ms  frames/s  variant\n";
    for (const BenchVariant& v : variants)
        out += fmt::format("{:5.3f} ({:5.3f}, {:5.3f}) {:8.2f} {:9.1f}  {}\n", v.ratio, v.least_ratio,
                           v.most_ratio, v.bench.core_ms_per_frame, v.bench.frame_rate_hz, v.name);
    return out;
}

// --- the sensor stage ---

namespace {

// Returns the stages in the order of the JSON's keys.
std::vector<std::pair<const char*, double>> stages_of(const SensorStageTimes& t) {
    return {{"collapse", t.collapse_ms},
            {"convolve", t.convolve_ms},
            {"digitise", t.digitise_ms},
            {"points", t.points_ms}};
}

}  // namespace

json bench_json(const SensorBench& b) {
    json out = {{"camera", b.camera},
                {"width", b.width_px},
                {"height", b.height_px},
                {"sensor_ms", b.base.all_ms},
                {"floor_ms", b.floor_ms},
                {"fft_pair_ms", b.base.fft_pair_ms},
                {"ratio_to_floor", b.ratio_to_floor()},
                {"runs", b.runs},
                {"machine", machine_report()}};
    for (const auto& [stage, ms] : stages_of(b.base)) out["stages_ms"][stage] = ms;
    for (const SensorBench::Effect& effect : b.effects)
        out["effects"].push_back({{"name", effect.name}, {"extra_ms", effect.extra_ms}});
    return out;
}

std::string bench_text(const SensorBench& b) {
    std::string out =
        fmt::format("{}: {} x {} px, sensor stage {:.2f} ms, FFT pair and copy {:.2f} ms, ratio {:.2f}\n",
                    b.camera, b.width_px, b.height_px, b.base.all_ms, b.floor_ms, b.ratio_to_floor());
    for (const auto& [stage, ms] : stages_of(b.base)) out += fmt::format("  {:<22} {:7.2f} ms\n", stage, ms);
    for (const SensorBench::Effect& effect : b.effects)
        out += fmt::format("  with {:<22} {:+7.2f} ms\n", effect.name, effect.extra_ms);
    return out;
}

}  // namespace hilcam
