#include "io/gige/device/gige_trigger.h"

#include "io/gige/device/gige_registers.h"

namespace hilcam {

namespace reg = feature_register;
using gvcp::Status;

GigeTrigger::GigeTrigger(GigeCore& core) : core_(core) {
    GigeRegisterFile& r = core.registers;
    const auto settings = [this] { return core_.camera.settings(); };
    r.variable(reg::kTriggerSelector, selector_, {kFrameStart, kFrameBurstStart});
    r.number(
        reg::kTriggerMode, [this] { return on(); },
        [this](std::uint64_t v) { return v > 1 ? Status::kInvalidParameter : set_mode(v != 0); });
    r.number(
        reg::kTriggerSource, [settings] { return static_cast<std::uint64_t>(settings().trigger_source); },
        [this](std::uint64_t v) {
            if (v > static_cast<std::uint64_t>(TriggerSource::kAction1)) return Status::kInvalidParameter;
            return core_.change({.trigger_source = static_cast<TriggerSource>(v)});
        });
    r.variable(reg::kTriggerActivation, activation_, {0, 0});
    r.real(
        reg::kTriggerDelay_us, [settings] { return settings().trigger_delay_s * 1e6; },
        [this](double us) { return core_.change({.trigger_delay_s = us * 1e-6}); });
    r.command(reg::kTriggerSoftware, [this] { return software_trigger(); });
    r.number(
        reg::kBurstFrameCount, [this] { return burst_count(); },
        [this](std::uint64_t v) { return set_burst_count(v); });
}

bool GigeTrigger::on() const {
    return core_.camera.settings().triggered &&
           core_.settings.burst_trigger == (selector_ == kFrameBurstStart);
}

Status GigeTrigger::set_mode(bool wanted) {
    if (!wanted) return on() ? core_.change({.triggered = false}) : Status::kSuccess;
    const bool burst = selector_ == kFrameBurstStart;
    const Status status = core_.change(
        {.triggered = true, .burst_frames = burst ? std::int64_t{core_.settings.burst_count} : 1});
    if (status == Status::kSuccess) core_.settings.burst_trigger = burst;
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

// A trigger that comes too early is taken by the register and missed by the camera, which says so with an
// event. One that the camera does not listen to is refused.
Status GigeTrigger::software_trigger() {
    TriggerOrder order;
    order.source = TriggerSource::kSoftware;
    const TriggerResult result = core_.camera.trigger(order);
    return result == TriggerResult::kNotArmed ? Status::kAccessDenied : Status::kSuccess;
}

}  // namespace hilcam
