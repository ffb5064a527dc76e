#pragma once
// Takes the loop's frames into the ring of a GigE Vision stream: which of them, under which block id, with
// which time stamp, and with the faults that befall whole frames.

#include <atomic>
#include <optional>
#include <string>
#include <vector>

#include "io/gige/stream/gige_blocks.h"
#include "io/gige/stream/gige_ring.h"
#include "io/gige/stream/stream_faults.h"

namespace hilcam {

class GigeFrameWriter {
  public:
    // pattern: of the colour filter array, empty: none. width: the widest frame.
    GigeFrameWriter(GigeRing& ring, FaultBoard& faults, std::string pattern, int width);

    struct Outcome {
        bool written = false;   // the sender has something to do
        bool finished = false;  // the last frame of the acquisition will not be sent
    };
    // Loop, once for each frame: the block id that it has from here on; 0: it is not to be sent. A frame
    // whose size is not the stream's (the binning has just changed) is not.
    std::uint64_t admit(const DnImage& frame, const FrameRecord& record, const GigeStreamNow& now) noexcept;
    // Loop, after admit() of the same: no lock, no allocation. A frame that finds the ring full, or is to be
    // lost, leaves a gap in the block ids.
    Outcome write(const DnImage& frame, const FrameRecord& record, const GigeStreamNow& now,
                  std::uint64_t block) noexcept;

    // Any thread.
    std::uint64_t dropped() const { return dropped_.load(); }
    std::uint64_t unwanted() const { return unwanted_.load(); }
    std::uint64_t of_other_size() const { return of_other_size_.load(); }

  private:
    GigeRing& ring_;
    FaultBoard& faults_;
    std::string pattern_;
    std::vector<std::uint16_t> scratch_;
    std::uint64_t acquisition_ = 0;
    std::uint32_t frames_ = 0;  // frames of this acquisition
    BlockIds ids_;
    StampClock clock_;
    const GigeSlot* before_ = nullptr;  // the frame before, of this acquisition
    std::atomic<std::uint64_t> dropped_{0}, of_other_size_{0}, unwanted_{0};
};

}  // namespace hilcam
