#pragma once
// A PTP port's knowledge of itself and its master: the members of IEEE 1588-2008's data sets that a camera
// shows (clause 8.2).

#include <cstdint>

namespace hilcam {

enum class PtpState : std::uint32_t {  // IEEE 1588-2008, table 8
    kInitializing = 1,
    kFaulty,
    kDisabled,
    kListening,
    kPreMaster,
    kMaster,
    kPassive,
    kUncalibrated,
    kSlave,
};

// The scale that the device's clock shows. A master says in its Announce messages whether its time is TAI
// (flag ptpTimescale; IEEE 1588-2008, 7.2.1); if not, the scale is the master's own, and UTC as likely as any
// other.
enum class TimeScale : std::uint32_t { kDevice, kMonotonic, kArbitrary, kUtc, kTai };
constexpr const char* name_of(TimeScale scale) {
    switch (scale) {
        case TimeScale::kMonotonic:
            return "monotonic";
        case TimeScale::kArbitrary:
            return "arbitrary";
        case TimeScale::kUtc:
            return "UTC";
        case TimeScale::kTai:
            return "TAI";
        case TimeScale::kDevice:
            break;
    }
    return "device";
}
constexpr const char* name_of(PtpState state) {
    constexpr const char* kNames[] = {"Initializing", "Faulty",  "Disabled",     "Listening", "PreMaster",
                                      "Master",       "Passive", "Uncalibrated", "Slave"};
    return kNames[static_cast<std::uint32_t>(state) - 1];
}

struct PtpDataSet {
    PtpState state = PtpState::kDisabled;
    std::uint32_t servo_locked = 0;                                 // 0 or 1
    std::uint64_t clock_id = 0, parent_id = 0, grandmaster_id = 0;  // EUI-64; 0: none
    std::int64_t offset_from_master_ns = 0;                         // device minus master, as measured last
    std::int64_t mean_path_delay_ns = 0;
    TimeScale scale = TimeScale::kDevice;
    std::int32_t utc_offset_s = 0;  // TAI minus UTC, as the master says
    std::uint32_t utc_offset_valid = 0;
    std::uint32_t steps = 0;  // number of steps of the clock
    double rate_correction = 0;
};

}  // namespace hilcam
