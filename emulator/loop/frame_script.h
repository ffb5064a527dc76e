#pragma once
// The part of what a frame depends on that is neither in the scenario nor in the commands that it shows, and
// the script that can dictate it.
//
// In a run of its own a loop finds a frame's use by itself (clock, live settings, governor, faults); in a
// replay a script gives it, and with it the same frame comes out again.

#include <atomic>
#include <cstdint>

#include "emulator/loop/image_faults.h"
#include "render/vocabulary/time.h"
#include "sensor/test_pattern.h"

namespace hilcam {

struct FrameUse {
    std::uint64_t id = 0;
    std::uint64_t skipped = 0;  // exposures before it that could not be taken
    bool late = false;          // a triggered frame began more than a period after its time
    bool reverse_x = false, reverse_y = false;
    TestPattern test_pattern = TestPattern::kOff;
    std::uint32_t trigger_sequence = 0;
    std::uint32_t quality_level = 0;
    // Times of the exposure, CLOCK_MONOTONIC; in lockstep as if that ran with it.
    std::int64_t begin_ns = 0, middle_ns = 0, end_ns = 0;
    TimeTai exposure_mid;         // simulated
    TimeTai shown_at;             // the world's instant that it shows
    double moving = 1;            // share of the exposure through which the world moves (ShownWorld)
    bool shutter_closed = false;  // it shows nothing
    double exposure_s = 0;
    double gain_db = 0;
    double black_level_dn = 0;
    std::int64_t binning_x = 1, binning_y = 1;
    std::uint64_t faults = 0;  // bits, as FrameRecord has them
    ImageFaults image;

    friend bool operator==(const FrameUse&, const FrameUse&) = default;
};

class FrameScript {
  public:
    virtual ~FrameScript() = default;
    // Waits for the next frame; the world's commands are then those that it shows. not_before_ns: when it may
    // be published; 0: as soon as every output has room. False at the end, or when `stopping`. Loop, one
    // thread.
    virtual bool next(const std::atomic<bool>& stopping, FrameUse& use, std::int64_t& not_before_ns) = 0;
    // The world has been seen for it. Loop.
    virtual void seen() noexcept = 0;
};

}  // namespace hilcam
