#include "render/sky/air_refraction.h"

#include <algorithm>
#include <cmath>

#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

constexpr double kLevelStep_m = 1000;
// Layers of the sums; log n is linear in n r inside one. Twice as many change no turn by more than 1e-5.
constexpr int kLayersOfStep = 40;

// A ray from its observer: its angle from straight down, and its vertical plane.
struct Sideways {
    Vec3d up, ahead;  // ahead: its length is the sine
    double sine, cosine;
    Sideways(Vec3d origin_m, Vec3d dir) : up(normalized(origin_m)), cosine(-dot(up, dir)) {
        ahead = dir + cosine * up;
        sine = length(ahead);
    }
    // Returns the straight line that is turned by an angle towards the middle and passes it at a distance. It
    // starts as far out as the observer, or where it is closest if that is farther out.
    AirRefraction::Line line(double turn_rad, double closest_m, double radius_m) const {
        const double c = std::cos(turn_rad), s = std::sin(turn_rad);
        const double sine_there = sine * c - cosine * s, cosine_there = cosine * c + sine * s;
        const Vec3d along = (1 / sine) * ahead;
        const Vec3d dir = normalized(sine_there * along - cosine_there * up),
                    closest = sine_there * up + cosine_there * along;
        const double back_m = std::sqrt(std::max(0.0, (radius_m - closest_m) * (radius_m + closest_m)));
        return {closest_m * closest - (cosine >= 0 ? back_m : -back_m) * dir, dir};
    }
};

// Rays straight down or up are not bent: the sine below which a ray counts as such.
constexpr double kStraight = 1e-9;

}  // namespace

double air_refractivity(double wavelength_um) {
    const double wave_number2 = 1 / (wavelength_um * wavelength_um);
    return 1e-8 * (5792105 / (238.0185 - wave_number2) + 167917 / (57.362 - wave_number2));
}

double air_refractivity(const SpectralGrid& grid) {
    double sum = 0;
    for (int b = 0; b < grid.size(); ++b) sum += air_refractivity(grid.from_um(b) + 0.5 * grid.width_um(b));
    return sum / grid.size();
}

AirRefraction::AirRefraction(double refractivity, double (*density)(double height_m), double ground_m,
                             double top_m)
    : ground_m_(ground_m), top_m_(ground_m + top_m) {
    const auto count = static_cast<std::size_t>(std::ceil(top_m / kLevelStep_m)) + 1;
    for (std::size_t i = 0; i < count; ++i) {
        const double height_m = top_m * static_cast<double>(i) / static_cast<double>(count - 1);
        const double here = i + 1 == count ? 0 : refractivity * density(height_m);
        levels_.push_back({(1 + here) * (ground_m + height_m), height_m, 0, 0, 0, here});
    }
    sum_turns(refractivity, density);
    max_turn_rad_ = 2 * levels_.front().turn_rad;
}

void AirRefraction::sum_turns(double refractivity, double (*density)(double height_m)) {
    struct Layer {
        double from_m, to_m, slope;  // by n r; -d ln n over d (n r)
    };
    const std::size_t steps = levels_.size() - 1, count = steps * kLayersOfStep;
    const double thick_m = levels_.back().height_m / static_cast<double>(count);
    std::vector<Layer> layers;
    for (std::size_t i = 0; i < count; ++i) {
        const auto n_at = [&](std::size_t k) {
            return 1 + (k == count ? 0 : refractivity * density(static_cast<double>(k) * thick_m));
        };
        const double low = n_at(i), high = n_at(i + 1);
        const double from_m = low * (ground_m_ + static_cast<double>(i) * thick_m),
                     to_m = high * (ground_m_ + static_cast<double>(i + 1) * thick_m);
        layers.push_back({from_m, to_m, std::log(low / high) / (to_m - from_m)});
    }
    for (std::size_t k = 0; k < levels_.size(); ++k) {
        const double a = levels_[k].impact_m;
        // acosh(x / a) without loss of digits near a.
        const auto angle = [a](double x) {
            const double over = std::max(0.0, (x - a) / a);
            return std::log1p(over + std::sqrt(over * (2 + over)));
        };
        for (std::size_t i = k * kLayersOfStep; i < count; ++i)
            levels_[k].turn_rad += a * layers[i].slope * (angle(layers[i].to_m) - angle(layers[i].from_m));
    }
    // The slopes are those of the parabola through three levels.
    for (std::size_t k = 0; k <= steps; ++k) {
        const std::size_t m = std::clamp<std::size_t>(k, 1, steps - 1);
        const Level &low = levels_[m - 1], &middle = levels_[m], &high = levels_[m + 1];
        const auto slope = [&](double Level::*value) {
            const double before = (middle.*value - low.*value) / (middle.impact_m - low.impact_m),
                         after = (high.*value - middle.*value) / (high.impact_m - middle.impact_m);
            const double bend = (after - before) / (high.impact_m - low.impact_m);
            return before + bend * (2 * levels_[k].impact_m - low.impact_m - middle.impact_m);
        };
        levels_[k].height_slope = slope(&Level::height_m);
        levels_[k].turn_slope = slope(&Level::turn_rad);
    }
}

