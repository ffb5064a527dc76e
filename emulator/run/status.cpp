#include "emulator/run/status.h"

#include <bit>
#include <nlohmann/json.hpp>

#include "emulator/run/light_maker.h"
#include "emulator/run/output_summary.h"
#include "emulator/run/report.h"
#include "emulator/scenario/scenario_warnings.h"
#include "io/contract/frame_flags.h"
#include "io/preview/preview_request.h"

namespace hilcam {
namespace {

using nlohmann::json;

json histogram(const DurationHistogram& h) {
    json buckets = json::array();
    for (const DurationHistogram::Bucket& b : h.quarter_octaves()) buckets.push_back({b.from_ms, b.count});
    return {{"count", h.count()},
            {"p50", h.quantile_ms(0.5)},
            {"p99", h.quantile_ms(0.99)},
            {"max", h.quantile_ms(1)},
            {"buckets", buckets}};
}

json camera_status(const CameraModel& camera, const CameraLimits& l) {
    json c = {{"name", camera.name},
              {"width", l.width},
              {"height", l.height},
              {"bits", l.bits},
              {"color_pattern", l.color_pattern},
              {"temperature_c", l.temperature_c},
              {"lockstep", l.lockstep}};
    // A companded DN is not linear in charge.
    if (camera.converter.companding == Companding::kNone) c["gain_dn_e_at_0_db"] = camera.system_gain_dn_e(0);
    return c;
}

json cameras_status(const std::vector<CameraPage>& pages, std::size_t number) {
    json cameras = json::array();
    for (std::size_t i = 0; i < pages.size(); ++i)
        cameras.push_back({{"number", i + 1},
                           {"name", pages[i].name},
                           {"port", pages[i].port > 0 ? json(pages[i].port) : json(nullptr)},
                           {"own", i + 1 == number}});
    return cameras;
}

json settings_status(const CameraSettings& s) {
    json out;
    visit_settings([&](std::string_view name, auto value, auto) {
        if constexpr (std::is_enum_v<std::remove_cvref_t<decltype(s.*value)>>)
            out[std::string(name)] = name_of(s.*value);
        else
            out[std::string(name)] = s.*value;
    });
    return out;
}

// Describes the accepted settings; a setting that clients cannot change is fixed.
json limits_status(const CameraLimits& l) {
    return {{"exposure_s", {l.min_exposure_s, l.max_exposure_s}},
            {"gain_db", {l.min_gain_db, l.max_gain_db}},
            {"black_level_dn", {0, l.max_black_level_dn}},
            {"frame_rate_hz", {l.min_frame_rate_hz, l.max_frame_rate_hz}},
            {"trigger_delay_s", {0, l.max_trigger_delay_s}},
            {"burst_frames", {1, l.max_burst_frames}},
            {"binning", {1, l.max_binning}},
            {"exposure_is_own", l.exposure_is_own},
            {"gain_is_own", l.gain_is_own},
            {"frame_rate_is_own", l.frame_rate_is_own},
            {"has_automatic_exposure", l.has_automatic_exposure},
            {"reversible", l.reversible}};
}

json outputs_status(const std::vector<FrameSink*>& sinks) {
    json outputs = json::array();
    for (const FrameSink* sink : sinks) {
        const SinkReport r = sink->report();
        json figures = json::object();
        for (const auto& [name, value] : r.figures) figures[name] = value;
        json output = counts_of(r);
        output["fault"] = r.fault;
        output["figures"] = figures;
        outputs.push_back(std::move(output));
    }
    return outputs;
}

json counts(const CommandReport& r) {
    return {{"received", r.received},     {"refused", r.refused},     {"lost", r.lost},
            {"duplicates", r.duplicates}, {"strangers", r.strangers}, {"clients", r.clients},
            {"went_back", r.went_back}};
}

json commands_status(const std::vector<std::unique_ptr<CommandReceiver>>& receivers) {
    CommandReport all;
    json links = json::array();
    for (const auto& receiver : receivers) {
        const CommandReport report = receiver->report();
        all += report;
        json link = counts(report);
        link["name"] = receiver->name();
        links.push_back(link);
    }
    json commands = counts(all);
    commands["links"] = links;
    return commands;
}

json faults_status(const FaultBoard& board, const ScenarioConfig& scenario) {
    json faults = json::array();
    for (const FaultKind kind : kAllFaults) {
        json fault = {{"kind", name_of(kind)},
                      {"number", static_cast<int>(kind)},
                      {"bit", std::countr_zero(bit_of(kind))},
                      {"meaning", meaning_of(kind)},
                      {"strikes", board.strikes_of(kind)},
                      {"lacks", lacking_output({&scenario.outputs}, scenario.commands, kind)}};
        if (const auto order = board.order_of(kind))
            fault["order"] = {{"rate", order->rate},
                              {"value", order->value},
                              {"from_frame", order->from_frame},
                              {"frames", order->frames},
                              {"duration_s", order->duration_s}};
        faults.push_back(fault);
    }
    return faults;
}

json clock_status(const SimulatedClock& clock) {
    const ClockReading now = clock.read(monotonic_ns());
    return {{"scale", now.scale}, {"stands", !clock.lockstep() && now.arrival >= now.stands_at}};
}

json flags_status() {
    json flags = json::array();
    for (const FrameFlag& flag : kFrameFlags)
        flags.push_back({{"kind", flag.name}, {"bit", std::countr_zero(flag.bit)}});
    return flags;
}

// Describes the newest frame's level; 0 ms: the governor is off. light: maker of the tables that frames wait
// for; null: none.
json quality_status(const ScenarioConfig& scenario, const LoopCounters& counters, const LightMaker* light) {
    json quality = {{"level", counters.level.load()},
                    {"levels", 1 + lower_levels(scenario).size()},
                    {"level_changes", counters.level_changes.load()},
                    {"frame_budget_ms", counters.budget_ms.load()},
                    {"light_made", nullptr}};
    if (light && counters.lacks_light.load()) quality["light_made"] = light->share();
    return quality;
}

}  // namespace

std::string run_status(const StatusSources& s) {
    const LoopCounters& counters = s.loop.counters();
    const json status = {{"scenario", s.scenario.name},
                         {"camera", camera_status(s.scenario.camera, s.camera.limits())},
                         {"cameras", cameras_status(s.cameras, s.number)},
                         {"settings", settings_status(s.camera.settings())},
                         {"limits", limits_status(s.camera.limits())},
                         {"frames", counters.frames.load()},
                         {"deadline_misses", counters.deadline_misses.load()},
                         {"quality", quality_status(s.scenario, counters, s.light)},
                         {"monotonic_ns", monotonic_ns()},
                         {"clock", clock_status(s.loop.clock())},
                         {"latency_ms",
                          {{"first_packet", histogram(s.delivery.command_to_first)},
                           {"last_packet", histogram(s.delivery.command_to_last)},
                           {"exposure_mid_to_last_packet", histogram(s.delivery.exposure_to_last)}}},
                         {"stages_ms", stage_times(s.loop.meters())},
                         {"commands", commands_status(s.receivers)},
                         {"outputs", outputs_status(s.sinks)},
                         {"faults", faults_status(s.faults, s.scenario)},
                         {"frame_flags", flags_status()}};
    // Replaces invalid UTF-8, because names come from files.
    return status.dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace hilcam
