#pragma once
// Faults on demand as features: FaultEnable puts the order that a client has set up into force.

#include <array>

#include "io/gige/device/gige_core.h"

namespace hilcam {

// Returns the feature's name, PacketDrop for "packet_drop".
std::string fault_feature_name(FaultKind kind);

class GigeFaultRegisters {
  public:
    // Limits of FaultValue, and of FaultFromFrame and FaultFrames.
    static constexpr double kMaxValue = 1e9;
    static constexpr std::uint64_t kMaxFrames = 9'200'000'000'000'000'000u;

    explicit GigeFaultRegisters(GigeCore& core);

  private:
    // Returns the order in force, or the client's draft when there is one.
    FaultOrder shown() const;
    template <class T>
    gvcp::Status set(T FaultOrder::*member, T value);
    gvcp::Status set_frames(std::uint64_t FaultOrder::*member, std::uint64_t value);

    GigeCore& core_;
    std::uint32_t selector_ = 0;  // index in kAllFaults
    std::array<FaultOrder, kAllFaults.size()> drafts_;
    std::array<bool, kAllFaults.size()> edited_{};
};

}  // namespace hilcam
