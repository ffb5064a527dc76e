#include "emulator/run/latency_report.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "emulator/run/report.h"

namespace hilcam {
namespace {

using nlohmann::json;

json rounded_ms(std::int64_t ns) { return std::round(static_cast<double>(ns) * 1e-2) / 1e4; }
json step_ms(std::int64_t from_ns, std::int64_t to_ns) {
    return from_ns == 0 || to_ns == 0 ? json(nullptr) : rounded_ms(to_ns - from_ns);
}

json frame_json(const LatestFrames::Entry& entry) {
    const Delivery& d = entry.delivery;
    return {{"frame", d.frame},
            {"latency_ms", rounded_ms(entry.latency_ns)},
            {"command_to_exposure_mid_ms", step_ms(d.command_ns, d.exposure_ns)},
            {"exposure_mid_to_first_packet_ms", step_ms(d.exposure_ns, d.first_ns)},
            {"first_to_last_packet_ms", step_ms(d.first_ns, d.last_ns)},
            {"exposure_mid_tai_ns", d.exposure_mid.ns},
            {"last_packet_monotonic_ns", d.last_ns}};
}

json frames_json(const CameraStation& station, const LatestFrames& (OutputMeter::*which)() const) {
    std::vector<LatestFrames::Entry> all;
    for (const OutputMeter& meter : station.output_meters()) all = merged(all, (meter.*which)().entries());
    json out = json::array();
    for (const LatestFrames::Entry& entry : all) out.push_back(frame_json(entry));
    return out;
}

}  // namespace

json durations_json(const DurationHistogram& histogram) {
    json out = percentiles_of(histogram);
    out["count"] = histogram.count();
    json& buckets = out["histogram"] = json::array();
    for (const DurationHistogram::Bucket& b : histogram.quarter_octaves())
        buckets.push_back({b.from_ms, b.count});
    return out;
}

json latency_json(const DeliveryMeter& delivery) {
    return {{"first_packet", durations_json(delivery.command_to_first)},
            {"last_packet", durations_json(delivery.command_to_last)},
            {"command_to_exposure_mid", durations_json(delivery.command_to_exposure)},
            {"exposure_mid_to_first_packet", durations_json(delivery.exposure_to_first)},
            {"first_to_last_packet", durations_json(delivery.first_to_last)},
            {"exposure_mid_to_last_packet", durations_json(delivery.exposure_to_last)}};
}

json missed_json(const MissedExposures& missed, std::uint64_t total) {
    json gaps = json::array();
    for (const MissedExposures::Gap& gap : missed.gaps())
        gaps.push_back({{"frame", gap.frame},
                        {"exposures", gap.exposures},
                        {"late", gap.late},
                        {"next_exposure_mid_tai_ns", gap.before_mid_tai_ns}});
    return {
        {"exposures", total}, {"gaps", gaps}, {"gaps_left_out", missed.gap_count() - missed.gaps().size()}};
}

json latest_frames_json(const CameraStation& station) {
    return {{"from_command", frames_json(station, &OutputMeter::from_command)},
            {"from_exposure_mid", frames_json(station, &OutputMeter::from_exposure)}};
}

}  // namespace hilcam
