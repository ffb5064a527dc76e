#pragma once
// Formats the line that Progress writes.

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

// Returns the interval between two lines of a log from the text of $HILCAM_PROGRESS_S: 30 s without a valid
// number; 0: no lines.
double seconds_between_lines(const char* text);
// "8 s", "2 min 5 s", "1 h 3 min".
std::string duration_text(double seconds);
// Returns the time left at the present pace; nothing in the first second, or before one percent is done.
std::optional<double> left_s(const ProgressItem& item);
// Returns "tradeoff 34 %, 12 s, about 23 s left: loading target.glb", cut to max_columns. items: the
// outermost first, at least one.
std::string progress_text(const std::vector<ProgressItem>& items, std::size_t max_columns);

}  // namespace hilcam
