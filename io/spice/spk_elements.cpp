// SPK types 15 and 17: orbits with elements that precess at constant rates.

#include <array>

#include "io/orbits/two_body.h"
#include "io/spice/segment_words.h"
#include "io/spice/spk_types.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

Vec3d turned(Vec3d v, Vec3d axis, double angle_rad) {
    const double c = std::cos(angle_rad), s = std::sin(angle_rad);
    return c * v + s * cross(axis, v) + (1 - c) * dot(axis, v) * axis;
}

// Type 15: the time of a periapsis passage, the orbit's pole, the direction of the periapsis, semi-latus
// rectum [km], eccentricity, a flag (1: only the node precesses, 2: only the periapsis, 3: neither; others:
// both), the central body's pole, its gravity [km^3/s^2], J2 and radius [km]. When the orbit is an ellipse
// above the body, node and periapsis precess with the true anomaly at J2's mean rates: -3/2 J2 (R/p)^2 cos i
// and 3/4 J2 (R/p)^2 (5 cos^2 i - 1) (Danby, Fundamentals of Celestial Mechanics, 2nd ed., 1988, section
// 11.15).
class PrecessingConic final : public SpkSegment {
  public:
    PrecessingConic(const SpkSummary& about, std::vector<double> given) : SpkSegment(about) {
        const SegmentWords words(std::move(given), about.where);
        words.require_size(16);
        const auto vector = [&](std::size_t at, const char* what) {
            const Vec3d v{words[at], words[at + 1], words[at + 2]};
            if (!(length(v) > 0)) words.fail(std::string(what) + ": found no direction");
            return normalized(v);
        };
        const auto above = [&](std::size_t at, const char* what, double least) {
            if (!(words[at] > least))
                words.fail(std::string(what) + ": found " + plain(words[at]) + "; accepted: above " +
                           plain(least));
            return words[at];
        };
        epoch_et_s_ = words[0];
        pole_ = vector(1, "pole of the orbit");
        const Vec3d periapsis = vector(4, "periapsis");
        const double semi_latus_km = above(7, "semi-latus rectum", 0), eccentricity = words[8];
        if (!(eccentricity >= 0))
            words.fail("eccentricity: found " + plain(eccentricity) + "; accepted: 0 and above");
        body_pole_ = vector(10, "pole of the body");
        gravity_km3_s2_ = above(13, "gravity", 0);
        const double radius_km = words[15];
        if (!(radius_km >= 0)) words.fail("radius: found " + plain(radius_km) + "; accepted: 0 and above");
        // NAIF's readers refuse gross errors only.
        if (constexpr double kUpright = 1e-5; std::abs(dot(pole_, periapsis)) > kUpright)
            words.fail("periapsis: does not lie in the orbit's plane");
        const double near_km = semi_latus_km / (1 + eccentricity);
        const double speed_km_s = std::sqrt(gravity_km3_s2_ / semi_latus_km) * (1 + eccentricity);
        start_ = {near_km * periapsis, speed_km_s * cross(pole_, periapsis)};
        if (!(eccentricity < 1 && near_km > radius_km) || words[9] == 3) return;
        const double axis_km = semi_latus_km / (1 - eccentricity * eccentricity);
        mean_motion_rad_s_ = std::sqrt(gravity_km3_s2_ / axis_km) / axis_km;
        const double cosine = dot(body_pole_, pole_);
        const double scale = 1.5 * words[14] * square(radius_km / semi_latus_km);
        if (words[9] != 2) node_rate_ = -scale * cosine;
        if (words[9] != 1) periapsis_rate_ = scale * (2.5 * cosine * cosine - 0.5);
    }

    StateVector at(double et_s) const override {
        const double since_s = et_s - epoch_et_s_;
        StateVector s = two_body_state(start_, gravity_km3_s2_, since_s);
        const double anomaly_rad = true_anomaly(s.position_m, since_s);
        for (Vec3d* v : {&s.position_m, &s.velocity_m_s})
            *v = kKilometre_m * turned(turned(*v, pole_, periapsis_rate_ * anomaly_rad), body_pole_,
                                       node_rate_ * anomaly_rad);
        return s;
    }

  private:
    double epoch_et_s_ = 0, gravity_km3_s2_ = 0;
    Vec3d pole_, body_pole_;
    StateVector start_;  // [km, km/s]
    double mean_motion_rad_s_ = 0;
    double node_rate_ = 0, periapsis_rate_ = 0;  // radians per radian of true anomaly

    // Includes whole turns, from the mean anomaly.
    double true_anomaly(Vec3d position, double since_s) const {
        const double mean_rad = mean_motion_rad_s_ * since_s, within = std::remainder(mean_rad, kTurn_rad);
        const double apart = angle_between_rad(start_.position_m, position);
        return mean_rad - within + std::copysign(apart, within);
    }
};

