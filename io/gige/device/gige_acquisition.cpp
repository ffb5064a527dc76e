#include "io/gige/device/gige_acquisition.h"

#include <cmath>

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
    // Before the stream, whose first frame uses the start set.
    if (Sequencer* const sequencer = core_.camera.sequencer()) sequencer->restart();
    core_.stream.acquiring = true;
    ++core_.stream.epoch;
    core_.publish_stream();
    return Status::kSuccess;
}

void GigeAcquisition::stop() {
    if (!core_.stream.acquiring) return;
    core_.stream.acquiring = false;
    core_.publish_stream();
    if (ended_) ended_();
}

// --- exposure, gain, black level

void GigeAcquisition::add_exposure() {
    GigeRegisterFile& r = core_.registers;
    const auto settings = [this] { return core_.camera.settings(); };
    r.number(
        reg::kExposureMode,
        [settings] { return kTimed + static_cast<std::uint64_t>(settings().exposure_mode); },
        [this](std::uint64_t mode) {
            if (mode < kTimed || mode > kTimed + 1) return Status::kInvalidParameter;
            return core_.change({.exposure_mode = static_cast<ExposureMode>(mode - kTimed)});
        });
    r.number(
        reg::kExposureAuto,
        [this, settings] {
            if (!settings().automatic_exposure) return std::uint64_t{kOff};
            return std::uint64_t{finding_ ? kOnce : kContinuous};
        },
        [this](std::uint64_t mode) { return set_automatic(mode); });
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

Status GigeAcquisition::set_automatic(std::uint64_t mode) {
    if (mode > kOnce || (mode != kOff && !core_.limits.has_automatic_exposure))
        return Status::kInvalidParameter;
    if (!core_.limits.has_automatic_exposure) return Status::kSuccess;
    const Status status = core_.change({.automatic_exposure = mode != kOff});
    if (status != Status::kSuccess) return status;
    finding_ = mode == kOnce;
    found_s_ = 0, steady_ = looked_at_ = 0;
    return status;
}

// Once ends when the exposure has been the same to 1/50 for four frames, or after 64 frames with whatever it
// is then. The control needs some ten frames for a static scene, and never settles on a moving one.
void GigeAcquisition::on_event(const CameraEvent& event) {
    if (!finding_ || event.kind != CameraEvent::Kind::kExposureStart) return;
    constexpr double kSame = 0.02;
    constexpr int kSteadyFrames = 4, kMaxFrames = 64;
    const CameraSettings now = core_.camera.settings();
    finding_ = now.automatic_exposure;  // or automatic exposure was switched off elsewhere
    if (!finding_) return;
    steady_ = std::abs(now.exposure_s - found_s_) <= kSame * found_s_ ? steady_ + 1 : 0;
    found_s_ = now.exposure_s;
    if (steady_ < kSteadyFrames && ++looked_at_ < kMaxFrames) return;
    finding_ = core_.change({.automatic_exposure = false}) != Status::kSuccess;
}

// --- frame rate

// Adds the frame rate. Without AcquisitionFrameRateEnable, the camera runs as fast as it can.
void GigeAcquisition::add_frame_rate() {
    GigeRegisterFile& r = core_.registers;
    r.number(
        reg::kFrameRateEnable, [this] { return core_.settings.rate_enabled; },
        [this](std::uint64_t on) { return on > 1 ? Status::kInvalidParameter : enable_rate(on != 0); });
    r.real(
        reg::kFrameRate_hz, [this] { return core_.camera.settings().frame_rate_hz; },
        [this](double rate_hz) { return set_rate(rate_hz); });
    r.real(reg::kResultingFrameRate_hz, [this] { return core_.camera.resulting_frame_rate_hz(); });
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