// Returns the lowest point of a ray that does not meet the ground, and its turn from there to space. Rays below
// the lowest level have its values; rays above the highest are straight.
AirRefraction::Lowest AirRefraction::lowest(double impact_m) const {
    if (!(impact_m < levels_.back().impact_m)) return {impact_m - ground_m_, {}};
    if (impact_m <= edge_m()) return {levels_.front().height_m, {levels_.front().turn_rad, 0}};
    // Impact radii are at most two kilometres higher than their levels.
    const double step_m = levels_[1].height_m;
    auto i = std::min(static_cast<std::size_t>((impact_m - ground_m_) / step_m), levels_.size() - 2);
    while (levels_[i].impact_m > impact_m) --i;
    const Level &low = levels_[i], &high = levels_[i + 1];
    // Hermite cubic.
    const double wide_m = high.impact_m - low.impact_m, t = (impact_m - low.impact_m) / wide_m, s = 1 - t;
    const auto between = [&](double a, double b, double a_slope, double b_slope) {
        return s * s * (1 + 2 * t) * a + t * t * (1 + 2 * s) * b +
               t * s * wide_m * (s * a_slope - t * b_slope);
    };
    const double slope = 6 * s * t * (high.turn_rad - low.turn_rad) / wide_m +
                         s * (1 - 3 * t) * low.turn_slope + t * (1 - 3 * s) * high.turn_slope;
    return {between(low.height_m, high.height_m, low.height_slope, high.height_slope),
            {between(low.turn_rad, high.turn_rad, low.turn_slope, high.turn_slope), slope}};
}

double AirRefraction::refractivity_at(double radius_m) const {
    const double at = std::max(0.0, (radius_m - ground_m_) / levels_[1].height_m);
    const auto i = static_cast<std::size_t>(at);
    if (i + 1 >= levels_.size()) return 0;
    const double low = levels_[i].refractivity, high = levels_[i + 1].refractivity,
                 t = at - static_cast<double>(i);
    // Exponential between levels, linear down to zero at the last one.
    return high > 0 ? low * std::pow(high / low, t) : low * (1 - t);
}

struct AirRefraction::Observer {
    double radius_m, refractivity;
    double whole_m() const { return (1 + refractivity) * radius_m; }  // impact of a level ray
};

// Returns the turn of a ray from the observer up to space.
double AirRefraction::turn_outwards(const Observer& from, double impact_m) const {
    if (!(from.refractivity > 0)) return 0;
    const double x = from.whole_m(), level_turn = lowest(x).turn.rad;
    if (!(level_turn > 0)) return 0;
    const double ratio = from.refractivity / level_turn, scale_m = 0.5 * kPi * x * ratio * ratio;
    // erfcx(q) = c / ((c - 1) sqrt(pi) q + sqrt(pi q^2 + c^2)), numerator and denominator times sqrt(2 a H).
    constexpr double kRen = 2.7889;
    const double s = std::sqrt(kPi * std::max(0.0, (x - impact_m) * (x + impact_m)));
    return level_turn * kRen * impact_m * std::sqrt(2 * scale_m / x) /
           ((kRen - 1) * s + std::sqrt(s * s + 2 * kRen * kRen * impact_m * scale_m));
}

