#include "emulator/loop/delivery_meter.h"

#include <algorithm>

namespace hilcam {

void LatestFrames::offer(std::int64_t latency_ns, const Delivery& delivery) noexcept {
    if (count_ < kMax) {
        entries_[count_++] = {latency_ns, delivery};
        return;
    }
    const auto shortest =
        std::min_element(entries_.begin(), entries_.end(),
                         [](const Entry& a, const Entry& b) { return a.latency_ns < b.latency_ns; });
    if (latency_ns > shortest->latency_ns) *shortest = {latency_ns, delivery};
}

std::vector<LatestFrames::Entry> merged(std::span<const LatestFrames::Entry> a,
                                        std::span<const LatestFrames::Entry> b) {
    std::vector<LatestFrames::Entry> all(a.begin(), a.end());
    all.insert(all.end(), b.begin(), b.end());
    std::sort(all.begin(), all.end(), [](const LatestFrames::Entry& x, const LatestFrames::Entry& y) {
        if (x.latency_ns != y.latency_ns) return x.latency_ns > y.latency_ns;
        return x.delivery.frame < y.delivery.frame;
    });
    if (all.size() > LatestFrames::kMax) all.resize(LatestFrames::kMax);
    return all;
}

void FramesAbove::record(std::uint64_t frame, std::int64_t latency_ns, double bound_s) noexcept {
    max_ns = std::max(max_ns, latency_ns);
    if (bound_s < 0 || static_cast<double>(latency_ns) <= 1e9 * bound_s) return;
    if (frames++ == 0) first = frame;
}

void FramesAbove::add(const FramesAbove& other) noexcept {
    frames += other.frames;
    max_ns = std::max(max_ns, other.max_ns);
    first = first_of({first, other.first});
}

void OutputMeter::delivered(const FrameRecord& record, std::int64_t first_ns, std::int64_t last_ns) noexcept {
    const Delivery d{record.id,
                     record.exposure_mid,
                     record.command_arrival_monotonic_ns,
                     clocked_ ? record.exposure_mid_monotonic_ns : 0,
                     first_ns,
                     last_ns};
    all_.first_to_last.record(d.last_ns - d.first_ns);
    if (d.command_ns != 0) record_command(d);
    if (d.exposure_ns != 0) record_exposure(d);
}

void OutputMeter::record_command(const Delivery& d) noexcept {
    const std::int64_t latency_ns = d.last_ns - d.command_ns;
    all_.command_to_first.record(d.first_ns - d.command_ns);
    all_.command_to_last.record(latency_ns);
    if (d.exposure_ns != 0)
        all_.command_to_exposure.record(std::max<std::int64_t>(0, d.exposure_ns - d.command_ns));
    from_command_.offer(latency_ns, d);
    if (!counts(d)) return;
    all_.judged.record(latency_ns);
    above_latency_.record(d.frame, latency_ns, bounds_.latency_s);
    above_p999_.record(d.frame, latency_ns, bounds_.latency_p999_s);
}

void OutputMeter::record_exposure(const Delivery& d) noexcept {
    const std::int64_t latency_ns = d.last_ns - d.exposure_ns;
    all_.exposure_to_first.record(d.first_ns - d.exposure_ns);
    all_.exposure_to_last.record(latency_ns);
    from_exposure_.offer(latency_ns, d);
    if (!counts(d)) return;
    ++judged_exposures_;
    above_exposure_.record(d.frame, latency_ns, bounds_.exposure_latency_s);
}

}  // namespace hilcam
