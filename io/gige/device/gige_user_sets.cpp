#include "io/gige/device/gige_user_sets.h"

#include "io/gige/device/gige_registers.h"

namespace hilcam {

namespace reg = feature_register;
using gvcp::Status;

GigeUserSets::GigeUserSets(GigeCore& core, std::function<void()> loaded)
    : core_(core), loaded_(std::move(loaded)) {
    sets_.fill({core.camera.settings(), core.settings, core.lines.settings()});
    GigeRegisterFile& r = core.registers;
    r.variable(reg::kUserSetSelector, selector_, {0, kSets - 1});
    r.variable(reg::kUserSetDefault, default_, {0, kSets - 1});
    r.command(reg::kUserSetLoad, [this] { return core_.locked() ? Status::kWriteProtect : load(selector_); });
    r.command(reg::kUserSetSave, [this] { return save(selector_); });
}

Status GigeUserSets::save(std::size_t set) {
    if (set == 0) return Status::kWriteProtect;
    sets_[set] = {core_.camera.settings(), core_.settings, core_.lines.settings()};
    return Status::kSuccess;
}

Status GigeUserSets::load(std::size_t set) {
    const Set& wanted = sets_[set];
    // Only the differences, because a camera may refuse a value that it sets itself.
    SettingsChange change = difference(core_.camera.settings(), wanted.camera);
    change.running.reset();
    if (core_.limits.exposure_is_own || wanted.camera.automatic_exposure) change.exposure_s.reset();
    if (core_.limits.gain_is_own) change.gain_db.reset();
    if (core_.limits.frame_rate_is_own) change.frame_rate_hz.reset();
    if (const Status status = core_.change(change); status != Status::kSuccess) return status;
    core_.settings = wanted.device;
    core_.lines.change(wanted.lines, core_.now_ns);
    if (loaded_) loaded_();
    return Status::kSuccess;
}

void GigeUserSets::reset() {
    if (load(default_) == Status::kSuccess) return;
    core_.settings = sets_[default_].device;
    core_.lines.change(sets_[default_].lines, core_.now_ns);
    if (loaded_) loaded_();
}

}  // namespace hilcam
