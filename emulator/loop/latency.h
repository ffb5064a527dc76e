#pragma once
// A histogram of durations. The loop and the senders record without lock or allocation; any thread may read.

#include <array>
#include <atomic>
#include <cstdint>
#include <vector>

namespace hilcam {

// Buckets grow by 1/32 of an octave, from 1 us to over an hour, so percentiles are right within 2.2 %.
class DurationHistogram {
  public:
    void record(std::int64_t ns);  // any thread
    void record_ms(double ms) { record(static_cast<std::int64_t>(ms * 1e6)); }
    // Forgets all records. Any thread; a record made meanwhile may be kept or lost.
    void clear();
    std::uint64_t count() const { return count_.load(std::memory_order_relaxed); }
    // Returns the longest duration, exactly; 0 without records.
    double max_ms() const { return 1e-6 * static_cast<double>(max_ns_.load(std::memory_order_relaxed)); }
    // Returns the duration [ms] that a share `q` of the records does not exceed; 0 without records.
    double quantile_ms(double q) const;

    // Raw buckets. The difference of two readings (modulo 2^32) has the records made in between.
    static constexpr int kPerOctave = 32;
    static constexpr int kOctaves = 32;
    using Counts = std::array<std::uint32_t, kPerOctave * kOctaves>;
    void read(Counts& counts) const;  // any thread
    static double quantile_ms(const Counts& counts, double q);

    // Records by quarters of an octave, for drawing: from the first bucket with records to the last.
    struct Bucket {
        double from_ms = 0;  // upper end: the next bucket's from_ms, 2^(1/4) times as much
        std::uint64_t count = 0;
    };
    std::vector<Bucket> quarter_octaves() const;

  private:
    std::array<std::atomic<std::uint32_t>, kPerOctave * kOctaves> buckets_{};
    std::atomic<std::uint64_t> count_{0};
    std::atomic<std::int64_t> max_ns_{0};
};

}  // namespace hilcam
