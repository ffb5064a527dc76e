#include "render/sky/star_sky.h"

#include <array>
#include <cstdint>
#include <numeric>

namespace hilcam {
namespace {

constexpr double kStarsPerCell = 100;
// A face has at most so many by as many: more would cost a frame more to look through than they save.
constexpr int kMaxCellsAcross = 64;

// On the face of the cube that the direction meets, in cells that are about equally wide as seen from the
// middle.
std::uint32_t cell_of(Vec3d dir, int across) {
    const std::array<double, 3> d{dir.x, dir.y, dir.z};
    std::size_t axis = 0;
    for (std::size_t i = 1; i < 3; ++i)
        if (std::abs(d[i]) > std::abs(d[axis])) axis = i;
    const auto place = [&](double along) {
        const double angle = std::atan(along / std::abs(d[axis]));  // -pi/4 .. pi/4
        return std::clamp(static_cast<int>((angle / (kPi / 2) + 0.5) * across), 0, across - 1);
    };
    const int face = 2 * static_cast<int>(axis) + (d[axis] < 0 ? 1 : 0);
    return static_cast<std::uint32_t>((face * across + place(d[(axis + 1) % 3])) * across +
                                      place(d[(axis + 2) % 3]));
}

}  // namespace

StarSky::StarSky(std::vector<Star> stars, TimeTai time) : time_(time) {
    const auto across =
        std::clamp(static_cast<int>(std::sqrt(static_cast<double>(stars.size()) / (6 * kStarsPerCell))), 1,
                   kMaxCellsAcross);
    std::vector<std::uint32_t> cell(stars.size());
    for (std::size_t i = 0; i < stars.size(); ++i) cell[i] = cell_of(stars[i].world_dir, across);
    std::vector<std::size_t> order(stars.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return cell[a] < cell[b]; });

    stars_.reserve(stars.size());
    for (const std::size_t i : order) {
        stars_.push_back(stars[i]);
        fastest_rad_yr_ = std::max(fastest_rad_yr_, static_cast<double>(length(stars[i].motion_rad_yr)));
        max_parallax_rad_ = std::max(max_parallax_rad_, static_cast<double>(stars[i].parallax_rad));
    }
    for (std::size_t begin = 0, end = 0; begin < order.size(); begin = end) {
        while (end < order.size() && cell[order[end]] == cell[order[begin]]) ++end;
        cells_.push_back({cone_of(begin, end), begin, end});
    }
}

StarSky::Cone StarSky::cone_of(std::size_t begin, std::size_t end) const {
    Vec3d sum;
    for (std::size_t i = begin; i < end; ++i) sum = sum + stars_[i].world_dir;
    const Vec3d axis_dir = normalized(sum);
    double angle_rad = 0;
    for (std::size_t i = begin; i < end; ++i)
        angle_rad = std::max(angle_rad, std::atan2(length(cross(stars_[i].world_dir, axis_dir)),
                                                   dot(stars_[i].world_dir, axis_dir)));
    // Rounding leaves none outside.
    return {axis_dir, angle_rad + 1e-9};
}

// How far proper motion, parallax and aberration move any star. Aberration, with w the angle to the velocity:
// sin(seen) = sin(w) / (gamma (1 + beta cos w)), which is asin(beta) from w at most (Rindler, Relativity,
// 2006, 4.3).
double StarSky::farthest_shift_rad(const StarObserver& observer) const {
    // A unit vector that is displaced by less than its length turns by the arc sine of that at most.
    const double displaced =
        std::abs(observer.years()) * fastest_rad_yr_ + length(observer.position_au()) * max_parallax_rad_;
    return (displaced < 1 ? std::asin(displaced) : kPi) + std::asin(length(observer.beta()));
}

// A grid of axes over the sky: any other axis is within half a diagonal of its cell's.
std::size_t StarSky::max_within(double angle_rad) const {
    constexpr int kAcross = 16;
    const double half_diagonal_rad = std::sqrt(0.5) * (kPi / 2) / kAcross;
    const auto along = [](int i) { return std::tan(((i + 0.5) / kAcross - 0.5) * (kPi / 2)); };
    std::size_t most = 0;
    for (int i = 0; i < kAcross; ++i)
        for (int j = 0; j < kAcross; ++j) {
            const double a = along(i), b = along(j);
            for (const Vec3d axis : {Vec3d{1, a, b}, Vec3d{-1, a, b}, Vec3d{b, 1, a}, Vec3d{b, -1, a},
                                     Vec3d{a, b, 1}, Vec3d{a, b, -1}}) {
                const Cone field(normalized(axis), angle_rad + half_diagonal_rad);
                std::size_t sum = 0;
                for (const Cell& cell : cells_)
                    if (field.touches(cell.cone)) sum += cell.end - cell.begin;
                most = std::max(most, sum);
            }
        }
    return most;
}

}  // namespace hilcam
