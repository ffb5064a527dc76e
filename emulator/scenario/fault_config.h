#pragma once
// The section `faults`: faults that occur without a command.

#include <cstdint>

#include "io/contract/fault.h"
#include "render/vocabulary/config_field.h"

namespace hilcam {

// A fault (io/contract/fault.h) that the scenario orders by itself.
struct FaultConfig {
    FaultKind kind = FaultKind::kPacketDrop;
    FaultOrder order;
    double at_s = 0;  // time after the start, CLOCK_MONOTONIC
    std::int64_t from_frame = 0, frames = 0;
};
Fields fields(FaultConfig& fault);
void validate(const FaultConfig& fault);
FaultOrder order_of(const FaultConfig& fault);

}  // namespace hilcam
