#pragma once
// Triggers as clients see them. The camera has one trigger input: TriggerMode can be on for FrameStart (each
// trigger takes a frame) or for FrameBurstStart (each takes AcquisitionBurstFrameCount frames); switching one
// on switches the other off.

#include "io/gige/device/gige_core.h"

namespace hilcam {

class GigeTrigger {
  public:
    explicit GigeTrigger(GigeCore& core);

    enum Selector : std::uint32_t { kFrameStart, kFrameBurstStart };

  private:
    bool on() const;
    gvcp::Status set_mode(bool on);
    std::uint64_t burst_count() const;
    gvcp::Status set_burst_count(std::uint64_t count);
    gvcp::Status software_trigger();

    GigeCore& core_;
    std::uint32_t selector_ = kFrameStart;
    std::uint32_t activation_ = 0;  // rising edge
};

}  // namespace hilcam
