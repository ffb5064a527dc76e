#include "io/gige/device/gige_acquisition.h"

#include "io/gige/device/gige_registers.h"

namespace hilcam {

namespace reg = feature_register;
using gvcp::Status;
using When = GigeRegisterFile::When;

GigeAcquisition::GigeAcquisition(GigeCore& core) : core_(core) {
    add_control();
    add_exposure();
    add_frame_rate();
}

// --- start and stop
// ------------------------------------------------------------------------------------------------------

void GigeAcquisition::add_control() {
    GigeRegisterFile& r = core_.registers;
    GigeSettings& s = core_.settings;
    r.command(reg::kAcquisitionStart, [this] { return start(); });
    const auto end = [this] {
        stop();
        return Status::kSuccess;
    };
    r.command(reg::kAcquisitionStop, end);
    r.command(reg::kAcquisitionAbort, end);
    r.number(
        reg::kAcquisitionMode, [&s] { return static_cast<std::uint64_t>(s.mode); },
        [this](std::uint64_t mode) {
            if (mode > static_cast<std::uint64_t>(AcquisitionMode::kMultiFrame))
                return Status::kInvalidParameter;
            core_.settings.mode = static_cast<AcquisitionMode>(mode);
            core_.publish_stream();
            return Status::kSuccess;
        },
        When::kUnlocked);
    r.variable(
        reg::kAcquisitionFrameCount, s.frame_count, {1, 65535}, [this] { core_.publish_stream(); },
        When::kUnlocked);
    r.number(
        reg::kParamsLocked, [this] { return core_.locked(); },
        [this](std::uint64_t on) {
            if (on > 1) return Status::kInvalidParameter;
            core_.host_locked = on != 0;
            return Status::kSuccess;
        });
}

Status GigeAcquisition::start() {
    core_.stream.acquiring = true;
    ++core_.stream.epoch;
    core_.publish_stream();
    return Status::kSuccess;
}

void GigeAcquisition::stop() {
    if (!core_.stream.acquiring) return;
    core_.stream.acquiring = false;
    core_.publish_stream();
}

// --- exposure, gain, black level
// ----------------------------------------------------------------------------------------

void GigeAcquisition::add_exposure() {
    GigeRegisterFile& r = core_.registers;
    const auto settings = [this] { return core_.camera.settings(); };
    r.constant(reg::kExposureMode, 1);  // Timed
    r.number(
        reg::kExposureAuto, [settings] { return settings().automatic_exposure; },
        [this](std::uint64_t on) {
            if (on > 1 || (on && !core_.limits.has_automatic_exposure)) return Status::kInvalidParameter;
            if (!core_.limits.has_automatic_exposure) return Status::kSuccess;
            return core_.change({.automatic_exposure = on != 0});
        });
    r.real(
        reg::kExposureTime_us, [settings] { return settings().exposure_s * 1e6; },
        [this](double us) { return core_.change({.exposure_s = us * 1e-6}); });
    r.variable(reg::kGainSelector, only_selector_, {0, 0});
    r.real(
        reg::kGain_db, [settings] { return settings().gain_db; },
        [this](double db) { return core_.change({.gain_db = db}); });
    r.variable(reg::kBlackLevelSelector, only_selector_, {0, 0});
    r.real(
        reg::kBlackLevel_dn, [settings] { return settings().black_level_dn; },
        [this](double dn) { return core_.change({.black_level_dn = dn}); });
}

// --- frame rate
// ---------------------------------------------------------------------------------------------------------

// Without AcquisitionFrameRateEnable the camera is as fast as it can be.
void GigeAcquisition::add_frame_rate() {
    GigeRegisterFile& r = core_.registers;
    r.number(
        reg::kFrameRateEnable, [this] { return core_.settings.rate_enabled; },
        [this](std::uint64_t on) { return on > 1 ? Status::kInvalidParameter : enable_rate(on != 0); });
    r.real(
        reg::kFrameRate_hz, [this] { return core_.camera.settings().frame_rate_hz; },
        [this](double rate_hz) { return set_rate(rate_hz); });
}

Status GigeAcquisition::enable_rate(bool on) {
    GigeSettings& s = core_.settings;
    if (on == s.rate_enabled) return Status::kSuccess;
    const double before_hz = core_.camera.settings().frame_rate_hz;
    const Status status = core_.change({.frame_rate_hz = on ? s.rate_hz : core_.limits.max_frame_rate_hz});
    if (status != Status::kSuccess) return status;
    s.rate_enabled = on;
    if (!on) s.rate_hz = before_hz;
    return Status::kSuccess;
}

Status GigeAcquisition::set_rate(double rate_hz) {
    if (!core_.settings.rate_enabled) return Status::kWriteProtect;
    return core_.change({.frame_rate_hz = rate_hz});
}

}  // namespace hilcam
