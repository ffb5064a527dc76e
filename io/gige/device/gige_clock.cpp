#include "io/gige/device/gige_clock.h"

#include <sys/timex.h>
#include <time.h>

#include <algorithm>
#include <cstdlib>
#include <limits>

#include "io/gige/device/gige_registers.h"

namespace hilcam {

namespace b = bootstrap;
using gvcp::Status;

namespace {

std::int64_t read_ns(clockid_t clock) {
    timespec t{};
    clock_gettime(clock, &t);
    return std::int64_t{t.tv_sec} * 1'000'000'000 + t.tv_nsec;
}

// Two clocks cannot be read at the same instant; smaller differences are reading errors.
constexpr std::int64_t kReadingError_ns = 2'000;

}  // namespace

GigeSystemClock read_system_clock() {
    GigeSystemClock clock;
    // The best of several readings is the fastest.
    std::int64_t min_ns = std::numeric_limits<std::int64_t>::max();
    for (int i = 0; i < 3; ++i) {
        const std::int64_t before_ns = read_ns(CLOCK_MONOTONIC);
        const std::int64_t tai_ns = read_ns(CLOCK_TAI);
        const std::int64_t after_ns = read_ns(CLOCK_MONOTONIC);
        if (after_ns - before_ns >= min_ns) continue;
        min_ns = after_ns - before_ns;
        clock.tai_minus_monotonic_ns = tai_ns - before_ns - min_ns / 2;
    }
    timex state{};
    const int result = adjtimex(&state);
    clock.synchronised = result >= 0 && result != TIME_ERROR && !(state.status & STA_UNSYNC);
    clock.tai_offset_known = state.tai != 0;
    return clock;
}

GigeClock::GigeClock(GigeCore& core) : core_(core) {
    if (!core_.effects.system_clock) core_.effects.system_clock = read_system_clock;
    GigeRegisterFile& r = core.registers;
    r.constant(b::kTickFrequency, 1'000'000'000, 8);
    r.number(
        b::kTimestampControl, [] { return 0u; },
        [this](std::uint64_t value) {
            if (value & 1) {
                if (ptp()) return Status::kAccessDenied;  // TAI cannot be reset
                set_offset(-core_.now_ns);
            }
            if (value & 2) latched_ = core_.device_ns(core_.now_ns);
            return Status::kSuccess;
        });
    r.number64(b::kTimestamp, [this] { return latched_; });
    r.number(b::kPtpStatus, [this] { return static_cast<std::uint64_t>(status()); });
}

bool GigeClock::ptp() const { return core_.gvcp_config & b::gvcp_config::kPtpEnable; }

PtpStatus GigeClock::status() const {
    if (!ptp()) return PtpStatus::kDisabled;
    if (!system_.synchronised) return PtpStatus::kListening;
    return system_.tai_offset_known ? PtpStatus::kSlave : PtpStatus::kUncalibrated;
}

void GigeClock::set_ptp(bool enabled) {
    if (enabled)
        tick();
    else
        set_offset(0);
}

void GigeClock::tick() {
    if (!ptp()) return;
    system_ = core_.effects.system_clock();
    if (std::abs(system_.tai_minus_monotonic_ns - core_.stream.clock_offset_ns) > kReadingError_ns)
        set_offset(system_.tai_minus_monotonic_ns);
}

void GigeClock::reset() {
    latched_ = 0;
    set_offset(0);
}

void GigeClock::set_offset(std::int64_t offset_ns) {
    if (core_.stream.clock_offset_ns == offset_ns) return;
    core_.stream.clock_offset_ns = offset_ns;
    core_.publish_stream();
}

}  // namespace hilcam
