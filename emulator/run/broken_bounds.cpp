#include "emulator/run/broken_bounds.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>

#include "emulator/run/output_summary.h"

namespace hilcam {
namespace {

using nlohmann::json;

struct Named {
    const char* key;
    double RunBounds::*bound;
    double si_per_unit;
    const char* unit;  // the value's unit in a message
    const char* noun;  // the thing that breaks the bound, singular
};

constexpr Named kBounds[] = {
    {"latency_ms", &RunBounds::latency_s, 1e-3, " ms", "frame"},
    {"latency_p999_ms", &RunBounds::latency_p999_s, 1e-3, " ms", "frame"},
    {"exposure_latency_ms", &RunBounds::exposure_latency_s, 1e-3, " ms", "frame"},
    {"missed_exposures", &RunBounds::missed_exposures, 1, " exposures", "exposure"},
    {"dropped_packets", &RunBounds::dropped_packets, 1, " packets", "packet"},
    {"dropped_frames", &RunBounds::dropped_frames, 1, " frames", "frame"},
};

const Named& named(const std::string& key) {
    return *std::find_if(std::begin(kBounds), std::end(kBounds),
                         [&](const Named& n) { return key == n.key; });
}

double ms(std::int64_t ns) { return 1e-6 * static_cast<double>(ns); }

}  // namespace

BoundedFigures bounded_figures(const CameraStation& station) {
    BoundedFigures out;
    for (const OutputMeter& meter : station.output_meters()) {
        out.latency.add(meter.above_latency());
        out.p999.add(meter.above_p999());
        out.exposure.add(meter.above_exposure());
        out.judged_exposures += meter.judged_exposures();
    }
    out.judged_commands = station.delivery().judged.count();
    const DurationHistogram& judged = station.delivery().judged;
    out.p999_ms = std::min(judged.quantile_ms(0.999), judged.max_ms());
    const MissedExposures& missed = station.loop().missed();
    out.missed = missed.counted(), out.first_missed = missed.first_counted();
    for (const SinkReport& r : output_reports(station)) {
        out.packets += r.packets_lost;
        out.first_packet_frame = first_of({out.first_packet_frame, r.first_with_lost_packet});
        out.frames += r.dropped - std::min(r.dropped, r.dropped_by_faults);
        out.first_dropped = first_of({out.first_dropped, r.first_dropped});
    }
    return out;
}

std::vector<BrokenBound> broken_bounds(const RunBounds& bounds, const std::string& camera,
                                       const BoundedFigures& f) {
    std::vector<BrokenBound> broken;
    const auto judge = [&](const std::string& key, std::optional<double> value, std::uint64_t first,
                           std::uint64_t count) {
        const Named& n = named(key);
        if (bounds.*n.bound < 0) return;
        const double bound = bounds.*n.bound / n.si_per_unit;
        if (value && *value <= bound) return;
        broken.push_back({key, camera, value, bound, first, count});
    };
    const auto measured = [](std::uint64_t frames, double value) {
        return frames > 0 ? std::optional(value) : std::nullopt;
    };
    judge("latency_ms", measured(f.judged_commands, ms(f.latency.max_ns)), f.latency.first, f.latency.frames);
    judge("latency_p999_ms", measured(f.judged_commands, f.p999_ms), f.p999.first, f.p999.frames);
    judge("exposure_latency_ms", measured(f.judged_exposures, ms(f.exposure.max_ns)), f.exposure.first,
          f.exposure.frames);
    judge("missed_exposures", static_cast<double>(f.missed), f.first_missed, f.missed);
    judge("dropped_packets", static_cast<double>(f.packets), f.first_packet_frame, f.packets);
    judge("dropped_frames", static_cast<double>(f.frames), f.first_dropped, f.frames);
    return broken;
}

std::vector<BrokenBound> broken_bounds(const std::vector<std::unique_ptr<CameraStation>>& stations) {
    std::vector<BrokenBound> all;
    for (const auto& station : stations)
        std::ranges::move(
            broken_bounds(station->scenario().loop.fail_on, station->name(), bounded_figures(*station)),
            std::back_inserter(all));
    return all;
}

std::string text_of(const BrokenBound& b) {
    const Named& n = named(b.key);
    const std::string whose = fmt::format("loop.fail_on.{}: {}: ", b.key, b.camera);
    if (!b.value)
        return whose +
               fmt::format("nothing was measured, {:.10g}{} are allowed: no frame that counts {}", b.bound,
                           n.unit,
                           b.key == "exposure_latency_ms" ? "was sent" : "was sent with a new command");
    std::string text = whose + fmt::format("{:.6g}{}, {:.10g} allowed", *b.value, n.unit, b.bound);
    if (b.first_frame != 0) text += fmt::format("; first in frame {}", b.first_frame);
    if (n.si_per_unit < 1) text += fmt::format(", {} {}{} in all", b.count, n.noun, b.count == 1 ? "" : "s");
    return text;
}

json failed_on_json(const std::vector<BrokenBound>& broken) {
    json out = json::array();
    for (const BrokenBound& b : broken)
        out.push_back({{"bound", b.key},
                       {"camera", b.camera},
                       {"value", b.value ? json(*b.value) : json(nullptr)},
                       {"allowed", b.bound},
                       {"first_frame", b.first_frame == 0 ? json(nullptr) : json(b.first_frame)},
                       {"count", b.count},
                       {"text", text_of(b)}});
    return out;
}

json bounds_json(const RunBounds& bounds) {
    json out = json::object();
    for (const Named& n : kBounds)
        if (bounds.*n.bound >= 0) out[n.key] = bounds.*n.bound / n.si_per_unit;
    if (bounds.any()) out["from_frame"] = bounds.from_frame;
    return out;
}

}  // namespace hilcam
