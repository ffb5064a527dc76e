#pragma once
// Triggers as clients see them. The camera has one trigger input: TriggerMode can be on for FrameStart (each
// trigger takes a frame), for FrameBurstStart (each takes AcquisitionBurstFrameCount frames) or for AcquisitionStart (the first one after the
// stream's begin takes a frame, and the camera runs freely from there to the stream's end); switching one on switches the others off.
//
// The input is Line0, and has the other names that the identity gives it.

#include "io/contract/frame_sink.h"
#include "io/gige/device/gige_core.h"

namespace hilcam {

class GigeTrigger {
  public:
    explicit GigeTrigger(GigeCore& core);

    enum Selector : std::uint32_t { kFrameStart, kFrameBurstStart, kAcquisitionStart };
    // An exposure that has begun was triggered: an acquisition that waited for it goes on by itself.
    void on_event(const CameraEvent& event);
    // Has the next acquisition wait again. Is called when one has ended, and when settings were loaded.
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
    void add_lines();

    GigeCore& core_;
    std::uint32_t selector_ = kFrameStart;
    std::uint32_t activation_ = 0;  // rising edge
    std::uint32_t line_selector_ = 0, line_mode_ = 0;
    std::int64_t armed_ns_ = 0;  // exposures from then on were triggered
};

}  // namespace hilcam
