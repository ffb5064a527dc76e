#include "io/gige/device/gige_fault_registers.h"

#include <cctype>
#include <cmath>

#include "io/gige/device/gige_registers.h"

namespace hilcam {

namespace reg = feature_register;
using gvcp::Status;

std::string fault_feature_name(FaultKind kind) {
    std::string name;
    bool start = true;
    for (const char c : name_of(kind)) {
        if (c != '_') name += start ? static_cast<char>(std::toupper(static_cast<unsigned char>(c))) : c;
        start = c == '_';
    }
    return name;
}

GigeFaultRegisters::GigeFaultRegisters(GigeCore& core) : core_(core) {
    for (std::size_t i = 0; i < kAllFaults.size(); ++i) drafts_[i].kind = kAllFaults[i];
    GigeRegisterFile& r = core.registers;
    r.variable(reg::kFaultSelector, selector_, {0, kAllFaults.size() - 1});
    r.real(
        reg::kFaultRate, [this] { return shown().rate; },
        [this](double v) { return set(&FaultOrder::rate, v); });
    r.real(
        reg::kFaultValue, [this] { return shown().value; },
        [this](double v) {
            return std::abs(v) <= kMaxValue ? set(&FaultOrder::value, v) : Status::kInvalidParameter;
        });
    r.number64(
        reg::kFaultFromFrame, [this] { return shown().from_frame; },
        [this](std::uint64_t v) { return set_frames(&FaultOrder::from_frame, v); });
    r.number64(
        reg::kFaultFrames, [this] { return shown().frames; },
        [this](std::uint64_t v) { return set_frames(&FaultOrder::frames, v); });
    r.real(
        reg::kFaultDuration_s, [this] { return shown().duration_s; },
        [this](double v) { return set(&FaultOrder::duration_s, v); });
    r.number64(reg::kFaultCount, [this] { return core_.faults.strikes_of(kAllFaults[selector_]); });
    r.number(reg::kFaultActive, [this] { return core_.faults.order_of(kAllFaults[selector_]).has_value(); });
    r.command(reg::kFaultEnable, [this] {
        const FaultOrder order = shown();
        if (!refusal_of(order).empty()) return Status::kInvalidParameter;
        core_.faults.order(order);
        drafts_[selector_] = order;
        edited_[selector_] = false;
        return Status::kSuccess;
    });
    r.command(reg::kFaultClear, [this] {
        core_.faults.order({.kind = kAllFaults[selector_], .rate = 0});
        return Status::kSuccess;
    });
    r.command(reg::kFaultClearAll, [this] {
        core_.faults.clear_all();
        return Status::kSuccess;
    });
}

FaultOrder GigeFaultRegisters::shown() const {
    const FaultOrder& draft = drafts_[selector_];
    if (edited_[selector_]) return draft;
    std::optional<FaultOrder> order = core_.faults.order_of(kAllFaults[selector_]);
    if (!order) return draft;
    // The draft keeps the order as it was requested: "at once" means so again when it is enabled again.
    order->from_frame = draft.from_frame;
    return *order;
}

Status GigeFaultRegisters::set_frames(std::uint64_t FaultOrder::*member, std::uint64_t value) {
    return value <= kMaxFrames ? set(member, value) : Status::kInvalidParameter;
}

// The range of the value depends on the kind, so FaultEnable checks the whole order.
template <class T>
Status GigeFaultRegisters::set(T FaultOrder::*member, T value) {
    FaultOrder draft = shown();
    draft.*member = value;
    // Checks all but the rate and the value's range, with a rate of 0.
    const bool rate_fits = draft.rate >= 0 && draft.rate <= 1;
    FaultOrder rest = draft;
    rest.rate = 0;
    if (!rate_fits || !refusal_of(rest).empty()) return Status::kInvalidParameter;
    drafts_[selector_] = draft;
    edited_[selector_] = true;
    return Status::kSuccess;
}

}  // namespace hilcam
