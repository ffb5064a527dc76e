#pragma once
// Writes the loop's frames into the ring of a GigE Vision stream: it decides which frames, with which block
// id and time stamp, and applies the faults of whole frames.

#include <atomic>
#include <optional>
#include <string>
#include <vector>

#include "io/contract/loss_count.h"
#include "io/gige/stream/gige_blocks.h"
#include "io/gige/stream/gige_ring.h"
#include "io/gige/stream/stream_faults.h"
#include "io/ptp/device_clock.h"

namespace hilcam {

class GigeFrameWriter {
  public:
    // pattern: of the colour filter array; empty: monochrome. width: of the widest frame. clock: gives the
    // time stamps.
    GigeFrameWriter(GigeRing& ring, FaultBoard& faults, const DeviceClock& clock, std::string pattern,
                    int width);

    struct Outcome {
        bool written = false;   // the sender has something to do
        bool finished = false;  // the last frame of the acquisition will not be sent
    };
    // Returns the frame's block id; 0 when it will not be sent. A frame with another size than the stream's
    // is not sent (the binning has just changed); neither is one whose exposure began before the stream did.
    // Loop, once for each frame.
    std::uint64_t admit(const DnImage& frame, const FrameRecord& record, const GigeStreamNow& now) noexcept;
    // Writes the frame after admit(). When the ring is full or a fault drops the frame, its block id is a
    // gap. Loop: no lock, no allocation.
    Outcome write(const DnImage& frame, const FrameRecord& record, const GigeStreamNow& now,
                  std::uint64_t block) noexcept;

    // Any thread.
    const LossCount& dropped() const { return dropped_; }  // the ring was full
    std::uint64_t dropped_by_faults() const { return dropped_by_faults_.load(); }
    std::uint64_t unwanted() const { return unwanted_.load(); }
    const LossCount& of_other_size() const { return of_other_size_; }

  private:
    GigeRing& ring_;
    FaultBoard& faults_;
    const DeviceClock& device_clock_;
    std::string pattern_;
    std::vector<std::uint16_t> scratch_;
    std::uint64_t acquisition_ = 0;
    std::uint32_t frames_ = 0;  // frames of this acquisition
    BlockIds ids_;
    StampClock stamps_;
    const GigeSlot* before_ = nullptr;  // the previous frame of this acquisition
    LossCount dropped_, of_other_size_;
    std::atomic<std::uint64_t> dropped_by_faults_{0}, unwanted_{0};
};

}  // namespace hilcam
