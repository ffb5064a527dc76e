#pragma once
// Durations as a histogram: recorded from the loop and the senders without lock or allocation, read by
// anyone.

#include <array>
#include <atomic>
#include <cstdint>
#include <vector>

#include "io/contract/frame_sink.h"

namespace hilcam {

// Buckets grow by 1/32 of an octave from 1 us to over an hour: percentiles are right within 2.2 %.
class DurationHistogram {
  public:
    void record(std::int64_t ns);  // any thread
    void record_ms(double ms) { record(static_cast<std::int64_t>(ms * 1e6)); }
    // Forgets what was recorded. Any thread; what is recorded meanwhile may stay or go.
    void clear();
    std::uint64_t count() const { return count_.load(std::memory_order_relaxed); }
    // The duration [ms] that a share `q` of the records does not exceed; 0 without records.
    double quantile_ms(double q) const;

    // The buckets as they are now. Less those of an earlier instant (modulo 2^32): what came in between.
    static constexpr int kPerOctave = 32;
    static constexpr int kOctaves = 32;
    using Counts = std::array<std::uint32_t, kPerOctave * kOctaves>;
    void read(Counts& counts) const;  // any thread
    static double quantile_ms(const Counts& counts, double q);

    // The records by quarters of an octave, for drawing: from the first that has one to the last.
    struct Bucket {
        double from_ms = 0;  // to that of the next, 2^(1/4) times as much
        std::uint64_t count = 0;
    };
    std::vector<Bucket> quarter_octaves() const;

  private:
    std::array<std::atomic<std::uint32_t>, kPerOctave * kOctaves> buckets_{};
    std::atomic<std::uint64_t> count_{0};
};

// Latency of delivered frames, from the arrival of the newest command that a frame is the first to show, and
// from its exposure's middle.
class DeliveryMeter : public DeliveryListener {
  public:
    void delivered(const FrameRecord& record, std::int64_t first_ns, std::int64_t last_ns) noexcept override;

    DurationHistogram command_to_first, command_to_last, exposure_to_last;
};

}  // namespace hilcam
