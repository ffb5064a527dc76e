#include "render/ground/ground_cells.h"

#include <algorithm>
#include <cmath>

namespace hilcam {

GroundCells::GroundCells(double radius_m, double cell_m, std::uint32_t octave)
    : radius_m_(radius_m), bits_(0), octave_(octave) {
    // A face's edge is a quarter of a great circle; its cells are narrowest at the edges' middles, by 1.42.
    constexpr int kMaxBits = 28;
    const double narrowest_m = 0.5 * kPi * radius_m / 1.42;
    while (bits_ < kMaxBits && std::ldexp(narrowest_m, -bits_ - 1) >= cell_m) ++bits_;
}

void GroundCells::find(Vec3d middle, double reach_rad, std::vector<Cell>& cells) const {
    // Points on a square grid around the middle, half a narrowest cell apart, so that no cell is missed.
    // Points beyond a face's edge are on the next face.
    const double pitch_rad = 0.25 * kPi / 1.42 / std::ldexp(1.0, bits_);
    const double reach = std::min(reach_rad, 0.45 * kPi) + pitch_rad;
    const int steps = static_cast<int>(std::ceil(reach / pitch_rad));
    const auto [right, up] = axes_along(middle);
    const double cells_across = std::ldexp(1.0, bits_);
    const auto first = static_cast<std::ptrdiff_t>(cells.size());
    const auto index = [&](double x) {
        return static_cast<std::int32_t>(
            std::clamp(std::floor(0.5 * (x + 1) * cells_across), 0.0, cells_across - 1));
    };
    std::vector<double> tangents;
    for (int i = -steps; i <= steps; ++i) tangents.push_back(std::tan(i * pitch_rad));
    for (const double ahead : tangents)
        for (const double aside : tangents) {
            const CubePoint point = cube_point(middle + aside * right + ahead * up);
            const std::int32_t column = index(point.at.x), row = index(point.at.y);
            const std::uint64_t number = (static_cast<std::uint64_t>(point.face) << 56) |
                                         (static_cast<std::uint64_t>(row) << 28) |
                                         static_cast<std::uint64_t>(column);
            if (cells.size() == static_cast<std::size_t>(first) || cells.back().number != number)
                cells.push_back({number, point.face, column, row});
        }
    std::sort(cells.begin() + first, cells.end(),
              [](const Cell& a, const Cell& b) { return a.number < b.number; });
    cells.erase(std::unique(cells.begin() + first, cells.end(),
                            [](const Cell& a, const Cell& b) { return a.number == b.number; }),
                cells.end());
}

double GroundCells::area_m2(const Cell& cell) const {
    const double width = std::ldexp(2.0, -bits_);
    const double u = std::tan(0.25 * kPi * (-1 + (cell.column + 0.5) * width)),
                 v = std::tan(0.25 * kPi * (-1 + (cell.row + 0.5) * width));
    const double edge_rad = 0.25 * kPi * width;
    // The solid angle of du dv is du dv / (1 + u^2 + v^2)^(3/2), and du = (1 + u^2) d angle.
    return radius_m_ * radius_m_ * edge_rad * edge_rad * (1 + u * u) * (1 + v * v) /
           std::pow(1 + u * u + v * v, 1.5);
}

std::array<std::uint32_t, 4> GroundCells::words(const Cell& cell, int thing, std::uint32_t use,
                                                RandomKey seed, RandomPurpose purpose) const {
    return random_words({seed.seed, cell.number}, purpose, static_cast<std::uint32_t>(thing),
                        (octave_ << 8) | use);
}

int GroundCells::count(const Cell& cell, double mean, RandomKey seed, RandomPurpose purpose) const {
    constexpr int kMax = 255;
    constexpr std::uint32_t kCountUse = 255;
    double left = uniform(words(cell, 0, kCountUse, seed, purpose)[0]);
    double chance = std::exp(-mean);
    int count = 0;
    while (left > chance && count < kMax) {
        left -= chance;
        chance *= mean / ++count;
    }
    return count;
}

Vec3d GroundCells::direction(const Cell& cell, double x, double y) const {
    const double width = std::ldexp(2.0, -bits_);
    return cube_direction(cell.face, {-1 + (cell.column + x) * width, -1 + (cell.row + y) * width});
}

}  // namespace hilcam
