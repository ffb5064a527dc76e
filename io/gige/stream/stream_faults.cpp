#include "io/gige/stream/stream_faults.h"

namespace hilcam {

PacketFate fate_of_packet(FaultBoard& faults, std::uint64_t frame, std::uint32_t id, std::uint32_t trailer) {
    PacketFate fate;
    const auto strikes = [&](FaultKind kind) { return faults.strikes(kind, frame, id); };
    fate.lost = strikes(FaultKind::kLinkDown) || (id == 0 && strikes(FaultKind::kLeaderLost)) ||
                (id == trailer && strikes(FaultKind::kTrailerLost)) || strikes(FaultKind::kPacketDrop);
    if (fate.lost) return fate;
    if (const auto ms = strikes(FaultKind::kPacketDelay)) {
        fate.delay_ns = static_cast<std::int64_t>(*ms * 1e6);
        return fate;
    }
    fate.twice = strikes(FaultKind::kPacketDuplicate).has_value();
    fate.corrupt = id != 0 && id != trailer && strikes(FaultKind::kPacketCorrupt);
    if (const auto error = strikes(FaultKind::kPacketWrongId))
        fate.id_error = static_cast<std::int64_t>(*error);
    if (const auto bytes = strikes(FaultKind::kPacketTruncate))
        fate.cut_bytes = static_cast<std::size_t>(*bytes);
    return fate;
}

PacketFate fate_of_resend(FaultBoard& faults, std::uint64_t frame, std::uint32_t id) {
    PacketFate fate;
    fate.lost = faults.strikes(FaultKind::kResendRefused, frame, id).has_value();
    if (fate.lost) return fate;
    if (const auto error = faults.strikes(FaultKind::kResendWrongId, frame, id))
        fate.id_error = static_cast<std::int64_t>(*error);
    if (const auto ms = faults.strikes(FaultKind::kResendDelayed, frame, id))
        fate.delay_ns = static_cast<std::int64_t>(*ms * 1e6);
    return fate;
}

std::uint32_t PacketOrder::next(FaultBoard& faults, std::uint64_t frame) {
    if (held_) {
        const std::uint32_t id = *held_;
        held_.reset();
        return id;
    }
    const std::uint32_t id = next_++;
    if (id == last_ || !faults.strikes(FaultKind::kPacketReorder, frame, id)) return id;
    held_ = id;
    return next_++;
}

std::uint64_t StampClock::stamp(FaultBoard& faults, std::uint64_t frame, std::int64_t monotonic_ns,
                                const ClockLine& clock, std::uint64_t& faults_seen) {
    if (faults.strikes(FaultKind::kTimestampFreeze, frame) && last_ != 0) {
        faults_seen |= bit_of(FaultKind::kTimestampFreeze);
        return last_;
    }
    std::int64_t ns = clock.device_at(monotonic_ns);
    if (const auto ppm = faults.strikes(FaultKind::kTimestampDrift, frame)) {
        faults_seen |= bit_of(FaultKind::kTimestampDrift);
        const std::int64_t since_ns = faults.since_monotonic_ns(FaultKind::kTimestampDrift);
        ns += static_cast<std::int64_t>(static_cast<double>(monotonic_ns - since_ns) * *ppm * 1e-6);
    }
    if (const auto ms = faults.strikes(FaultKind::kTimestampStep, frame)) {
        faults_seen |= bit_of(FaultKind::kTimestampStep);
        ns += static_cast<std::int64_t>(*ms * 1e6);
    }
    return last_ = static_cast<std::uint64_t>(ns);
}

}  // namespace hilcam
