#include "io/ptp/device_clock_config.h"

#include <cmath>
#include <string>

#include "render/vocabulary/random.h"

namespace hilcam {
namespace {

Field own_clock_only(const DeviceClockConfig& c, Field field) {
    field.why_idle = [&c]() -> std::string {
        return c.source == ClockSource::kTai
                   ? "source tai is the machine's clock, which has no errors of its own"
                   : "";
    };
    return field;
}
Field ptp_only(const DeviceClockConfig& c, Field field) {
    field.why_idle = [&c]() -> std::string {
        return c.source == ClockSource::kPtp ? "" : "only source ptp sends and receives PTP messages";
    };
    return field;
}

}  // namespace

Fields fields(DeviceClockConfig& c) {
    return {
        choice(
            "source", c.source, {"tai", "ptp", "free"},
            "source of the device's time: the machine's clocks, CLOCK_TAI with PtpEnable (tai); a clock of "
            "the camera's own, which a PTP master steers with PtpEnable (ptp); such a clock without PTP "
            "(free)"),
        flag("enable_ptp", c.enable_ptp, "true: PtpEnable is on from the start, without a client"),
        own_clock_only(c, number("ppm", c.rate, 1e-6, {-500, 500}, "error of the clock's rate")),
        own_clock_only(c, choice("start", c.start, {"zero", "machine"},
                                 "reading of the clock at the start, before offset_s: 0 (zero), or the "
                                 "machine's CLOCK_TAI (machine)")),
        own_clock_only(c, number("offset_s", c.offset_s, 1, {-1e9, 1e9},
                                 "time that is added to the clock at the start")),
        own_clock_only(c, number("wander_ppm", c.wander, 1e-6, {0, 1},
                                 "change of the rate from one second to the next, standard deviation of a "
                                 "random walk")),
        own_clock_only(c, integer("seed", c.seed, {0, 1e15}, "seed of the random walk")),
        ptp_only(c, choice("transport", c.transport, {"udp", "ethernet"},
                           "PTP over UDP and IPv4, or directly over Ethernet")),
        ptp_only(c, integer("domain", c.domain, {0, 127}, "PTP domain; messages of others are ignored")),
    };
}

void validate(const DeviceClockConfig& c) {
    if (c.enable_ptp && c.source == ClockSource::kFree)
        throw refused_key("enable_ptp", "true beside source free", "sources tai and ptp");
    if (c.start == ClockStart::kZero && c.offset_s < 0)
        throw refused_key("offset_s", "a negative start", "0 or more, or start: machine");
}

std::int64_t start_ns(const DeviceClockConfig& c, std::int64_t tai_ns) {
    return (c.start == ClockStart::kMachine ? tai_ns : 0) + std::llround(c.offset_s * 1e9);
}

OscillatorConfig oscillator_of(const DeviceClockConfig& c, std::uint64_t identity) {
    return {c.rate, c.wander, seed_of_nth(static_cast<std::uint64_t>(c.seed), identity)};
}

}  // namespace hilcam
