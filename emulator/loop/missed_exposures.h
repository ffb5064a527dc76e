#pragma once
// The exposures that a loop has missed. An exposure that is skipped leaves its frame id unused; a triggered
// one that begins more than a period late keeps it.

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

namespace hilcam {

// Written by the render stage without allocation; read it when the loop has ended.
class MissedExposures {
  public:
    static constexpr std::size_t kMaxGaps = 100;
    struct Gap {
        std::uint64_t frame = 0;             // id of the first exposure missed
        std::uint64_t exposures = 0;         // number of exposures missed in a row
        bool late = false;                   // true: it was not skipped, but triggered late
        std::int64_t before_mid_tai_ns = 0;  // middle of the exposure that came then, simulated time
    };

    // from_frame: the first exposure that counts for counted().
    explicit MissedExposures(std::uint64_t from_frame = 1) : from_frame_(from_frame) {}

    // frame: the one that came after `skipped` others, or came late itself.
    void note(std::uint64_t frame, std::uint64_t skipped, bool late, std::int64_t mid_tai_ns) noexcept {
        if (skipped > 0) add({frame - skipped, skipped, false, mid_tai_ns});
        if (late) add({frame, 1, true, mid_tai_ns});
    }

    // Returns the first kMaxGaps gaps; gap_count() is the number of all.
    std::span<const Gap> gaps() const { return std::span(gaps_).first(std::min(gap_count_, kMaxGaps)); }
    std::size_t gap_count() const { return gap_count_; }
    // Returns how many exposures from `from_frame` on were missed, and the id of the first; 0: none.
    std::uint64_t counted() const { return counted_; }
    std::uint64_t first_counted() const { return first_counted_; }

  private:
    void add(const Gap& gap) noexcept {
        if (gap_count_ < kMaxGaps) gaps_[gap_count_] = gap;
        ++gap_count_;
        const std::uint64_t end = gap.frame + gap.exposures, begin = std::max(gap.frame, from_frame_);
        if (end <= begin) return;
        if (counted_ == 0) first_counted_ = begin;
        counted_ += end - begin;
    }

    std::uint64_t from_frame_;
    std::array<Gap, kMaxGaps> gaps_{};
    std::size_t gap_count_ = 0;
    std::uint64_t counted_ = 0, first_counted_ = 0;
};

}  // namespace hilcam
