#include "render/sky/star_sky.h"

#include <cstdint>
#include <numeric>
#include <span>

namespace hilcam {
namespace {

constexpr std::size_t kMaxPerCell = 128;

// Groups neighbouring stars: divides them at the middle of the axis along which they extend most, until a
// cell is small enough. Calls use(from, to) for each cell.
template <class Use>
void split(const std::vector<Star>& stars, std::span<std::uint32_t> order, std::size_t first,
           const Use& use) {
    if (order.size() <= kMaxPerCell) return use(first, first + order.size());
    Vec3d least{2, 2, 2}, most{-2, -2, -2};
    for (const std::uint32_t i : order) {
        const Vec3d& d = stars[i].world_dir;
        least = {std::min(least.x, d.x), std::min(least.y, d.y), std::min(least.z, d.z)};
        most = {std::max(most.x, d.x), std::max(most.y, d.y), std::max(most.z, d.z)};
    }
    const Vec3d spread = most - least;
    const double Vec3d::*axis = spread.x >= spread.y && spread.x >= spread.z ? &Vec3d::x
                                : spread.y >= spread.z                       ? &Vec3d::y
                                                                             : &Vec3d::z;
    const std::size_t half = order.size() / 2;
    std::nth_element(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(half), order.end(),
                     [&](std::uint32_t a, std::uint32_t b) {
                         const double at = stars[a].world_dir.*axis, other = stars[b].world_dir.*axis;
                         return at != other ? at < other : a < b;
                     });
    split(stars, order.first(half), first, use);
    split(stars, order.subspan(half), first + half, use);
}

}  // namespace

StarSky::StarSky(std::vector<Star> stars, TimeTai time) : time_(time) {
    if (stars.empty()) return;
    std::vector<std::uint32_t> order(stars.size());
    std::iota(order.begin(), order.end(), std::uint32_t{0});
    std::vector<std::size_t> begins;
    split(stars, order, 0, [&](std::size_t from, std::size_t to) {
        // A cell's stars keep the catalogue's order.
        std::sort(order.begin() + static_cast<std::ptrdiff_t>(from),
                  order.begin() + static_cast<std::ptrdiff_t>(to));
        begins.push_back(from);
    });
    begins.push_back(stars.size());
    stars_.reserve(stars.size());
    for (const std::uint32_t i : order) {
        stars_.push_back(stars[i]);
        fastest_rad_yr_ = std::max(fastest_rad_yr_, static_cast<double>(length(stars[i].motion_rad_yr)));
        max_parallax_rad_ = std::max(max_parallax_rad_, static_cast<double>(stars[i].parallax_rad));
    }
    for (std::size_t i = 0; i + 1 < begins.size(); ++i)
        cells_.push_back({cone_of(begins[i], begins[i + 1]), begins[i], begins[i + 1]});
}

StarSky::Cone StarSky::cone_of(std::size_t begin, std::size_t end) const {
    Vec3d sum;
    for (std::size_t i = begin; i < end; ++i) sum = sum + stars_[i].world_dir;
    const Vec3d axis_dir = normalized(sum);
    double angle_rad = 0;
    for (std::size_t i = begin; i < end; ++i)
        angle_rad = std::max(angle_rad, angle_between_rad(stars_[i].world_dir, axis_dir));
    // With a margin for rounding.
    return {axis_dir, angle_rad + 1e-9};
}

// Returns how far proper motion, parallax and aberration can move any star. Aberration, with w the angle to
// the velocity, gives sin(seen) = sin(w) / (gamma (1 + beta cos w)), which differs from w by at most
// asin(beta) (Rindler, Relativity, 2006, 4.3).
double StarSky::farthest_shift_rad(const StarObserver& observer) const {
    // A unit vector that is displaced by less than its length turns by at most the arc sine of that.
    const double displaced =
        std::abs(observer.years()) * fastest_rad_yr_ + length(observer.position_au()) * max_parallax_rad_;
    return (displaced < 1 ? std::asin(displaced) : kPi) + std::asin(length(observer.beta()));
}

// A grid of axes over the sky: any other axis is within half a diagonal of its cell.
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
