#pragma once
// Which of many settings are worth having: those that no other beats in both time and error.

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace hilcam {

struct TimedError {
    double time_ms = 0;
    double error = 0;  // finite, as the time
};

// The front, as indices by rising time and falling error. Of equal ones the first. A step to a slower one
// must lower the error by at least this share, so that the clock's own unsteadiness makes no front.
std::vector<std::size_t> pareto_front(std::span<const TimedError> points, double min_gain = 0);

// Fronts one behind the other: the front, the front of what is left, and so on; `most` points at most. Each
// front in an order of which every beginning is spread over all of it (van der Corput's sequence), so that
// one can stop at any time.
std::vector<std::size_t> by_fronts(std::span<const TimedError> points, std::size_t most, double min_gain = 0);

// Of the least error that takes no longer; none if all take longer.
std::optional<std::size_t> best_within_time(std::span<const TimedError> points, double time_ms);
// The fastest whose error is no greater; none if all have greater ones.
std::optional<std::size_t> fastest_within_error(std::span<const TimedError> points, double error);

}  // namespace hilcam
