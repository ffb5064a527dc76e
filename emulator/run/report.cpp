#include "emulator/run/report.h"

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "emulator/recording/machine_report.h"
#include "emulator/run/broken_bounds.h"
#include "emulator/run/latency_report.h"
#include "emulator/run/output_summary.h"
#include "emulator/run/picture_fault.h"
#include "emulator/run/run_pace.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/overloaded.h"

namespace hilcam {
namespace {

using nlohmann::json;

double rounded(double value) { return std::round(value * 1e4) / 1e4; }

}  // namespace

Percentiles percentiles_of(const DurationHistogram& h) {
    const double max_ms = h.max_ms();  // exact; a bucket's middle may be above it
    const auto quantile = [&](double q) { return rounded(std::min(h.quantile_ms(q), max_ms)); };
    return {quantile(0.5), quantile(0.99), quantile(0.999), rounded(max_ms)};
}

StageTimes stage_times(const StageMeters& meters) {
    using M = StageMeters;
    constexpr std::pair<const char*, DurationHistogram M::*> kStages[] = {
        {"setup", &M::setup},       {"trace", &M::trace},       {"stars", &M::stars},
        {"collapse", &M::collapse}, {"convolve", &M::convolve}, {"points", &M::points},
        {"digitise", &M::digitise}, {"publish", &M::publish},   {"render", &M::render},
        {"sense", &M::sense}};
    StageTimes out;
    for (const auto& [name, stage] : kStages) out[name] = percentiles_of(meters.*stage);
    return out;
}

void to_json(json& out, const Percentiles& p) {
    out = {{"p50", p.p50_ms}, {"p99", p.p99_ms}, {"p99.9", p.p999_ms}, {"max", p.max_ms}};
}

json or_null(const std::optional<double>& value) { return value ? json(*value) : json(nullptr); }

namespace {

json outputs_report(const CameraStation& station) {
    json outputs = json::array();
    for (const SinkReport& r : output_reports(station)) {
        json output = counts_of(r);
        for (const auto& [name, value] : r.figures) output[name] = value;
        if (r.clock) output["clock"] = json_of(*r.clock);
        outputs.push_back(output);
    }
    return outputs;
}

std::vector<std::string> faults_of(const CameraStation& station) {
    std::vector<std::string> out;
    for (const SinkReport& output : output_reports(station))
        if (!output.fault.empty()) out.push_back(output.fault);
    if (const std::string fault = picture_fault(station.renderer()); !fault.empty()) out.push_back(fault);
    return out;
}

// Reports ordered faults: how often each kind struck, and the first strike in each frame.
json strikes_report(const CameraStation& station) {
    json counts = json::object(), log = json::array();
    for (const FaultKind kind : kAllFaults)
        if (const std::uint64_t count = station.faults().strikes_of(kind); count > 0)
            counts[std::string(name_of(kind))] = count;
    for (const FaultBoard::Entry& e : station.fault_log())
        log.push_back({{"kind", name_of(e.kind)},
                       {"frame", e.frame},
                       {"item", e.index},
                       {"value", e.value},
                       {"monotonic_ns", e.monotonic_ns}});
    return {{"counts", counts}, {"log", log}};
}

// Returns the processor time of a frame at each level; null: none was timed.
json core_ms_at_level(const CameraStation& station) {
    const LoopCounters& counters = station.loop().counters();
    json out = json::array();
    for (std::size_t i = 0; i <= lower_levels(station.scenario()).size(); ++i) {
        const std::uint64_t frames = counters.timed_frames_at_level[i].load();
        const double core_ms = 1e-6 * static_cast<double>(counters.processor_ns_at_level[i].load());
        out.push_back(frames == 0 ? json(nullptr) : json(rounded(core_ms / static_cast<double>(frames))));
    }
    return out;
}

json full_quality_report(const CameraStation& station) {
    const std::optional<FullQuality> full = full_quality(station);
    if (!full) return nullptr;
    return {{"core_ms", rounded(full->core_ms)},
            {"frame_rate_hz", rounded(full->rate_hz)},
            {"cores", rounded(full->cores())},
            {"cores_given", given_cores()}};
}

json quality_report(CameraStation& station) {
    RenderQuality quality = render_quality_of(station.scenario());
    const LoopCounters& counters = station.loop().counters();
    json frames_at_level = json::array();
    for (std::size_t i = 0; i <= lower_levels(station.scenario()).size(); ++i)
        frames_at_level.push_back(counters.frames_at_level[i].load());
    json report = {{"rays_outside_atmosphere", station.renderer().rays_outside_air()},
                   {"motion_limited_frames", counters.motion_limited.load()},
                   {"frames_without_kept_light", counters.without_light.load()},
                   {"frame_budget_ms", rounded(counters.budget_ms.load())},
                   {"full_quality", full_quality_report(station)},
                   {"core_ms_at_level", core_ms_at_level(station)},
                   {"level", counters.level.load()},
                   {"level_changes", counters.level_changes.load()},
                   {"frames_at_level", frames_at_level}};
    for (const Field& field : per_frame_fields(quality))
        std::visit(
            [&]<class Target>(const Target& target) {
                if constexpr (std::is_same_v<Target, NumberField>)
                    report[field.key] = *target.value / target.si_per_unit;
                else if constexpr (OneOf<Target, IntegerField, FlagField, TextField>)
                    report[field.key] = *target.value;
            },
            field.target);
    return report;
}

json camera_report(CameraStation& station, double seconds) {
    const FrameLoop& loop = station.loop();
    const auto frames = loop.counters().frames.load();
    return {
        {"camera", station.name()},
        {"frames", frames},
        {"frame_rate_hz", rounded(static_cast<double>(frames) / std::max(1e-9, seconds))},
        {"deadline_misses", loop.counters().deadline_misses.load()},
        {"limited_by", words_of(pace_limit(station, {frames, loop.counters().deadline_misses.load()}))},
        {"stale_frames", loop.counters().stale.load()},
        {"standing_frames", loop.counters().standing.load()},
        {"impossible_motion_frames", loop.counters().impossible.load()},
        {"missed_exposures", missed_json(loop.missed(), loop.counters().deadline_misses.load())},
        {"latency_ms", latency_json(station.delivery())},
        {"latest_frames", latest_frames_json(station)},
        {"outputs", outputs_report(station)},
        {"waited_for_outputs_s",
         rounded(static_cast<double>(loop.counters().waited_for_outputs_ns.load()) * 1e-9)},
        {"faults", faults_of(station)},
        {"fault_strikes", strikes_report(station)},
        {"quality", quality_report(station)},
        {"stages_ms", stage_times(loop.meters())},
    };
}

}  // namespace

RunOutcome run_outcome(const Emulator& emulator) {
    const LoopCounters& counters = emulator.first().loop().counters();
    RunOutcome out{
        counters.frames.load(), counters.deadline_misses.load(), {}, broken_bounds(emulator.stations())};
    for (const auto& station : emulator.stations())
        for (std::string& fault : faults_of(*station)) out.faults.push_back(std::move(fault));
    if (const Recorder* recorder = emulator.recorder())
        if (const std::string fault = recorder->report().fault; !fault.empty()) out.faults.push_back(fault);
    return out;
}

json run_report(const Emulator& emulator) {
    json report = camera_report(emulator.first(), emulator.seconds());
    const CommandReport commands = emulator.command_report();
    report["scenario"] = emulator.first().scenario().name;
    report["run"] = emulator.run_id();
    report["seed"] = emulator.first().scenario().seed;
    report["seconds"] = rounded(emulator.seconds());
    report["cores_used"] = rounded(emulator.used_cores());
    report["commands"] = {
        {"received", commands.received}, {"refused", commands.refused}, {"lost", commands.lost}};
    report["poses"] = {{"went_back", emulator.poses().went_back()}};
    report["machine"] = machine_report();
    const RunOutcome run = run_outcome(emulator);
    report["faults"] = run.faults;
    report["fail_on"] = bounds_json(emulator.first().scenario().loop.fail_on);
    report["failed_on"] = failed_on_json(run.broken);
    if (const Recorder* recorder = emulator.recorder()) {
        const RecorderReport r = recorder->report();
        report["recording"] = {{"file", r.file},   {"frames", r.frames}, {"commands", r.commands},
                               {"bytes", r.bytes}, {"lost", r.lost},     {"complete", r.fault.empty()}};
    }
    for (const auto& replay : emulator.replays()) {
        const Replay::Outcome outcome = replay->outcome();
        report["replay"].push_back({{"frames", outcome.frames}, {"whole", outcome.whole}});
    }
    if (emulator.stations().size() > 1)
        for (const auto& station : emulator.stations())
            report["cameras"].push_back(camera_report(*station, emulator.seconds()));
    return report;
}

void make_folder(const std::filesystem::path& folder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) throw DeviceError(folder.string() + ": cannot be made: " + error.message());
}

void write_text(const std::filesystem::path& file, const std::string& text) {
    std::ofstream out(file);
    out << text;
    out.close();
    if (!out) throw DeviceError(file.string() + ": cannot be written");
}

void write_json(const std::filesystem::path& file, const json& value) {
    std::error_code error;
    if (file.has_parent_path()) std::filesystem::create_directories(file.parent_path(), error);
    std::ofstream out(file);
    out << value.dump(2) << '\n';
    if (!out.flush()) throw DeviceError(file.string() + ": the report cannot be written");
}

}  // namespace hilcam
