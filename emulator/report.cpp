#include "emulator/report.h"

#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "render/check.h"

namespace hilcam {
namespace {

using nlohmann::json;

double rounded(double value) { return std::round(value * 1e4) / 1e4; }

json percentiles(const DurationHistogram& h) {
    return {{"p50", rounded(h.quantile_ms(0.5))},
            {"p99", rounded(h.quantile_ms(0.99))},
            {"max", rounded(h.quantile_ms(1))}};
}

std::string processor_name() {
    std::ifstream in("/proc/cpuinfo");
    for (std::string line; std::getline(in, line);)
        if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
    return "unknown";
}

}  // namespace

json machine_report() {
    return {{"processor", processor_name()},
            {"cores", std::thread::hardware_concurrency()},
            {"compiler", std::string("gcc ") + __VERSION__},
#ifdef NDEBUG
            {"build", "optimised"}
#else
            {"build", "debug"}
#endif
    };
}

json stages_report(const StageMeters& m) {
    return {{"setup", percentiles(m.setup)},       {"trace", percentiles(m.trace)},
            {"stars", percentiles(m.stars)},       {"collapse", percentiles(m.collapse)},
            {"convolve", percentiles(m.convolve)}, {"points", percentiles(m.points)},
            {"digitise", percentiles(m.digitise)}, {"publish", percentiles(m.publish)},
            {"render", percentiles(m.render)},     {"sense", percentiles(m.sense)}};
}

json run_report(const ScenarioConfig& scenario, double seconds, const FrameLoop& loop,
                const DeliveryMeter& delivery, const CommandReport& commands,
                const std::vector<FrameSink*>& sinks) {
    json outputs = json::array();
    json faults = json::array();
    for (const FrameSink* sink : sinks) {
        const SinkReport r = sink->report();
        outputs.push_back({{"name", r.name}, {"frames", r.frames}, {"dropped", r.dropped}});
        if (!r.fault.empty()) faults.push_back(r.fault);
    }
    const auto frames = loop.counters().frames.load();
    return {
        {"scenario", scenario.name},
        {"frames", frames},
        {"seconds", rounded(seconds)},
        {"frame_rate_hz", rounded(static_cast<double>(frames) / std::max(1e-9, seconds))},
        {"deadline_misses", loop.counters().deadline_misses.load()},
        {"latency_ms",
         {{"first_packet", percentiles(delivery.command_to_first)},
          {"last_packet", percentiles(delivery.command_to_last)},
          {"exposure_mid_to_last_packet", percentiles(delivery.exposure_to_last)}}},
        {"commands",
         {{"received", commands.received}, {"refused", commands.refused}, {"lost", commands.lost}}},
        {"outputs", outputs},
        {"faults", faults},
        {"quality",
         {{"samples_per_axis", scenario.quality.render.samples_per_axis},
          {"max_depth", scenario.quality.render.max_depth},
          {"contribution_threshold", scenario.quality.render.contribution_threshold}}},
        {"stages_ms", stages_report(loop.meters())},
        {"machine", machine_report()},
    };
}

void write_json(const std::filesystem::path& file, const json& value) {
    std::error_code error;
    if (file.has_parent_path()) std::filesystem::create_directories(file.parent_path(), error);
    std::ofstream out(file);
    out << value.dump(2) << '\n';
    if (!out.flush()) throw DeviceError(file.string() + ": the report cannot be written");
}

}  // namespace hilcam
