#pragma once
// Sets of numbers, built by joining pairs: union-find with path halving (Tarjan & van Leeuwen, J. ACM 31(2),
// 1984).

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace hilcam {

class JoinedSets {
  public:
    // Starts with each number below `count` as a set of its own.
    explicit JoinedSets(std::size_t count) : above_(count) { std::iota(above_.begin(), above_.end(), 0u); }
    // Returns the least number of a number's set.
    std::uint32_t of(std::uint32_t number) {
        while (above_[number] != number) number = above_[number] = above_[above_[number]];
        return number;
    }
    void join(std::uint32_t a, std::uint32_t b) {
        a = of(a), b = of(b);
        above_[std::max(a, b)] = std::min(a, b);
    }

  private:
    std::vector<std::uint32_t> above_;
};

}  // namespace hilcam