// A bent ray: its turn up to its lowest point or the ground, the distance closest_m of the straight line
// through that place from the middle, and its turn up to space.
struct AirRefraction::Way {
    Sideways ray;
    double radius_m, impact_m;
    bool straight = false, to_ground = false;
    double turn_rad = 0, closest_m = 0, turn_beyond_rad = 0;
};

AirRefraction::Way AirRefraction::way_of(Vec3d origin_m, Vec3d dir) const {
    const double radius_m = length(origin_m);
    const Observer here{radius_m, refractivity_at(radius_m)};
    Way out{Sideways(origin_m, dir), radius_m, 0};
    out.impact_m = here.whole_m() * out.ray.sine;
    out.straight = !(out.ray.sine > kStraight) || !(out.impact_m < levels_.back().impact_m);
    if (out.straight) return out;
    const double behind = turn_outwards(here, out.impact_m);
    if (out.ray.cosine <= 0) {
        out.turn_beyond_rad = behind, out.closest_m = radius_m * out.ray.sine;
        return out;
    }
    out.to_ground = out.impact_m <= edge_m();
    if (out.to_ground) {
        const double turn_rad = turn_outwards({ground_m_, levels_.front().refractivity}, out.impact_m);
        out.turn_rad = turn_rad - behind, out.closest_m = out.impact_m * (ground_m_ / edge_m());
        return out;
    }
    const Lowest there = lowest(out.impact_m);
    out.turn_rad = there.turn.rad - behind, out.closest_m = ground_m_ + there.height_m;
    out.turn_beyond_rad = out.turn_rad + there.turn.rad;
    return out;
}

AirRefraction::Line AirRefraction::within(Vec3d origin_m, Vec3d dir) const {
    const Way way = way_of(origin_m, dir);
    if (way.straight || way.ray.cosine <= 0) return {origin_m, dir};
    return way.ray.line(way.turn_rad, way.closest_m, way.radius_m);
}

AirRefraction::Line AirRefraction::beyond(Vec3d origin_m, Vec3d dir) const {
    const Way way = way_of(origin_m, dir);
    if (way.straight) return {origin_m, dir};
    if (way.to_ground) return way.ray.line(way.turn_rad, way.closest_m, way.radius_m);
    return way.ray.line(way.turn_beyond_rad, way.impact_m, way.radius_m);
}

// Returns the whole turn of a ray at an angle from straight down. A ray that meets the ground counts as if it
// grazed it.
AirRefraction::Turn AirRefraction::turn_seen(const Observer& from, double nadir_rad) const {
    const bool down = nadir_rad < 0.5 * kPi;
    const double whole_m = from.whole_m(), impact_m = whole_m * std::sin(nadir_rad),
                 per_rad = whole_m * std::cos(nadir_rad);
    const double counted_m = down ? std::max(impact_m, edge_m()) : impact_m;
    Turn out{};
    if (down) {
        const Turn half = lowest(counted_m).turn;
        out = {2 * half.rad, 2 * half.slope * per_rad};
    }
    if (!(from.refractivity > 0)) return out;
    constexpr double kApart_m = 1;
    const double low = turn_outwards(from, std::max(0.0, counted_m - kApart_m)),
                 high = turn_outwards(from, std::min(counted_m + kApart_m, whole_m));
    const double sign = down ? -1 : 1;
    out.rad += sign * turn_outwards(from, counted_m);
    out.slope += sign * (high - low) / (2 * kApart_m) * per_rad;
    return out;
}

