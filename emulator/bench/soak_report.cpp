#include "emulator/bench/soak_report.h"

#include <spdlog/fmt/fmt.h>

#include <nlohmann/json.hpp>

#include "emulator/recording/machine_report.h"
#include "emulator/run/page_maker.h"
#include "emulator/run/report.h"

namespace hilcam {
namespace {

using nlohmann::json;

json percentiles_json(const SoakPercentiles& p) {
    return {{"p50", p.p50_ms}, {"p99", p.p99_ms}, {"p99.9", p.p999_ms}, {"max", p.max_ms}};
}

json slice_json(const SoakSlice& s) {
    return {{"start_s", s.start_s},
            {"length_s", s.length_s},
            {"frames", s.frames},
            {"deadline_misses", s.deadline_misses},
            {"memory_mb", s.memory_mb},
            {"work_ms", percentiles_json(s.work)},
            {"interval_ms", percentiles_json(s.interval)},
            {"latency_ms", percentiles_json(s.latency)}};
}

json course_json(const SoakCourse& c) {
    return {{"first", c.first},
            {"last", c.last},
            {"per_hour", c.per_hour},
            {"growth", c.growth},
            {"sigma", c.sigma}};
}

json verdict_json(const SoakVerdict& v) {
    return {{"enough_slices", v.enough},
            {"memory_flat", v.enough ? json(v.memory_flat) : json(nullptr)},
            {"latency_steady", v.enough ? json(v.latency_steady) : json(nullptr)},
            {"memory_mb", course_json(v.memory_mb)},
            {"latency_p50_ms", course_json(v.latency_p50_ms)},
            {"latency_p99_ms", course_json(v.latency_p99_ms)}};
}

std::string course_text(const SoakCourse& c, const char* unit) {
    return fmt::format("{:.2f} to {:.2f} {} (trend {:+.2f})", c.first, c.last, unit, c.growth);
}

}  // namespace

std::string soak_csv(const Soak& soak) {
    std::string out = "start_s,length_s,frames,deadline_misses,memory_mb";
    for (const char* figure : {"work", "interval", "latency"})
        for (const char* which : {"p50", "p99", "p99.9", "max"})
            out += fmt::format(",{}_{}_ms", figure, which);
    out += "\n";
    for (const SoakSlice& s : soak.slices) {
        out += fmt::format("{:.3f},{:.3f},{},{},{:.3f}", s.start_s, s.length_s, s.frames, s.deadline_misses,
                           s.memory_mb);
        for (const SoakPercentiles* p : {&s.work, &s.interval, &s.latency})
            out += fmt::format(",{:.4f},{:.4f},{:.4f},{:.4f}", p->p50_ms, p->p99_ms, p->p999_ms, p->max_ms);
        out += "\n";
    }
    return out;
}

json soak_json(const ScenarioConfig& scenario, const SoakOptions& options, const Soak& soak) {
    json slices = json::array();
    for (const SoakSlice& slice : soak.slices) slices.push_back(slice_json(slice));
    return {{"scenario", scenario.name},
            {"width", scenario.camera.width_px},
            {"height", scenario.camera.height_px},
            {"triangles", soak.triangles},
            {"configured_frame_rate_hz", scenario.camera.frame_rate_hz},
            {"prefer", scenario.loop.prefer == LoopPreference::kLatency ? "latency" : "throughput"},
            {"outputs", options.outputs},
            {"seconds", options.seconds},
            {"warm_up_s", soak.round_s},
            {"round_s", soak.round_s},
            {"slice_s", soak.slice_s},
            {"slices", slices},
            {"whole", slice_json(soak.whole)},
            {"verdict", verdict_json(judge(soak))},
            {"fail_on", bounds_json(scenario.loop.fail_on)},
            {"failed_on", failed_on_json(soak.broken)},
            {"text", soak_text(soak)},
            {"machine", machine_report()}};
}

std::string soak_text(const Soak& soak) {
    const SoakVerdict v = judge(soak);
    const std::string figures =
        fmt::format("{} frames in {:.0f} s, {} missed; memory {}: {}; latency {}: p50 {}, p99 {}",
                    soak.whole.frames, soak.whole.length_s, soak.whole.deadline_misses,
                    !v.enough       ? "not judged"
                    : v.memory_flat ? "flat"
                                    : "grows",
                    course_text(v.memory_mb, "MB"),
                    !v.enough          ? "not judged"
                    : v.latency_steady ? "steady"
                                       : "drifts",
                    course_text(v.latency_p50_ms, "ms"), course_text(v.latency_p99_ms, "ms"));
    if (v.enough) return figures;
    return figures + fmt::format("; a trend takes {} slices, there are {}", kMinForTrend, soak.slices.size());
}

void write_soak(const Soak& soak, const json& json, const std::filesystem::path& folder) {
    make_folder(folder);
    write_text(folder / "soak.csv", soak_csv(soak));
    write_json(folder / "soak.json", json);
    run_page_maker("hilcam-plot-soak", {folder.string()});
}

}  // namespace hilcam
