#pragma once
// The words of a kernel's segment, with the checks that all readers of segments use.

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "render/vocabulary/check.h"
#include "render/vocabulary/plain_number.h"

namespace hilcam {

// Directories have every hundredth of the times before them.
inline constexpr std::size_t kDirectoryStep = 100;

class SegmentWords {
  public:
    SegmentWords(std::vector<double> words, std::string where)
        : words_(std::move(words)), where_(std::move(where)) {}

    std::size_t size() const { return words_.size(); }
    double operator[](std::size_t i) const { return words_[i]; }
    std::span<const double> piece(std::size_t from, std::size_t count) const {
        return std::span(words_).subspan(from, count);
    }
    const std::string& where() const { return where_; }
    // Throws InputError, "file: segment 3 ('NAME'): what".
    [[noreturn]] void fail(const std::string& what) const { throw InputError(where_ + ": " + what); }

    // Returns the word at this distance from the end, 1 for the last. Throws InputError when there is none.
    double from_end(std::size_t back) const {
        if (back > words_.size())
            fail("has " + std::to_string(words_.size()) + " words; accepted: a whole segment");
        return words_[words_.size() - back];
    }
    // Returns the same as an integer in a range.
    std::size_t count_from_end(std::size_t back, const char* what, double least, double most) const {
        const double value = from_end(back);
        if (!(value >= least && value <= most) || value != std::floor(value))
            fail(std::string(what) + ": found " + plain(value) + "; accepted: a whole number, " +
                 plain(least) + " to " + plain(most));
        return static_cast<std::size_t>(value);
    }
    // Refuses a segment with fewer words than its counts require. More words are accepted.
    void require_size(std::size_t words) const {
        if (words_.size() < words)
            fail("has " + std::to_string(words_.size()) + " words; its counts ask for " +
                 std::to_string(words));
    }
    void require_rising(std::size_t from, std::size_t count, const char* what) const {
        for (std::size_t i = 1; i < count; ++i)
            if (!(words_[from + i] > words_[from + i - 1]))
                fail(std::string(what) + " " + std::to_string(i + 1) + ": found " + plain(words_[from + i]) +
                     " after " + plain(words_[from + i - 1]) + "; accepted: times that rise");
    }

  private:
    std::vector<double> words_;
    std::string where_;
};

// The largest count in a segment; products of such counts are far below the range of std::size_t.
inline constexpr double kMaxRecords = 1e9;

// Returns the number of times that are not above t.
inline std::size_t times_up_to(std::span<const double> times, double t) {
    return static_cast<std::size_t>(std::upper_bound(times.begin(), times.end(), t) - times.begin());
}

}  // namespace hilcam
