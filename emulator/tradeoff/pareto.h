#pragma once
// Finds which of many settings are worthwhile: those that no other beats in both time and error.

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace hilcam {

struct TimedError {
    double time_ms = 0;
    double error = 0;  // finite, like the time
};

// Returns the front as indices, by rising time and falling error. The first of equal points counts. A
// slower point must lower the error by at least min_gain (a share), so that the scatter of the clock makes no
// front.
std::vector<std::size_t> pareto_front(std::span<const TimedError> points, double min_gain = 0);

// Returns successive fronts: the front, the front of the remaining points, and so on, at most `most` points.
// Points of a front come in an order of which every beginning is spread over the whole front (van der
// Corput's sequence), so that one can stop at any time.
std::vector<std::size_t> by_fronts(std::span<const TimedError> points, std::size_t most, double min_gain = 0);

// Returns the point with the least error that takes no longer than time_ms; nothing if all take longer.
std::optional<std::size_t> best_within_time(std::span<const TimedError> points, double time_ms);
// Returns the fastest point with at most this error; nothing if all have more.
std::optional<std::size_t> fastest_within_error(std::span<const TimedError> points, double error);

}  // namespace hilcam