// Type 17, equinoctial elements relative to a body's equator: their time, semi-major axis [km], h = e
// sin(longitude of periapsis), k = e cos of it, mean longitude, p = tan(i/2) sin(node), q = tan(i/2)
// cos(node), rates of the longitude of periapsis, the mean longitude and the node [rad/s], right ascension
// and declination of the equator's pole. The x axis is the equator's node on the frame's. (Broucke & Cefola,
// Celest. Mech. 5, 303, 1972.)
class Equinoctial final : public SpkSegment {
  public:
    Equinoctial(const SpkSummary& about, std::vector<double> given) : SpkSegment(about) {
        const SegmentWords words(std::move(given), about.where);
        words.require_size(w_.size());
        for (std::size_t i = 0; i < w_.size(); ++i) w_[i] = words[i];
        if (!(w_[kAxis] > 0))
            words.fail("semi-major axis: found " + plain(w_[kAxis]) + "; accepted: above 0");
        const double eccentricity = std::hypot(w_[kH], w_[kK]);
        if (!(eccentricity <= kMaxEccentric))
            words.fail("eccentricity: found " + plain(eccentricity) + "; accepted: up to " +
                       plain(kMaxEccentric));
        if (w_[kMeanRate] == 0) words.fail("rate of the mean longitude: found 0; accepted: another number");
    }

    // Longitudes are in the orbit's plane, from the origin that the elements define by the node.
    StateVector at(double et_s) const override {
        const double since_s = et_s - w_[kEpoch];
        const auto moved = [](double sine, double cosine, double angle) {
            return std::array{sine * std::cos(angle) + cosine * std::sin(angle),
                              cosine * std::cos(angle) - sine * std::sin(angle)};
        };
        const auto [h, k] = moved(w_[kH], w_[kK], w_[kPeriapsisRate] * since_s);
        const auto [p, q] = moved(w_[kP], w_[kQ], w_[kNodeRate] * since_s);
        const double mean = w_[kMeanLongitude] + std::remainder(w_[kMeanRate] * since_s, kTurn_rad);
        const double f = eccentric_longitude(mean, h, k), s = std::sin(f), c = std::cos(f);
        const double a_m = kKilometre_m * w_[kAxis], beta = 1 / (1 + std::sqrt(1 - h * h - k * k));
        const double x = a_m * ((1 - beta * h * h) * c + h * k * beta * s - k),
                     y = a_m * ((1 - beta * k * k) * s + h * k * beta * c - h);
        // The periapsis rotates the ellipse; the remaining rate of the mean longitude is the mean anomaly's.
        const double nearer = h * s + k * c, rate = (w_[kMeanRate] - w_[kPeriapsisRate]) * a_m / (1 - nearer);
        const double along = w_[kPeriapsisRate] - w_[kNodeRate];
        const double vx = rate * (-s + h * beta * nearer) - along * y,
                     vy = rate * (c - k * beta * nearer) + along * x;
        const double over = 1 / (1 + p * p + q * q);
        const Vec3d first = over * Vec3d{1 - p * p + q * q, 2 * p * q, -2 * p},
                    second = over * Vec3d{2 * p * q, 1 + p * p - q * q, 2 * q};
        const Vec3d at = x * first + y * second;
        const Vec3d velocity = vx * first + vy * second + w_[kNodeRate] * Vec3d{-at.y, at.x, 0};
        const Mat3d turn = frame_from_equator();
        return {turn * at, turn * velocity};
    }

  private:
    enum Word : std::size_t {
        kEpoch,
        kAxis,
        kH,
        kK,
        kMeanLongitude,
        kP,
        kQ,
        kPeriapsisRate,
        kMeanRate,
        kNodeRate,
        kPoleRightAscension,
        kPoleDeclination,
        kWords
    };
    static constexpr double kMaxEccentric = 0.9;  // the limit of NAIF's reader
    std::array<double, kWords> w_{};

    Mat3d frame_from_equator() const {
        const double sa = std::sin(w_[kPoleRightAscension]), ca = std::cos(w_[kPoleRightAscension]),
                     sd = std::sin(w_[kPoleDeclination]), cd = std::cos(w_[kPoleDeclination]);
        return {{-sa, -ca * sd, ca * cd}, {ca, -sa * sd, sa * cd}, {0, cd, sd}};
    }
    // Solves Kepler's equation F + h cos F - k sin F = mean, which rises with F, by Newton's steps inside a
    // bracket.
    static double eccentric_longitude(double mean, double h, double k) {
        double low = mean - 1, high = mean + 1, f = mean;
        for (int i = 0; i < 100; ++i) {
            const double s = std::sin(f), c = std::cos(f), error = f + h * c - k * s - mean;
            (error > 0 ? high : low) = f;
            double next = f - error / (1 - h * s - k * c);
            if (!(next > low && next < high)) next = 0.5 * (low + high);
            if (std::abs(next - f) <= 1e-16 * std::abs(f)) return next;
            f = next;
        }
        return f;
    }
};

}  // namespace

std::unique_ptr<SpkSegment> make_spk_elements(const SpkSummary& about, std::vector<double> words) {
    if (about.type == 15) return std::make_unique<PrecessingConic>(about, std::move(words));
    return std::make_unique<Equinoctial>(about, std::move(words));
}

}  // namespace hilcam
