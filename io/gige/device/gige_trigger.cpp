#include "io/gige/device/gige_trigger.h"

#include "io/gige/device/gige_lines.h"
#include "io/gige/device/gige_registers.h"

namespace hilcam {

namespace reg = feature_register;
using gvcp::Status;

namespace {

constexpr std::uint64_t kLine0 = static_cast<std::uint64_t>(TriggerSource::kLine0),
                        kLastSource = static_cast<std::uint64_t>(TriggerSource::kAction1);

}  // namespace

GigeTrigger::GigeTrigger(GigeCore& core) : core_(core) {
    GigeRegisterFile& r = core.registers;
    const auto settings = [this] { return core_.camera.settings(); };
    r.variable(reg::kTriggerSelector, selector_, {kFrameStart, kAcquisitionStart});
    r.number(
        reg::kTriggerMode, [this] { return on(); },
        [this](std::uint64_t v) { return v > 1 ? Status::kInvalidParameter : set_mode(v != 0); });
    r.number(
        reg::kTriggerSource, [this] { return source(); }, [this](std::uint64_t v) { return set_source(v); });
    r.number(
        reg::kTriggerActivation,
        [settings] { return static_cast<std::uint64_t>(settings().trigger_activation); },
        [this](std::uint64_t v) {
            if (v > static_cast<std::uint64_t>(TriggerActivation::kLevelLow))
                return Status::kInvalidParameter;
            return core_.change({.trigger_activation = static_cast<TriggerActivation>(v)});
        });
    r.number(
        reg::kTriggerDivider, [settings] { return static_cast<std::uint64_t>(settings().trigger_divider); },
        [this](std::uint64_t v) { return core_.change({.trigger_divider = static_cast<std::int64_t>(v)}); });
    r.number(
        reg::kTriggerOverlap, [settings] { return static_cast<std::uint64_t>(settings().trigger_overlap); },
        [this](std::uint64_t v) {
            if (v > static_cast<std::uint64_t>(TriggerOverlap::kReadOut)) return Status::kInvalidParameter;
            return core_.change({.trigger_overlap = static_cast<TriggerOverlap>(v)});
        });
    r.real(
        reg::kTriggerDelay_us, [settings] { return settings().trigger_delay_s * 1e6; },
        [this](double us) { return core_.change({.trigger_delay_s = us * 1e-6}); });
    r.command(reg::kTriggerSoftware, [this] { return software_trigger(); });
    r.number(
        reg::kBurstFrameCount, [this] { return burst_count(); },
        [this](std::uint64_t v) { return set_burst_count(v); });
}

// Sources beyond the camera's first three are further names of Line0; those from kFirstOwn on are lines.
std::uint64_t GigeTrigger::source() const {
    const TriggerSource now = core_.camera.settings().trigger_source;
    if (now >= TriggerSource::kLine1) return GigeLines::kFirstOwn + line_of(now);
    const auto own = static_cast<std::uint64_t>(now);
    return own == kLine0 && core_.settings.line > 0 ? kLastSource + core_.settings.line : own;
}

Status GigeTrigger::set_source(std::uint64_t wanted) {
    if (wanted > GigeLines::kFirstOwn) {
        const std::uint64_t line = wanted - GigeLines::kFirstOwn;
        const LinePlan& plan = core_.lines.plan();
        if (line >= kLines || !plan.is_there[line] || plan.is_output[line]) return Status::kInvalidParameter;
        return core_.change({.trigger_source = source_of_line(line)});
    }
    if (wanted > kLastSource + core_.identity.more_lines.size()) return Status::kInvalidParameter;
    const std::uint64_t own = wanted > kLastSource ? kLine0 : wanted;
    const Status status = core_.change({.trigger_source = static_cast<TriggerSource>(own)});
    if (status == Status::kSuccess && own == kLine0)
        core_.settings.line = static_cast<std::uint32_t>(wanted > kLastSource ? wanted - kLastSource : 0);
    return status;
}

bool GigeTrigger::on() const {
    if (selector_ == kAcquisitionStart || core_.settings.acquisition_trigger)
        return selector_ == kAcquisitionStart && core_.settings.acquisition_trigger;
    return core_.camera.settings().triggered &&
           core_.settings.burst_trigger == (selector_ == kFrameBurstStart);
}

Status GigeTrigger::set_acquisition_mode(bool wanted) {
    if (wanted == core_.settings.acquisition_trigger) return Status::kSuccess;
    SettingsChange change{.triggered = wanted};
    if (wanted) change.burst_frames = 1;
    const Status status = core_.change(change);
    if (status != Status::kSuccess) return status;
    core_.settings.acquisition_trigger = wanted;
    armed_ns_ = core_.now_ns;
    return status;
}

void GigeTrigger::rearm() {
    if (!core_.settings.acquisition_trigger || core_.camera.settings().triggered) return;
    if (core_.change({.triggered = true, .burst_frames = 1}) == Status::kSuccess) armed_ns_ = core_.now_ns;
}

void GigeTrigger::on_event(const CameraEvent& event) {
    if (event.kind == CameraEvent::Kind::kExposureStart && event.monotonic_ns >= armed_ns_ &&
        core_.settings.acquisition_trigger && core_.stream.acquiring && core_.camera.settings().triggered)
        core_.change({.triggered = false});
}

Status GigeTrigger::set_mode(bool wanted) {
    if (selector_ == kAcquisitionStart) return set_acquisition_mode(wanted);
    if (!wanted) return on() ? core_.change({.triggered = false}) : Status::kSuccess;
    const bool burst = selector_ == kFrameBurstStart;
    const Status status = core_.change(
        {.triggered = true, .burst_frames = burst ? std::int64_t{core_.settings.burst_count} : 1});
    if (status == Status::kSuccess)
        core_.settings.burst_trigger = burst, core_.settings.acquisition_trigger = false;
    return status;
}

std::uint64_t GigeTrigger::burst_count() const {
    const CameraSettings now = core_.camera.settings();
    if (now.triggered && core_.settings.burst_trigger) return static_cast<std::uint64_t>(now.burst_frames);
    return core_.settings.burst_count;
}

Status GigeTrigger::set_burst_count(std::uint64_t count) {
    if (count < 1 || count > static_cast<std::uint64_t>(core_.limits.max_burst_frames))
        return Status::kInvalidParameter;
    if (core_.camera.settings().triggered && core_.settings.burst_trigger)
        if (const Status status = core_.change({.burst_frames = static_cast<std::int64_t>(count)});
            status != Status::kSuccess)
            return status;
    core_.settings.burst_count = static_cast<std::uint32_t>(count);
    return Status::kSuccess;
}

// A trigger that comes too early is accepted by the register, and the camera reports with an event that it
// missed it. A trigger from a source that the camera does not listen to is refused, as is one for a stream
// that has not begun.
Status GigeTrigger::software_trigger() {
    if (core_.settings.acquisition_trigger && !core_.stream.acquiring) return Status::kAccessDenied;
    TriggerOrder order;
    order.source = TriggerSource::kSoftware;
    const TriggerResult result = core_.camera.trigger(order);
    return result == TriggerResult::kNotArmed ? Status::kAccessDenied : Status::kSuccess;
}

}  // namespace hilcam
