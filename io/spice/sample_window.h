#pragma once
// The samples that an interpolation of SPK types 8, 9, 12, 13, 18 and CK type 5 uses at a time.

#include <algorithm>
#include <cstddef>

namespace hilcam {

struct SampleWindow {
    std::size_t first = 0, count = 0;
};

// Returns `size` of `count` samples. For an even size, half are before and half after the time; for an odd
// size they are centred on the nearest sample. after: number of samples not later than the time. Near an end
// the window is moved inwards or, if truncated, loses the samples outside.
inline SampleWindow sample_window(std::size_t after, bool next_is_nearer, std::size_t size, std::size_t count,
                                  bool truncated) {
    // The time of the last sample belongs to the interval before it.
    after = std::clamp<std::size_t>(after, 1, count > 1 ? count - 1 : 1);
    const auto middle = static_cast<std::ptrdiff_t>(after);
    const auto half = static_cast<std::ptrdiff_t>(size / 2), all = static_cast<std::ptrdiff_t>(count);
    std::ptrdiff_t first = middle - half;
    if (size % 2 == 1 && !next_is_nearer) first = middle - 1 - half;
    std::ptrdiff_t end = first + static_cast<std::ptrdiff_t>(size);
    if (truncated) {
        first = std::max<std::ptrdiff_t>(first, 0), end = std::min(end, all);
    } else {
        first = std::clamp<std::ptrdiff_t>(
            first, 0, std::max<std::ptrdiff_t>(all - static_cast<std::ptrdiff_t>(size), 0));
        end = std::min(first + static_cast<std::ptrdiff_t>(size), all);
    }
    return {static_cast<std::size_t>(first), static_cast<std::size_t>(end - first)};
}

}  // namespace hilcam
