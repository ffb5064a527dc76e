#pragma once
// Data that a frame depends on besides the scenario and the commands that it shows, and an interface to
// dictate it.
//
// In a normal run the loop determines a frame's FrameUse from clock, live settings, governor and faults. In a
// replay a script supplies it, so that the same frame is made again.

#include <atomic>
#include <cstdint>

#include "emulator/loop/image_faults.h"
#include "render/vocabulary/time.h"
#include "sensor/test_pattern.h"

namespace hilcam {

struct FrameUse {
    std::uint64_t id = 0;
    std::uint64_t skipped = 0;  // exposures before it that were skipped
    bool late = false;          // true: a triggered frame that began more than a period after its time
    bool reverse_x = false, reverse_y = false;
    TestPattern test_pattern = TestPattern::kOff;
    std::uint32_t trigger_sequence = 0;
    std::uint32_t quality_level = 0;
    // Times of the exposure on CLOCK_MONOTONIC; in lockstep, as if that clock ran with simulated time.
    std::int64_t begin_ns = 0, middle_ns = 0, end_ns = 0;
    TimeTai exposure_mid;         // in simulated time
    TimeTai shown_at;             // instant of the world that the frame shows
    double moving = 1;            // share of the exposure during which the world moves (ShownWorld)
    bool shutter_closed = false;  // true: the frame shows nothing
    double exposure_s = 0;
    double gain_db = 0;
    double black_level_dn = 0;
    std::int64_t binning_x = 1, binning_y = 1;
    std::uint64_t faults = 0;  // bits as in FrameRecord
    ImageFaults image;
    std::int64_t sequencer_set = -1;  // the sequencer's set; -1: it was off

    friend bool operator==(const FrameUse&, const FrameUse&) = default;
};

class FrameScript {
  public:
    virtual ~FrameScript() = default;
    // Waits for the next frame, and sets the world's commands to those that it shows. not_before_ns: earliest
    // time of publication; 0: as soon as every output has room. Returns false at the end, or when `stopping`.
    // Loop, one thread.
    virtual bool next(const std::atomic<bool>& stopping, FrameUse& use, std::int64_t& not_before_ns) = 0;
    // Called when the world has been sampled for the frame. Loop.
    virtual void seen() noexcept = 0;
};

}  // namespace hilcam
