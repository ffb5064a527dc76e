#include "io/gige/device/gige_user_sets.h"

#include "io/gige/device/gige_registers.h"

namespace hilcam {

namespace reg = feature_register;
using gvcp::Status;

namespace {

// Returns only what differs: a camera may refuse to be told what it sets itself.
SettingsChange difference(const CameraSettings& from, const CameraSettings& to) {
    SettingsChange c;
    const auto set = [](auto& member, const auto& before, const auto& after) {
        if (before != after) member = after;
    };
    set(c.exposure_s, from.exposure_s, to.exposure_s);
    set(c.gain_db, from.gain_db, to.gain_db);
    set(c.black_level_dn, from.black_level_dn, to.black_level_dn);
    set(c.frame_rate_hz, from.frame_rate_hz, to.frame_rate_hz);
    set(c.automatic_exposure, from.automatic_exposure, to.automatic_exposure);
    set(c.triggered, from.triggered, to.triggered);
    set(c.trigger_source, from.trigger_source, to.trigger_source);
    set(c.trigger_delay_s, from.trigger_delay_s, to.trigger_delay_s);
    set(c.burst_frames, from.burst_frames, to.burst_frames);
    set(c.test_pattern, from.test_pattern, to.test_pattern);
    set(c.reverse_x, from.reverse_x, to.reverse_x);
    set(c.reverse_y, from.reverse_y, to.reverse_y);
    set(c.binning_x, from.binning_x, to.binning_x);
    set(c.binning_y, from.binning_y, to.binning_y);
    return c;
}

}  // namespace

GigeUserSets::GigeUserSets(GigeCore& core, std::function<void()> loaded)
    : core_(core), loaded_(std::move(loaded)) {
    sets_.fill({core.camera.settings(), core.settings});
    GigeRegisterFile& r = core.registers;
    r.variable(reg::kUserSetSelector, selector_, {0, kSets - 1});
    r.variable(reg::kUserSetDefault, default_, {0, kSets - 1});
    r.command(reg::kUserSetLoad, [this] { return core_.locked() ? Status::kWriteProtect : load(selector_); });
    r.command(reg::kUserSetSave, [this] { return save(selector_); });
}

Status GigeUserSets::save(std::size_t set) {
    if (set == 0) return Status::kWriteProtect;
    sets_[set] = {core_.camera.settings(), core_.settings};
    return Status::kSuccess;
}

Status GigeUserSets::load(std::size_t set) {
    const Set& wanted = sets_[set];
    SettingsChange change = difference(core_.camera.settings(), wanted.camera);
    if (core_.limits.exposure_is_own || wanted.camera.automatic_exposure) change.exposure_s.reset();
    if (core_.limits.gain_is_own) change.gain_db.reset();
    if (core_.limits.frame_rate_is_own) change.frame_rate_hz.reset();
    if (const Status status = core_.change(change); status != Status::kSuccess) return status;
    core_.settings = wanted.device;
    if (loaded_) loaded_();
    return Status::kSuccess;
}

void GigeUserSets::reset() {
    if (load(default_) == Status::kSuccess) return;
    core_.settings = sets_[default_].device;
    if (loaded_) loaded_();
}

}  // namespace hilcam
