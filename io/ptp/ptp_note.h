#pragma once
// Notes of what happened to a PTP port, for the log: plain data, made into a line by the one that prints it.

#include <cstdint>
#include <string>

#include "io/ptp/ptp_data_set.h"

namespace hilcam {

struct PtpNote {
    enum class Kind : std::uint8_t {
        kState,           // the port's state changed
        kMaster,          // another master
        kStep,            // the clock stepped by `value` ns
        kArbitraryScale,  // the master's time is not said to be TAI
        kUtcOffset,  // the master's offset of TAI to UTC is `value` s, and cannot be right or is not valid
        kNoTransmitStamps,  // the interface gives none
    } kind{};
    PtpState state = PtpState::kDisabled, before = PtpState::kDisabled;
    std::uint64_t master = 0;
    std::int64_t value = 0;
    bool valid = false;  // kUtcOffset: the master's flag
};

// Writes an EUI-64 as linuxptp does: "7a3c1f.fffe.0d2b40".
std::string format_clock_id(std::uint64_t id);
// True when a user should be warned.
bool is_warning(const PtpNote& note);
std::string text_of(const PtpNote& note);

}  // namespace hilcam
