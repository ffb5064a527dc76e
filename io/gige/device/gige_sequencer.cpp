#include "io/gige/device/gige_sequencer.h"

#include "io/gige/device/gige_registers.h"

namespace hilcam {

namespace reg = feature_register;
using gvcp::Status;

GigeSequencer::GigeSequencer(GigeCore& core) : core_(core), sequencer_(core.camera.sequencer()) {
    if (!sequencer_) return;
    for (SequencerSet& s : program().sets) keep_in(s, core.camera.settings());
    add_modes();
    add_features();
    add_sets();
    add_paths();
}

void GigeSequencer::stop() {
    configures_ = false;
    if (sequencer_) sequencer_->stop();
}

void GigeSequencer::configured(std::uint32_t address, GigeRegisterFile::Read read,
                               GigeRegisterFile::Write write) {
    core_.registers.number(address, std::move(read), [this, write = std::move(write)](std::uint64_t value) {
        return configures_ ? write(value) : Status::kWriteProtect;
    });
}

// --- modes

void GigeSequencer::add_modes() {
    GigeRegisterFile& r = core_.registers;
    r.number(
        reg::kSequencerMode, [this] { return std::uint64_t{on()}; },
        [this](std::uint64_t mode) { return mode > 1 ? Status::kInvalidParameter : set_mode(mode != 0); });
    r.number(
        reg::kSequencerConfigurationMode, [this] { return std::uint64_t{configures_}; },
        [this](std::uint64_t mode) {
            if (mode > 1) return Status::kInvalidParameter;
            if (mode == 1 && on()) return Status::kWriteProtect;
            configures_ = mode != 0;
            return Status::kSuccess;
        });
    r.number(reg::kSequencerSetActive, [this] { return std::uint64_t{on() ? sequencer_->active() : 0}; });
}

Status GigeSequencer::set_mode(bool wanted) {
    if (wanted == on()) return Status::kSuccess;
    if (!wanted) return sequencer_->stop(), Status::kSuccess;
    if (configures_ || core_.camera.settings().automatic_exposure) return Status::kWriteProtect;
    sequencer_->start(program(), core_.lines.settings().counters);
    return Status::kSuccess;
}

// --- the features of sets

bool GigeSequencer::has(std::uint32_t feature) const {
    return core_.limits.reversible || feature < static_cast<std::uint32_t>(SequencerFeature::kReverseX);
}

void GigeSequencer::add_features() {
    core_.registers.number(
        reg::kSequencerFeatureSelector, [this] { return feature_; },
        [this](std::uint64_t wanted) {
            if (wanted >= kSequencerFeatures || !has(static_cast<std::uint32_t>(wanted)))
                return Status::kInvalidParameter;
            feature_ = static_cast<std::uint32_t>(wanted);
            return Status::kSuccess;
        });
    configured(
        reg::kSequencerFeatureEnable, [this] { return program().features >> feature_ & 1u; },
        [this](std::uint64_t wanted) {
            if (wanted > 1) return Status::kInvalidParameter;
            const std::uint32_t bit = 1u << feature_;
            program().features = wanted ? program().features | bit : program().features & ~bit;
            return Status::kSuccess;
        });
}

// --- sets

void GigeSequencer::add_sets() {
    GigeRegisterFile& r = core_.registers;
    r.variable(reg::kSequencerSetSelector, set_, {0, kSequencerSets - 1});
    configured(
        reg::kSequencerSetStart, [this] { return program().start; },
        [this](std::uint64_t wanted) {
            if (wanted >= kSequencerSets) return Status::kInvalidParameter;
            program().start = static_cast<std::uint8_t>(wanted);
            return Status::kSuccess;
        });
    r.command(reg::kSequencerSetSave, [this] {
        if (!configures_) return Status::kWriteProtect;
        keep_in(set(), core_.camera.settings());
        return Status::kSuccess;
    });
    r.command(reg::kSequencerSetLoad, [this] { return configures_ ? load() : Status::kWriteProtect; });
}

Status GigeSequencer::load() {
    const CameraSettings now = core_.camera.settings();
    CameraSettings wanted = now;
    take_from(set(), program().features, wanted);
    return core_.change(difference(now, wanted));
}

// --- paths

bool GigeSequencer::is_source(std::uint64_t value) const {
    if (value >= kLineEvents) return false;
    const auto event = static_cast<LineEvent>(value);
    if (!is_sequencer_source(event, core_.limits.lockstep)) return false;
    if (event < LineEvent::kLine0) return true;
    const std::size_t line = value - static_cast<std::size_t>(LineEvent::kLine0);
    const LinePlan& plan = core_.lines.plan();
    return plan.is_there[line] && !plan.is_output[line];
}

void GigeSequencer::add_paths() {
    core_.registers.variable(reg::kSequencerPathSelector, path_, {0, kSequencerPaths - 1});
    configured(
        reg::kSequencerSetNext, [this] { return path().next; },
        [this](std::uint64_t wanted) {
            if (wanted >= kSequencerSets) return Status::kInvalidParameter;
            path().next = static_cast<std::uint8_t>(wanted);
            return Status::kSuccess;
        });
    configured(
        reg::kSequencerTriggerSource, [this] { return static_cast<std::uint64_t>(path().source); },
        [this](std::uint64_t wanted) {
            if (!is_source(wanted)) return Status::kInvalidParameter;
            path().source = static_cast<LineEvent>(wanted);
            return Status::kSuccess;
        });
    configured(
        reg::kSequencerTriggerActivation, [this] { return static_cast<std::uint64_t>(path().activation); },
        [this](std::uint64_t wanted) {
            if (wanted > static_cast<std::uint64_t>(TriggerActivation::kAnyEdge))
                return Status::kInvalidParameter;
            path().activation = static_cast<TriggerActivation>(wanted);
            return Status::kSuccess;
        });
}

}  // namespace hilcam
