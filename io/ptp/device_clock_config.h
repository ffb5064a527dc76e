#pragma once
// The keys of a camera's clock (outputs.gige.clock).

#include <cstdint>

#include "io/ptp/device_clock.h"
#include "io/ptp/ptp_sockets.h"
#include "render/vocabulary/config_field.h"

namespace hilcam {

// Where the clock's time comes from: the machine, a PTP master, or nowhere.
enum class ClockSource { kTai, kPtp, kFree };
enum class ClockStart { kZero, kMachine };

struct DeviceClockConfig {
    ClockSource source = ClockSource::kTai;
    bool enable_ptp = false;
    double rate = 0, wander = 0;  // ratios; wander: change of the rate in one second, standard deviation
    double offset_s = 0;
    ClockStart start = ClockStart::kZero;
    std::int64_t seed = 1;
    PtpTransport transport = PtpTransport::kUdp;
    std::int64_t domain = 0;
};
Fields fields(DeviceClockConfig& config);
void validate(const DeviceClockConfig& config);

// Returns what the clock shows when it starts. tai_ns: the machine's CLOCK_TAI at that instant.
std::int64_t start_ns(const DeviceClockConfig& config, std::int64_t tai_ns);
// identity: a number of the camera, so that two cameras with one seed wander apart.
OscillatorConfig oscillator_of(const DeviceClockConfig& config, std::uint64_t identity);

}  // namespace hilcam