AirRefraction::Seen AirRefraction::seen_at(Vec3d origin_m, Vec3d dir, double distance_m) const {
    const Sideways ray(origin_m, dir);
    const double radius_m = length(origin_m);
    const Observer here{radius_m, refractivity_at(radius_m)};
    const double whole_m = here.whole_m();
    const bool down = ray.cosine > 0;
    // Straight, or too high to be moved by the air.
    if (!(ray.sine > kStraight) ||
        !(down ? whole_m * ray.sine < levels_.back().impact_m : here.refractivity > 0))
        return {dir, 1};
    double point_radius_m = distance_m, there_rad = 0;
    if (std::isfinite(distance_m)) {
        const Vec3d point_m = origin_m + distance_m * dir;
        point_radius_m = length(point_m);
        // In the air, or in front of it.
        if (point_radius_m < top_m_ || dot(point_m, dir) <= 0) return {dir, 1};
        there_rad = std::asin(std::min(1.0, radius_m * ray.sine / point_radius_m));
    }
    const double nadir_rad = std::atan2(ray.sine, ray.cosine);
    // Returns by how much an apparent direction is too high: from the angle between observer and point at the
    // middle that it gives.
    const auto too_high = [&](double seen_rad, Turn turn) {
        const double there = std::min(1.0, whole_m * std::sin(seen_rad) / point_radius_m);
        return seen_rad - turn.rad - nadir_rad + std::asin(there) - there_rad;
    };
    // Newton's rule, or bisection where Newton leaves the bracket. There is one solution: the apparent angle
    // grows with the true one, because turns fall with height.
    const double edge_rad = edge_m() < whole_m ? std::asin(edge_m() / whole_m) : 0.5 * kPi;
    double low = std::max(nadir_rad, edge_rad), high = std::min(nadir_rad + max_turn_rad_, kPi),
           seen_rad = low;
    Turn turn = turn_seen(here, seen_rad);
    if (!(too_high(seen_rad, turn) < 0)) return {dir, 1};  // behind the ground
    constexpr double kClose_rad = 1e-12;
    for (int i = 0; i < 60; ++i) {
        const double off = too_high(seen_rad, turn);
        (off < 0 ? low : high) = seen_rad;
        double next = seen_rad - off / (1 - turn.slope);
        if (!(next >= low && next <= high)) next = 0.5 * (low + high);
        const bool close = std::abs(next - seen_rad) < kClose_rad;
        seen_rad = next, turn = turn_seen(here, seen_rad);
        if (close) break;
    }
    // Magnification of the image by the air, vertical and horizontal.
    return {ray.line(nadir_rad - seen_rad, 0, radius_m).dir,
            std::sin(seen_rad) / (ray.sine * std::max(1.0, 1 - turn.slope))};
}

double AirRefraction::apparent_height_m(double height_m) const {
    return height_m + refractivity_at(ground_m_ + height_m) * (ground_m_ + height_m);
}

namespace {

// Returns a line in the body's axes, with a direction of the given length.
AirRefraction::Line unstretched(const Figure& figure, const AirRefraction::Line& line, double length_m) {
    const double flatter = figure.polar_radius_m / figure.equatorial_radius_m;
    const Vec3d o = line.origin_m, d{line.dir.x, line.dir.y, line.dir.z * flatter};
    return {{o.x, o.y, o.z * flatter}, (length_m / length(d)) * d};
}

}  // namespace

AirRefraction::Line line_within(const AirRefraction& air, const Figure& figure, Vec3d origin_m, Vec3d dir) {
    return unstretched(figure, air.within(stretched(figure, origin_m), normalized(stretched(figure, dir))),
                       length(dir));
}

AirRefraction::Line line_beyond(const AirRefraction& air, const Figure& figure, Vec3d origin_m, Vec3d dir) {
    return unstretched(figure, air.beyond(stretched(figure, origin_m), normalized(stretched(figure, dir))),
                       length(dir));
}

AirRefraction::Seen seen_through(const AirRefraction& air, const Figure& figure, Vec3d origin_m, Vec3d dir,
                                 double distance_m) {
    const Vec3d there = stretched(figure, dir);
    const AirRefraction::Seen seen =
        air.seen_at(stretched(figure, origin_m), normalized(there), distance_m * length(there) / length(dir));
    if (seen.light == 1) return {dir, 1};
    return {unstretched(figure, {{}, seen.dir}, length(dir)).dir, seen.light};
}

}  // namespace hilcam
