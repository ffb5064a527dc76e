#include "emulator/run/output_summary.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "emulator/recording/recorder.h"
#include "emulator/run/camera_station.h"

namespace hilcam {

std::vector<SinkReport> output_reports(const CameraStation& station) {
    std::vector<SinkReport> out;
    for (const FrameSink* sink : station.sinks()) out.push_back(sink->report());
    return out;
}

SinkReport output_report(const RecorderReport& recorder) {
    return {.name = "recording " + recorder.file,
            .frames = recorder.frames,
            .dropped = recorder.lost,
            .fault = recorder.fault};
}

nlohmann::json counts_of(const SinkReport& output) {
    return {{"name", output.name},
            {"frames", output.frames},
            {"dropped", output.dropped},
            {"unwanted", output.unwanted}};
}

nlohmann::json json_of(const ClockReport& c) {
    const auto or_null = [](const auto& value) {
        return value ? nlohmann::json(*value) : nlohmann::json(nullptr);
    };
    return {{"source", c.source},
            {"state", c.state},
            {"scale", c.scale},
            {"offset_from_master_ns", or_null(c.offset_from_master_ns)},
            {"mean_path_delay_ns", or_null(c.mean_path_delay_ns)},
            {"rate_correction_ppm", or_null(c.rate_correction_ppm)},
            {"steps", c.steps},
            {"master", c.master.empty() ? nlohmann::json(nullptr) : nlohmann::json(c.master)}};
}

std::string line_of(const std::vector<SinkReport>& outputs) {
    std::string out;
    for (const SinkReport& o : outputs) {
        if (o.frames + o.dropped + o.unwanted == 0) continue;
        out += fmt::format("{}{} {} frame{}", out.empty() ? "" : "; ", o.name, o.frames,
                           o.frames == 1 ? "" : "s");
        if (o.dropped > 0) out += fmt::format(", {} lost", o.dropped);
        if (o.unwanted > 0) out += fmt::format(", {} that nobody took", o.unwanted);
    }
    return out;
}

bool any_lost(const std::vector<SinkReport>& outputs) {
    return std::any_of(outputs.begin(), outputs.end(), [](const SinkReport& o) { return o.dropped > 0; });
}

}  // namespace hilcam
