#include "io/gige/device/gige_clock.h"

#include <sys/timex.h>
#include <time.h>

#include <algorithm>
#include <cstdlib>
#include <limits>

#include "io/gige/device/gige_registers.h"
#include "io/ptp/ptp_message.h"
#include "io/system/clock_difference.h"

namespace hilcam {

namespace b = bootstrap;
namespace reg = feature_register;
using gvcp::Status;

namespace {

// Two clocks cannot be read at the same instant; smaller differences are reading errors.
constexpr std::int64_t kReadingError_ns = 2'000;

}  // namespace

GigeSystemClock read_system_clock() {
    GigeSystemClock clock;
    clock.tai_minus_monotonic_ns = ahead_of_monotonic_ns(CLOCK_TAI);
    timex state{};
    const int result = adjtimex(&state);
    clock.synchronised = result >= 0 && result != TIME_ERROR && !(state.status & STA_UNSYNC);
    clock.tai_offset_known = state.tai != 0;
    // The kernel adds what is left of its offset to its clock: the clock is behind by that.
    if (result >= 0) clock.offset_ns = state.status & STA_NANO ? -state.offset : -1000 * state.offset;
    return clock;
}

GigeClock::GigeClock(GigeCore& core) : core_(core) {
    if (!core_.effects.system_clock) core_.effects.system_clock = read_system_clock;
    add_time_stamp();
    add_data_set();
}

void GigeClock::add_time_stamp() {
    GigeRegisterFile& r = core_.registers;
    r.constant(b::kTickFrequency, 1'000'000'000, 8);
    r.number(
        b::kTimestampControl, [] { return 0u; },
        [this](std::uint64_t value) {
            if (value & 1) {
                if (ptp()) return Status::kAccessDenied;  // the time is not ours to reset
                core_.clock.set(core_.now_ns, 0);
                was_reset_ = true;
            }
            if (value & 2) latched_ = core_.device_ns(core_.now_ns);
            return Status::kSuccess;
        });
    r.number64(b::kTimestamp, [this] { return latched_; });
    r.number(b::kPtpStatus, [this] { return static_cast<std::uint64_t>(data_set().state); });
}

void GigeClock::add_data_set() {
    GigeRegisterFile& r = core_.registers;
    const PtpDataSet& d = latched_set_;
    r.command(reg::kPtpDataSetLatch, [this] {
        latched_set_ = data_set();
        return Status::kSuccess;
    });
    const auto unsigned_of = [](std::int64_t value) { return static_cast<std::uint64_t>(value); };
    r.number(reg::kPtpLatchedStatus, [&d] { return static_cast<std::uint64_t>(d.state); });
    r.number(reg::kPtpServoStatus, [&d] { return d.servo_locked; });
    r.number(reg::kPtpTimeScale, [&d] { return static_cast<std::uint64_t>(d.scale); });
    r.number(reg::kPtpUtcOffset_s, [&d] { return static_cast<std::uint32_t>(d.utc_offset_s); });
    r.number(reg::kPtpSteps, [&d] { return d.steps; });
    r.number64(reg::kPtpOffset_ns, [&d, unsigned_of] { return unsigned_of(d.offset_from_master_ns); });
    r.number64(reg::kPtpDelay_ns, [&d, unsigned_of] { return unsigned_of(d.mean_path_delay_ns); });
    r.number64(reg::kPtpClockId, [&d] { return d.clock_id; });
    r.number64(reg::kPtpParentId, [&d] { return d.parent_id; });
    r.number64(reg::kPtpGrandmasterId, [&d] { return d.grandmaster_id; });
}

bool GigeClock::ptp() const { return core_.gvcp_config & b::gvcp_config::kPtpEnable; }

PtpState GigeClock::machine_state() const {
    if (!ptp()) return PtpState::kDisabled;
    if (!system_.synchronised) return PtpState::kListening;
    return system_.tai_offset_known ? PtpState::kSlave : PtpState::kUncalibrated;
}

PtpDataSet GigeClock::machine_data_set() const {
    PtpDataSet d;
    d.state = machine_state();
    d.servo_locked = d.state >= PtpState::kUncalibrated ? 1 : 0;
    d.clock_id = ptp::identity_of_mac(core_.identity.mac);
    d.offset_from_master_ns = d.servo_locked ? system_.offset_ns : 0;
    if (ptp())
        d.scale = system_.tai_offset_known ? TimeScale::kTai : TimeScale::kUtc;
    else
        d.scale = was_reset_ ? TimeScale::kDevice : TimeScale::kMonotonic;
    d.steps = machine_steps_;
    return d;
}

PtpDataSet GigeClock::data_set() const {
    if (follows_machine()) return machine_data_set();
    PtpDataSet d;
    if (core_.effects.ptp_data_set) d = core_.effects.ptp_data_set();
    d.clock_id = ptp::identity_of_mac(core_.identity.mac);
    if (!ptp()) d.state = PtpState::kDisabled;
    return d;
}

void GigeClock::set_ptp(bool enabled) {
    if (!follows_machine()) {
        if (core_.effects.enable_ptp) core_.effects.enable_ptp(enabled);
    } else if (enabled) {
        system_ = core_.effects.system_clock();
        set_offset(system_.tai_minus_monotonic_ns);
    } else {
        was_reset_ = false;
        set_offset(0);
    }
}

void GigeClock::tick() {
    core_.clock.advance(core_.now_ns);
    if (!ptp() || !follows_machine()) return;
    system_ = core_.effects.system_clock();
    const std::int64_t offset_ns = core_.clock.device_ns(core_.now_ns) - core_.now_ns;
    if (std::abs(system_.tai_minus_monotonic_ns - offset_ns) <= kReadingError_ns) return;
    set_offset(system_.tai_minus_monotonic_ns);
    ++machine_steps_;
}

void GigeClock::reset() {
    latched_ = 0;
    latched_set_ = {};
    was_reset_ = false;
    core_.clock.set(core_.now_ns, core_.effects.power_up_ns ? core_.effects.power_up_ns() : core_.now_ns);
}

void GigeClock::set_offset(std::int64_t offset_ns) {
    core_.clock.set(core_.now_ns, core_.now_ns + offset_ns);
}

}  // namespace hilcam
