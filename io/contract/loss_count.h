#pragma once
// Counts what was lost, frames or packets, and remembers the first frame that it concerns.

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <initializer_list>

namespace hilcam {

class LossCount {
  public:
    // Any thread; neither locks nor allocates. frame: id of the frame, from 1.
    void add(std::uint64_t frame, std::uint64_t count = 1) noexcept {
        if (count == 0) return;
        std::uint64_t none = 0;
        first_.compare_exchange_strong(none, frame, std::memory_order_relaxed);
        count_.fetch_add(count, std::memory_order_relaxed);
    }
    std::uint64_t count() const noexcept { return count_.load(std::memory_order_relaxed); }
    // Returns the first frame's id; 0: nothing was lost.
    std::uint64_t first() const noexcept { return first_.load(std::memory_order_relaxed); }

  private:
    std::atomic<std::uint64_t> count_{0}, first_{0};
};

// Returns the smallest of these ids of frames that is not 0; 0 when all are.
inline std::uint64_t first_of(std::initializer_list<std::uint64_t> frames) {
    std::uint64_t first = 0;
    for (const std::uint64_t frame : frames)
        if (frame != 0) first = first == 0 ? frame : std::min(first, frame);
    return first;
}

}  // namespace hilcam
