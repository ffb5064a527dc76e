#pragma once
// The times of delivered frames: from the arrival of the newest command that a frame is the first to show, to
// the middle of its exposure, to its first packet, to its last one.
//
//     command      arrival of that command (the kernel's time for UDP); other frames have none
//     exposure     middle of the exposure. It may come before the command: a frame is computed when its
//                  exposure begins or later, with the newest command. The step then counts as 0
//     first, last  begin and end of sending the packets, or the copy that v4l2, uvc and shm hand over
//
// All on CLOCK_MONOTONIC. Frames in lockstep have no exposure on that clock, so they have only the times from
// their command to their packets. Each output has an OutputMeter of its own, and its thread alone writes
// that; all of a camera share the histograms of a DeliveryMeter.

#include <array>
#include <span>
#include <vector>

#include "emulator/loop/latency.h"
#include "emulator/scenario/run_bounds.h"
#include "io/contract/frame_sink.h"
#include "io/contract/loss_count.h"

namespace hilcam {

// Histograms of a camera's frames. Any thread.
struct DeliveryMeter {
    DurationHistogram command_to_exposure, exposure_to_first, first_to_last;  // the steps
    DurationHistogram command_to_first, command_to_last, exposure_to_last;    // sums of steps
    DurationHistogram judged;  // command_to_last of the frames that the run's bounds are for
};

// Times of one frame [ns of CLOCK_MONOTONIC]; 0: there is none.
struct Delivery {
    std::uint64_t frame = 0;
    TimeTai exposure_mid;  // simulated time
    std::int64_t command_ns = 0, exposure_ns = 0, first_ns = 0, last_ns = 0;
};

// Keeps the frames with the longest latencies. One thread writes; others read it once that has ended.
class LatestFrames {
  public:
    static constexpr std::size_t kMax = 10;
    struct Entry {
        std::int64_t latency_ns = 0;
        Delivery delivery;
    };
    void offer(std::int64_t latency_ns, const Delivery& delivery) noexcept;
    std::span<const Entry> entries() const { return std::span(entries_).first(count_); }

  private:
    std::array<Entry, kMax> entries_{};
    std::size_t count_ = 0;
};
// Returns the kMax longest latencies of all these, the longest first.
std::vector<LatestFrames::Entry> merged(std::span<const LatestFrames::Entry> a,
                                        std::span<const LatestFrames::Entry> b);

// Counts the frames whose latency exceeds a bound. One thread writes. Others read after it has been joined.
struct FramesAbove {
    std::uint64_t frames = 0, first = 0;  // first: id of the first one; 0: none
    std::int64_t max_ns = 0;              // longest latency of all frames that count, above the bound or not
    void record(std::uint64_t frame, std::int64_t latency_ns, double bound_s) noexcept;
    void add(const FramesAbove& other) noexcept;
};

class OutputMeter : public DeliveryListener {
  public:
    // clocked: exposures have a time on CLOCK_MONOTONIC. all: outlives it.
    OutputMeter(DeliveryMeter& all, const RunBounds& bounds, bool clocked)
        : all_(all), bounds_(bounds), clocked_(clocked) {}
    void delivered(const FrameRecord& record, std::int64_t first_ns, std::int64_t last_ns) noexcept override;

    const LatestFrames& from_command() const { return from_command_; }
    const LatestFrames& from_exposure() const { return from_exposure_; }
    const FramesAbove& above_latency() const { return above_latency_; }
    const FramesAbove& above_p999() const { return above_p999_; }
    const FramesAbove& above_exposure() const { return above_exposure_; }
    // Returns the number of frames that were compared with the bound on exposure latency.
    std::uint64_t judged_exposures() const { return judged_exposures_; }

  private:
    void record_command(const Delivery& d) noexcept;
    void record_exposure(const Delivery& d) noexcept;
    bool counts(const Delivery& d) const { return d.frame >= static_cast<std::uint64_t>(bounds_.from_frame); }

    DeliveryMeter& all_;
    RunBounds bounds_;
    bool clocked_;
    LatestFrames from_command_, from_exposure_;
    FramesAbove above_latency_, above_p999_, above_exposure_;
    std::uint64_t judged_exposures_ = 0;
};

}  // namespace hilcam
