#pragma once
// Triggers as clients see them. The camera has one trigger at a time. TriggerMode can be on for FrameStart
// (each trigger takes a frame), FrameBurstStart (each takes AcquisitionBurstFrameCount frames) or
// AcquisitionStart (the first trigger after the stream's start takes a frame, and the camera then runs freely
// until the stream ends). Switching one on switches the others off.
//
// The input is Line0, with the additional names in the identity, or another input line of the scenario
// (io/lines). TriggerActivation and TriggerDivider hold for lines.

#include "io/contract/frame_sink.h"
#include "io/gige/device/gige_core.h"

namespace hilcam {

class GigeTrigger {
  public:
    explicit GigeTrigger(GigeCore& core);

    enum Selector : std::uint32_t { kFrameStart, kFrameBurstStart, kAcquisitionStart };
    // Takes the start of a triggered exposure; an acquisition that waited for the trigger then continues by
    // itself.
    void on_event(const CameraEvent& event);
    // Makes the next acquisition wait again. Called when one has ended, and when settings were loaded.
    void rearm();

  private:
    bool on() const;
    gvcp::Status set_mode(bool on);
    gvcp::Status set_acquisition_mode(bool on);
    std::uint64_t source() const;
    gvcp::Status set_source(std::uint64_t source);
    std::uint64_t burst_count() const;
    gvcp::Status set_burst_count(std::uint64_t count);
    gvcp::Status software_trigger();

    GigeCore& core_;
    std::uint32_t selector_ = kFrameStart;
    std::int64_t armed_ns_ = 0;  // exposures from then on were triggered
};

}  // namespace hilcam
