#pragma once
// The words of the line that Progress writes.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace hilcam {

struct ProgressItem {
    std::string what;
    std::optional<double> fraction;  // 0..1
    double elapsed_s = 0;
};

// "8 s", "2 min 5 s", "1 h 3 min".
std::string duration_text(double seconds);
// By the pace so far; none in the first second, or before a hundredth is done.
std::optional<double> left_s(const ProgressItem& item);
// The outermost first; at least one. "tradeoff 34 %, 12 s, about 23 s left: loading target.glb", cut to
// max_columns.
std::string progress_text(const std::vector<ProgressItem>& items, std::size_t max_columns);

}  // namespace hilcam
