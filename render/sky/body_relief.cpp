#include "render/sky/body_relief.h"

#include <algorithm>
#include <cmath>

#include "render/vocabulary/check.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

// East and north at a place; arbitrary at the poles.
struct LocalAxes {
    Vec3d east, north;
};
LocalAxes local_axes(Vec3d up) {
    const Vec3d east = up.x * up.x + up.y * up.y > 1e-18 ? normalized(Vec3d{-up.y, up.x, 0}) : Vec3d{0, 1, 0};
    return {east, cross(up, east)};
}

// No horizon of a round body's mountains is higher than this.
constexpr double kSteepest_rad = 35 * kDegree_rad;

}  // namespace

double share_above(double x) {
    if (x >= 1) return 1;
    if (x <= -1) return 0;
    return 1 - (std::acos(x) - x * std::sqrt(1 - x * x)) / kPi;
}

BodyRelief::BodyRelief(double radius_m, int width, int height, std::vector<float> heights_m)
    : radius_m_(radius_m), spacing_m_(2 * kPi * radius_m / width) {
    HILCAM_CHECK(width >= 8 && height >= 4 &&
                 heights_m.size() == static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    const auto [least, most] = std::minmax_element(heights_m.begin(), heights_m.end());
    lowest_m_ = static_cast<double>(*least), highest_m_ = static_cast<double>(*most);
    HILCAM_CHECK(std::isfinite(lowest_m_) && std::isfinite(highest_m_) && lowest_m_ > -0.5 * radius_m);
    levels_.push_back({width, height, std::move(heights_m)});
    while (levels_.back().width % 2 == 0 && levels_.back().height % 2 == 0 && levels_.back().height >= 8) {
        const Level& fine = levels_.back();
        Level coarse{fine.width / 2, fine.height / 2, {}};
        for (int y = 0; y < coarse.height; ++y)
            for (int x = 0; x < coarse.width; ++x) {
                const auto i = static_cast<std::size_t>(2 * y * fine.width + 2 * x);
                const auto below = i + static_cast<std::size_t>(fine.width);
                coarse.height_m.push_back(0.25f * (fine.height_m[i] + fine.height_m[i + 1] +
                                                   fine.height_m[below] + fine.height_m[below + 1]));
            }
        levels_.push_back(std::move(coarse));
    }
}

double BodyRelief::at(const Level& level, double u, double v) const {
    const double x = u * level.width - 0.5, y = std::clamp(v * level.height - 0.5, 0.0, level.height - 1.0);
    const double left = std::floor(x);
    const int j = std::min(static_cast<int>(y), level.height - 2);
    int i = static_cast<int>(left) % level.width;
    if (i < 0) i += level.width;
    const int next = i + 1 < level.width ? i + 1 : 0;
    const double a = x - left, b = y - j;
    const float* row = level.height_m.data() + static_cast<std::ptrdiff_t>(j) * level.width;
    const float* below = row + level.width;
    const double top = static_cast<double>(row[i]) + a * static_cast<double>(row[next] - row[i]);
    const double bottom = static_cast<double>(below[i]) + a * static_cast<double>(below[next] - below[i]);
    return top + b * (bottom - top);
}

double BodyRelief::height_m(Vec3d dir, double footprint_m) const {
    const double u = std::atan2(dir.y, dir.x) / (2 * kPi) + 0.5;
    const double v = 0.5 - std::asin(std::clamp(dir.z, -1.0, 1.0)) / kPi;
    if (footprint_m <= spacing_m_) return at(levels_.front(), u, v);
    // Linear between two levels.
    const double last = static_cast<double>(levels_.size() - 1);
    const double where = std::min(last, std::log2(footprint_m / spacing_m_));
    const auto i = static_cast<std::size_t>(where);
    const double fine = at(levels_[i], u, v);
    return i + 1 < levels_.size()
               ? fine + (where - static_cast<double>(i)) * (at(levels_[i + 1], u, v) - fine)
               : fine;
}

Vec3d BodyRelief::normal(Vec3d dir, double footprint_m) const {
    const auto [east, north] = local_axes(dir);
    const double reach_m = std::max(spacing_m_, footprint_m), turn = reach_m / radius_m_;
    double to_east, to_north;
    const double across = std::sqrt(dir.x * dir.x + dir.y * dir.y);
    if (across > 4 * turn) {
        // Along the grid's own axes, except near the poles.
        const double u = std::atan2(dir.y, dir.x) / (2 * kPi) + 0.5;
        const double v = 0.5 - std::asin(std::clamp(dir.z, -1.0, 1.0)) / kPi;
        const double du = turn / (2 * kPi * across), dv = turn / kPi;
        // Linear between two levels, like heights.
        const double where =
            std::clamp(std::log2(footprint_m / spacing_m_), 0.0, static_cast<double>(levels_.size() - 1));
        const auto i = static_cast<std::size_t>(where);
        const auto difference = [&](double u0, double v0, double u1, double v1) {
            const double fine = at(levels_[i], u1, v1) - at(levels_[i], u0, v0);
            if (where <= 0 || i + 1 == levels_.size()) return fine;
            const double coarse = at(levels_[i + 1], u1, v1) - at(levels_[i + 1], u0, v0);
            return fine + (where - static_cast<double>(i)) * (coarse - fine);
        };
        to_east = difference(u - du, v, u + du, v);
        to_north = difference(u, v + dv, u, v - dv);
    } else {
        const auto along = [&](Vec3d way) {
            return height_m(normalized(dir + turn * way), footprint_m) -
                   height_m(normalized(dir - turn * way), footprint_m);
        };
        to_east = along(east), to_north = along(north);
    }
    const double per_m = 1 / (2 * reach_m);
    return normalized(dir - (to_east * per_m) * east - (to_north * per_m) * north);
}

double BodyRelief::intersect(Vec3d origin_m, Vec3d dir) const {
    const double to_closest = -dot(origin_m, dir);
    const Vec3d closest = origin_m + to_closest * dir;
    const double miss_m = length(closest);
    // One metre more on both sides, so that the ground is always in between.
    const double outer_m = radius_m_ + highest_m_ + 1, inner_m = radius_m_ + lowest_m_ - 1;
    if (miss_m >= outer_m) return -1;
    const auto half_chord = [&](double radius_m) {
        return std::sqrt((radius_m - miss_m) * (radius_m + miss_m));
    };
    // Relative to the closest point, which keeps the digits of distant origins.
    const double begin = std::max(-half_chord(outer_m), -to_closest);
    const double end = miss_m < inner_m ? -half_chord(inner_m) : half_chord(outer_m);
    if (end <= begin) return -1;
    const auto above_m = [&](double s) {
        const Vec3d p = closest + s * dir;
        const double r = length(p);
        return r - radius_m_ - height_m(p / r);
    };
    // A steep view has one intersection: height above the ground over the descent leads to it.
    constexpr double kSteep = 0.6, kNear_m = 1;
    if (begin > -to_closest && -begin > kSteep * outer_m) {
        double s = begin;
        for (int i = 0; i < 10; ++i) {
            const Vec3d p = closest + s * dir;
            const double r = length(p), above = r - radius_m_ - height_m(p / r);
            if (std::abs(above) < kNear_m) return to_closest + s;
            s += above * r / std::max(-s, 0.3 * r);
        }
    }
    constexpr double kMaxSteps = 256;
    const double steps = std::clamp(std::ceil((end - begin) / (0.7 * spacing_m_)), 2.0, kMaxSteps);
    double before = begin, height_before = above_m(begin);
    if (height_before <= 0) return to_closest + begin;
    for (double k = 1; k <= steps; ++k) {
        double after = begin + (end - begin) * k / steps, height_after = above_m(after);
        if (height_after > 0) {
            before = after, height_before = height_after;
            continue;
        }
        // Finds the crossing by secants inside the bracket.
        for (int i = 0; i < 8 && after - before > 1e-3; ++i) {
            const double s =
                before +
                (after - before) * std::clamp(height_before / (height_before - height_after), 0.05, 0.95);
            const double height = above_m(s);
            if (std::abs(height) < kNear_m) return to_closest + s;
            if (height > 0)
                before = s, height_before = height;
            else
                after = s, height_after = height;
        }
        return to_closest + after;
    }
    return miss_m < inner_m ? to_closest + end : -1;
}

namespace {

// Returns how high the ground rises in a direction, between two angles: lower ground does not matter, and
// above the upper angle the search ends.
double horizon_between(const BodyRelief& relief, double radius_m, Vec3d place_m, Vec3d towards,
                       double min_rad, double max_rad) {
    const double r = length(place_m);
    const Vec3d up = place_m / r;
    const Vec3d flat = towards - dot(towards, up) * up;
    const double horizontal = length(flat);
    double highest = min_rad;
    if (!(horizontal > 1e-6)) return highest;
    const Vec3d way = flat / horizontal;
    const double max_m = radius_m + relief.highest_m();
    for (double s = 0.75 * relief.spacing_m();; s += 0.5 * relief.spacing_m() + 0.04 * s) {
        const Vec3d p = place_m + s * way;
        const double level_m = length(p);
        // Even the highest ground would hide no more than what was found.
        if (std::atan2(max_m - level_m, s) < highest) break;
        if (s > radius_m) break;
        const Vec3d dir = p / level_m;
        const Vec3d ground = (radius_m + relief.height_m(dir, 0.1 * s)) * dir - place_m;
        highest = std::max(highest, std::atan2(dot(ground, up), dot(ground, way)));
        if (highest > max_rad) break;
    }
    return highest;
}

}  // namespace

double BodyRelief::horizon_rad(Vec3d place_m, Vec3d towards, double highest_rad) const {
    return horizon_between(*this, radius_m_, place_m, towards, -0.5 * kPi, highest_rad);
}

double BodyRelief::sun_share(Vec3d place_m, Vec3d sun_dir, double sun_radius_rad) const {
    const double elevation = std::asin(std::clamp(dot(place_m, sun_dir) / length(place_m), -1.0, 1.0));
    if (elevation - sun_radius_rad > kSteepest_rad) return 1;
    const double horizon = horizon_between(*this, radius_m_, place_m, sun_dir, elevation - sun_radius_rad,
                                           elevation + sun_radius_rad);
    return share_above((elevation - horizon) / sun_radius_rad);
}

}  // namespace hilcam
