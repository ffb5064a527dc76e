#pragma once
// Interpolation of N functions of time by the polynomial through their samples, and through their rates as
// well if they are known (Hermite): Newton's divided differences with repeated nodes (Stoer & Bulirsch,
// Introduction to Numerical Analysis, 1980, section 2.1). No allocation.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>

namespace hilcam {

template <std::size_t N>
struct Node {
    double t = 0;  // in any unit, near 0 to 1 for best conditioning
    std::array<double, N> value{}, rate{};
};

template <std::size_t N>
struct ValueAndRate {
    std::array<double, N> value{}, rate{};
};

inline constexpr std::size_t kMaxNodes = 32;

// Interpolates through the values of nodes at different t, and through their rates if `with_rates`; at most
// kMaxNodes nodes, or half of that with rates. Up to rounding it is exact for polynomials of degree nodes -
// 1, or 2 nodes - 1 with rates. Nodes are used in order of their distance from t, so that the terms of the
// sum shrink.
template <std::size_t N>
ValueAndRate<N> polynomial_at(std::span<const Node<N>> nodes, bool with_rates, double t) {
    std::array<std::size_t, kMaxNodes> order{};
    for (std::size_t i = 0; i < nodes.size(); ++i) order[i] = i;
    std::sort(
        order.begin(), order.begin() + static_cast<std::ptrdiff_t>(nodes.size()),
        [&](std::size_t a, std::size_t b) { return std::abs(nodes[a].t - t) < std::abs(nodes[b].t - t); });
    const std::size_t repeat = with_rates ? 2 : 1, count = nodes.size() * repeat;
    const auto node = [&](std::size_t i) -> const Node<N>& { return nodes[order[i / repeat]]; };
    std::array<double, kMaxNodes> z{};
    std::array<std::array<double, N>, kMaxNodes> c{};
    for (std::size_t i = 0; i < count; ++i) z[i] = node(i).t, c[i] = node(i).value;
    for (std::size_t step = 1; step < count; ++step)
        for (std::size_t i = count - 1; i >= step; --i) {
            // The second copy of a node: its difference is the node's rate.
            const bool twice = with_rates && step == 1 && i % 2 == 1;
            for (std::size_t k = 0; k < N; ++k)
                c[i][k] = twice ? node(i).rate[k] : (c[i][k] - c[i - 1][k]) / (z[i] - z[i - step]);
        }
    ValueAndRate<N> out;
    out.value = c[count - 1];
    for (std::size_t i = count - 1; i-- > 0;)
        for (std::size_t k = 0; k < N; ++k) {
            out.rate[k] = out.rate[k] * (t - z[i]) + out.value[k];
            out.value[k] = out.value[k] * (t - z[i]) + c[i][k];
        }
    return out;
}

// Returns the first of `count` consecutive samples out of `size`, chosen so that the interval before sample
// `after` (the first one later than the instant) is as near to their middle as possible.
inline std::size_t window_start(std::size_t after, std::size_t count, std::size_t size) {
    const std::size_t half = count / 2;
    const std::size_t start = after > half ? after - half : 0;
    return start + count > size ? size - count : start;
}

}  // namespace hilcam
