#pragma once
// Takes the loop's frames into the ring of a GigE Vision stream: which of them, under which block id, with
// which time stamp, and with the faults that befall whole frames.

#include <atomic>
#include <optional>
#include <string>
#include <vector>

#include "io/gige_blocks.h"
#include "io/gige_ring.h"
#include "io/stream_faults.h"
#include "render/latest.h"

namespace hilcam {

class GigeFrameWriter {
  public:
    // pattern: of the colour filter array, empty: none. width: the widest frame.
    GigeFrameWriter(GigeRing& ring, FaultBoard& faults, std::string pattern, int width);

    struct Outcome {
        bool written = false;   // the sender has something to do
        bool finished = false;  // the last frame of the acquisition will not be sent
    };
    // Loop: no lock, no allocation. A frame whose size is not the stream's (the binning has just changed) is
    // not sent and has no block id; one that finds the ring full, or is to be lost, leaves a gap in them.
    Outcome write(const DnImage& frame, const FrameRecord& record, const GigeStreamNow& now) noexcept;

    // Any thread.
    std::uint64_t dropped() const { return dropped_.load(); }
    std::uint64_t of_other_size() const { return of_other_size_.load(); }
    // One thread: the block id of the newest frame if that is `frame`, else 0.
    std::uint64_t block_of(std::uint64_t frame);

  private:
    GigeRing& ring_;
    FaultBoard& faults_;
    std::string pattern_;
    std::vector<std::uint16_t> scratch_;
    std::uint64_t acquisition_ = 0;
    std::uint32_t frames_ = 0;  // of this acquisition
    BlockIds ids_;
    StampClock clock_;
    const GigeSlot* before_ = nullptr;  // the frame before, of this acquisition
    struct Named {
        std::uint64_t frame = 0, block = 0;
    };
    Latest<Named> newest_;
    std::atomic<std::uint64_t> dropped_{0}, of_other_size_{0};
};

}  // namespace hilcam
