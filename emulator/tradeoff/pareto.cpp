#include "emulator/tradeoff/pareto.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace hilcam {
namespace {

// Sorts by time, then by error, then by order.
std::vector<std::size_t> by_time(std::span<const TimedError> points) {
    std::vector<std::size_t> order(points.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return std::tie(points[a].time_ms, points[a].error, a) <
               std::tie(points[b].time_ms, points[b].error, b);
    });
    return order;
}

std::vector<std::size_t> front_of(std::span<const TimedError> points, const std::vector<std::size_t>& by_time,
                                  double min_gain) {
    std::vector<std::size_t> front;
    for (const std::size_t i : by_time)
        if (front.empty() || (points[i].error < points[front.back()].error &&
                              points[i].error <= (1 - min_gain) * points[front.back()].error))
            front.push_back(i);
    return front;
}

// Returns 0 .. count-1 in the order of their reversed bits: 0, 4, 2, 6, 1, 5, 3, 7 for eight.
std::vector<std::size_t> spread(std::size_t count) {
    int bits = 0;
    while ((std::size_t{1} << bits) < count) ++bits;
    std::vector<std::size_t> out;
    for (std::size_t k = 0; k < std::size_t{1} << bits; ++k) {
        std::size_t reversed = 0;
        for (int b = 0; b < bits; ++b) reversed |= (k >> b & 1) << (bits - 1 - b);
        if (reversed < count) out.push_back(reversed);
    }
    return out;
}

template <class Accepts, class Better>
std::optional<std::size_t> best(std::span<const TimedError> points, const Accepts& accepts,
                                const Better& better) {
    std::optional<std::size_t> found;
    for (std::size_t i = 0; i < points.size(); ++i)
        if (accepts(points[i]) && (!found || better(points[i], points[*found]))) found = i;
    return found;
}

}  // namespace

std::vector<std::size_t> pareto_front(std::span<const TimedError> points, double min_gain) {
    return front_of(points, by_time(points), min_gain);
}

std::vector<std::size_t> by_fronts(std::span<const TimedError> points, std::size_t most, double min_gain) {
    std::vector<std::size_t> left = by_time(points), out;
    most = std::min(most, points.size());
    while (out.size() < most) {
        const std::vector<std::size_t> front = front_of(points, left, min_gain);
        for (const std::size_t place : spread(front.size())) out.push_back(front[place]);
        std::erase_if(left,
                      [&](std::size_t i) { return std::find(front.begin(), front.end(), i) != front.end(); });
    }
    out.resize(most);
    return out;
}

std::optional<std::size_t> best_within_time(std::span<const TimedError> points, double time_ms) {
    return best(
        points, [&](const TimedError& p) { return p.time_ms <= time_ms; },
        [](const TimedError& a, const TimedError& b) {
            return std::tie(a.error, a.time_ms) < std::tie(b.error, b.time_ms);
        });
}

std::optional<std::size_t> fastest_within_error(std::span<const TimedError> points, double error) {
    return best(
        points, [&](const TimedError& p) { return p.error <= error; },
        [](const TimedError& a, const TimedError& b) {
            return std::tie(a.time_ms, a.error) < std::tie(b.time_ms, b.error);
        });
}

}  // namespace hilcam
