#include "io/ptp/ptp_note.h"

#include <array>
#include <cinttypes>
#include <cstdio>

namespace hilcam {

std::string format_clock_id(std::uint64_t id) {
    std::array<char, 24> text{};
    std::snprintf(text.data(), text.size(), "%06" PRIx64 ".%04" PRIx64 ".%06" PRIx64, id >> 40,
                  id >> 24 & 0xFFFF, id & 0xFFFFFF);
    return text.data();
}

bool is_warning(const PtpNote& note) {
    using Kind = PtpNote::Kind;
    switch (note.kind) {
        case Kind::kArbitraryScale:
        case Kind::kUtcOffset:
        case Kind::kNoTransmitStamps:
            return true;
        case Kind::kState:
            return note.before == PtpState::kSlave && note.state == PtpState::kListening;
        case Kind::kMaster:
        case Kind::kStep:
            break;
    }
    return false;
}

std::string text_of(const PtpNote& note) {
    using Kind = PtpNote::Kind;
    const std::string master = format_clock_id(note.master);
    switch (note.kind) {
        case Kind::kState: {
            std::string text =
                std::string("PTP is ") + name_of(note.state) + " (was " + name_of(note.before) + ")";
            if (note.state == PtpState::kListening && note.before != PtpState::kInitializing &&
                note.before != PtpState::kFaulty)
                text += ": no master; the clock goes on at its last rate";
            if (note.state == PtpState::kSlave) text += ", master " + master;
            return text;
        }
        case Kind::kMaster:
            return "PTP master " + master;
        case Kind::kStep:
            return "the device's clock stepped by " + std::to_string(note.value) + " ns";
        case Kind::kArbitraryScale:
            return "PTP master " + master +
                   " announces a time scale of its own (no ptpTimescale): device times may be UTC or any "
                   "other "
                   "time, not TAI";
        case Kind::kUtcOffset:
            return "PTP master " + master + " announces TAI with currentUtcOffset " +
                   std::to_string(note.value) + " s" + (note.valid ? "" : ", not marked as valid") +
                   "; accepted: 37 s or more, valid. UTC made from device times would be wrong";
        case Kind::kNoTransmitStamps:
            return "the interface gives no transmit time stamps: the time before each send is used";
    }
    return {};
}

}  // namespace hilcam
