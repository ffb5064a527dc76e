#pragma once
// Faults on demand as features: what a client has set up takes effect with FaultEnable.

#include <array>

#include "io/gige/device/gige_core.h"

namespace hilcam {

// "packet_drop" as PacketDrop.
std::string fault_feature_name(FaultKind kind);

class GigeFaultRegisters {
  public:
    // Bounds of FaultValue, and of FaultFromFrame and FaultFrames.
    static constexpr double kMaxValue = 1e9;
    static constexpr std::uint64_t kMaxFrames = 9'200'000'000'000'000'000u;

    explicit GigeFaultRegisters(GigeCore& core);

  private:
    // The order in force, unless the client has begun to set up another.
    FaultOrder shown() const;
    template <class T>
    gvcp::Status set(T FaultOrder::*member, T value);
    gvcp::Status set_frames(std::uint64_t FaultOrder::*member, std::uint64_t value);

    GigeCore& core_;
    std::uint32_t selector_ = 0;  // place in kAllFaults
    std::array<FaultOrder, kAllFaults.size()> drafts_;
    std::array<bool, kAllFaults.size()> edited_{};
};

}  // namespace hilcam
