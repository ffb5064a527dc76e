#include "io/orbits/sgp4.h"

#include <algorithm>
#include <cmath>

#include "io/orbits/sgp4_deep_space.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/plain_number.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace wgs72 {

double root_mu() {
    static const double value =
        60 / std::sqrt(kEarthRadius_km * kEarthRadius_km * kEarthRadius_km / kMu_km3_s2);
    return value;
}

}  // namespace wgs72

namespace {

using wgs72::kEarthRadius_km;
using wgs72::kJ2;
using wgs72::kJ3;
using wgs72::kJ4;

constexpr double kDeepSpacePeriod_min = 225;

double cube(double x) { return x * x * x; }
double axis_of(double mean_motion_rad_min) {
    return std::pow(wgs72::root_mu() / mean_motion_rad_min, 2.0 / 3.0);
}

// The atmosphere's fitting parameter s [er] and (q0 - s)^4 for a perigee height: AIAA 2006-6753, section B.
struct DragDensity {
    double s_er, q0_minus_s_4;
};
DragDensity density_at(double perigee_km) {
    const double s_km = perigee_km < 98 ? 20 : perigee_km < 156 ? perigee_km - 78 : 78;
    return {s_km / kEarthRadius_km + 1, square(square((120 - s_km) / kEarthRadius_km))};
}

// Solves Kepler's equation in e cos w and e sin w for E + w, as the theory prescribes: Newton's steps,
// limited to 0.95 rad, to 1e-12 rad.
double solve_kepler(double u, double axn, double ayn) {
    double angle = u;
    for (int i = 0; i < 10; ++i) {
        const double s = std::sin(angle), c = std::cos(angle);
        const double step =
            std::clamp((u - ayn * c + axn * s - angle) / (1 - c * axn - s * ayn), -0.95, 0.95);
        angle += step;
        if (std::abs(step) < 1e-12) break;
    }
    return angle;
}

}  // namespace

Sgp4::Sgp4(const Sgp4Elements& elements) : epoch_(elements) {
    const auto refuse = [](const char* name, double found, const char* accepted) {
        throw refused(std::string(name), plain(found), accepted);
    };
    if (!(epoch_.mean_motion_rad_min > 0))
        refuse("mean motion", epoch_.mean_motion_rad_min, "above 0 rad/min");
    if (!(epoch_.eccentricity >= 0 && epoch_.eccentricity < 1))
        refuse("eccentricity", epoch_.eccentricity, "from 0 to below 1");
    set_mean_motion();
    set_drag();
    set_rates();
    if (kTurn_rad / n0_rad_min_ >= kDeepSpacePeriod_min)
        deep_ = std::make_unique<DeepSpace>(
            epoch_, DeepSpaceRates{n0_rad_min_, mean_anomaly_rate_, perigee_rate_, node_rate_});
}

Sgp4::~Sgp4() = default;
Sgp4::Sgp4(Sgp4&&) noexcept = default;
Sgp4& Sgp4::operator=(Sgp4&&) noexcept = default;

// Computes Brouwer's mean motion from Kozai's.
void Sgp4::set_mean_motion() {
    const double beta2 = 1 - square(epoch_.eccentricity);
    const double d1 =
        0.75 * kJ2 * (3 * square(std::cos(epoch_.inclination_rad)) - 1) / (std::sqrt(beta2) * beta2);
    const double a1 = axis_of(epoch_.mean_motion_rad_min);
    const double delta1 = d1 / square(a1);
    const double a = a1 * (1 - square(delta1) - delta1 * (1.0 / 3.0 + 134 * square(delta1) / 81));
    n0_rad_min_ = epoch_.mean_motion_rad_min / (1 + d1 / square(a));
    a0_er_ = axis_of(n0_rad_min_);
}

void Sgp4::set_drag() {
    const double e = epoch_.eccentricity, a = a0_er_, n = n0_rad_min_, bstar = epoch_.bstar_per_er;
    const double theta2 = square(std::cos(epoch_.inclination_rad)), sini = std::sin(epoch_.inclination_rad);
    const double perigee_er = a * (1 - e);
    const auto [s, q4] = density_at((perigee_er - 1) * kEarthRadius_km);
    const double xi = 1 / (a - s);
    eta_ = a * e * xi;
    const double eta2 = square(eta_), e_eta = e * eta_;
    const double psi2 = std::abs(1 - eta2);
    const double q4_xi4 = q4 * square(square(xi));
    const double scale = q4_xi4 / std::pow(psi2, 3.5);
    const double c2 = scale * n *
                      (a * (1 + 1.5 * eta2 + e_eta * (4 + eta2)) +
                       0.375 * kJ2 * xi / psi2 * (3 * theta2 - 1) * (8 + 3 * eta2 * (8 + eta2)));
    c1_ = bstar * c2;
    const double beta2 = 1 - e * e;
    c4_ = 2 * n * scale * a * beta2 *
          (eta_ * (2 + 0.5 * eta2) + e * (0.5 + 2 * eta2) -
           kJ2 * xi / (a * psi2) *
               (-3 * (3 * theta2 - 1) * (1 - 2 * e_eta + eta2 * (1.5 - 0.5 * e_eta)) +
                0.75 * (1 - theta2) * (2 * eta2 - e_eta * (1 + eta2)) * std::cos(2 * epoch_.perigee_rad)));
    c5_ = 2 * scale * a * beta2 * (1 + 2.75 * (eta2 + e_eta) + e_eta * eta2);
    t2_ = 1.5 * c1_;
    if (e > 1e-4) {
        const double c3 = -2 * q4_xi4 * xi * (kJ3 / kJ2) * n * sini / e;
        perigee_drag_ = bstar * c3 * std::cos(epoch_.perigee_rad);
        anomaly_drag_ = -2.0 / 3.0 * q4_xi4 * bstar / e_eta;
    }
    cubed_at_epoch_ = cube(1 + eta_ * std::cos(epoch_.mean_anomaly_rad));
    sin_anomaly_at_epoch_ = std::sin(epoch_.mean_anomaly_rad);
    // For perigees below 220 km and for deep space, drag is first-order only.
    simple_drag_ = perigee_er < 220 / kEarthRadius_km + 1 || kTurn_rad / n >= kDeepSpacePeriod_min;
    if (!simple_drag_) set_higher_drag(xi, s);
}

void Sgp4::set_higher_drag(double xi, double s) {
    const double c1_2 = square(c1_), a = a0_er_;
    d2_ = 4 * a * xi * c1_2;
    const double third = d2_ * xi * c1_ / 3;
    d3_ = (17 * a + s) * third;
    d4_ = 0.5 * third * a * xi * (221 * a + 31 * s) * c1_;
    t3_ = d2_ + 2 * c1_2;
    t4_ = 0.25 * (3 * d3_ + c1_ * (12 * d2_ + 10 * c1_2));
    t5_ = 0.2 * (3 * d4_ + 12 * c1_ * d3_ + 6 * square(d2_) + 15 * c1_2 * (2 * d2_ + c1_2));
}

// Computes the secular rates from J2, J2^2 and J4.
void Sgp4::set_rates() {
    const double n = n0_rad_min_, theta = std::cos(epoch_.inclination_rad), theta2 = square(theta);
    const double theta4 = square(theta2), beta2 = 1 - square(epoch_.eccentricity), beta = std::sqrt(beta2);
    const double per_p2 = 1 / square(a0_er_ * beta2);
    const double first = 1.5 * kJ2 * per_p2 * n;
    const double second = 0.5 * first * kJ2 * per_p2;
    const double fourth = -0.46875 * kJ4 * square(per_p2) * n;
    mean_anomaly_rate_ = n + 0.5 * first * beta * (3 * theta2 - 1) +
                         0.0625 * second * beta * (13 - 78 * theta2 + 137 * theta4);
    perigee_rate_ = -0.5 * first * (1 - 5 * theta2) + 0.0625 * second * (7 - 114 * theta2 + 395 * theta4) +
                    fourth * (3 - 36 * theta2 + 49 * theta4);
    const double node_first = -first * theta;
    node_rate_ = node_first + (0.5 * second * (4 - 19 * theta2) + 2 * fourth * (3 - 7 * theta2)) * theta;
    node_drag_ = 3.5 * beta2 * node_first * c1_;
}

Sgp4Status Sgp4::at(double minutes, StateVector& teme) const {
    MeanElements m{};
    double a_er = 0;
    if (const Sgp4Status status = secular(minutes, m, a_er); status != Sgp4Status::kOk) return status;
    if (deep_) {
        deep_->add_periodics(minutes, m);
        if (m.inclination_rad < 0) {
            m.inclination_rad = -m.inclination_rad;
            m.node_rad += kPi;
            m.perigee_rad -= kPi;
        }
        if (m.eccentricity < 0 || m.eccentricity > 1) return Sgp4Status::kPerturbed;
    }
    return state_of(m, a_er, teme);
}

// Applies the secular effects of gravity and drag.
Sgp4Status Sgp4::secular(double t, MeanElements& m, double& a_er) const {
    m = {epoch_.eccentricity,
         epoch_.inclination_rad,
         epoch_.node_rad + node_rate_ * t + node_drag_ * t * t,
         epoch_.perigee_rad + perigee_rate_ * t,
         epoch_.mean_anomaly_rad + mean_anomaly_rate_ * t,
         n0_rad_min_};
    double axis_factor = 1 - c1_ * t;
    double e_drop = epoch_.bstar_per_er * c4_ * t;
    double longitude_gain = t2_ * t * t;
    if (!simple_drag_) {
        const double shift =
            perigee_drag_ * t +
            anomaly_drag_ * (cube(1 + eta_ * std::cos(m.mean_anomaly_rad)) - cubed_at_epoch_);
        m.mean_anomaly_rad += shift;
        m.perigee_rad -= shift;
        const double t2 = t * t, t3 = t2 * t, t4 = t3 * t;
        axis_factor -= d2_ * t2 + d3_ * t3 + d4_ * t4;
        e_drop += epoch_.bstar_per_er * c5_ * (std::sin(m.mean_anomaly_rad) - sin_anomaly_at_epoch_);
        longitude_gain += t3_ * t3 + t4 * (t4_ + t * t5_);
    }
    if (deep_) deep_->add_secular(t, m);
    if (!(m.mean_motion_rad_min > 0)) return Sgp4Status::kMeanMotion;

    a_er = axis_of(m.mean_motion_rad_min) * square(axis_factor);
    m.mean_motion_rad_min = wgs72::root_mu() / std::pow(a_er, 1.5);
    m.eccentricity -= e_drop;
    if (!(m.eccentricity < 1 && m.eccentricity >= -0.001)) return Sgp4Status::kEccentricity;
    m.eccentricity = std::max(m.eccentricity, 1e-6);
    m.mean_anomaly_rad += n0_rad_min_ * longitude_gain;
    const double longitude = std::fmod(m.mean_anomaly_rad + m.perigee_rad + m.node_rad, kTurn_rad);
    m.node_rad = std::fmod(m.node_rad, kTurn_rad);
    m.perigee_rad = std::fmod(m.perigee_rad, kTurn_rad);
    m.mean_anomaly_rad = std::fmod(longitude - m.perigee_rad - m.node_rad, kTurn_rad);
    return Sgp4Status::kOk;
}

// Applies long-period periodics, Kepler's equation and short-period periodics, and rotates into the axes.
Sgp4Status Sgp4::state_of(const MeanElements& m, double a, StateVector& teme) const {
    const double cosi = std::cos(m.inclination_rad), sini = std::sin(m.inclination_rad);
    // 1 + cos i is a divisor below, and vanishes for a retrograde equatorial orbit.
    const double one_plus_cosi = std::abs(1 + cosi) > 1.5e-12 ? 1 + cosi : 1.5e-12;
    const double a_yn = -0.5 * (kJ3 / kJ2) * sini;
    const double l_n = 0.5 * a_yn * (3 + 5 * cosi) / one_plus_cosi;

    const double per_p = 1 / (a * (1 - square(m.eccentricity)));
    const double axn = m.eccentricity * std::cos(m.perigee_rad);
    const double ayn = m.eccentricity * std::sin(m.perigee_rad) + per_p * a_yn;
    const double longitude = m.mean_anomaly_rad + m.perigee_rad + m.node_rad + per_p * l_n * axn;
    const double angle = solve_kepler(std::fmod(longitude - m.node_rad, kTurn_rad), axn, ayn);
    const double cos_e = std::cos(angle), sin_e = std::sin(angle);

    const double e_cos = axn * cos_e + ayn * sin_e, e_sin = axn * sin_e - ayn * cos_e;
    const double e2 = axn * axn + ayn * ayn;
    const double p = a * (1 - e2);
    if (!(p >= 0)) return Sgp4Status::kSemiLatus;
    const double r = a * (1 - e_cos);
    const double r_rate = std::sqrt(a) * e_sin / r, rf_rate = std::sqrt(p) / r;
    const double beta = std::sqrt(1 - e2), part = e_sin / (1 + beta);
    const double sinu = a / r * (sin_e - ayn - axn * part), cosu = a / r * (cos_e - axn + ayn * part);
    const double sin2u = 2 * cosu * sinu, cos2u = 1 - 2 * sinu * sinu;

    // Short-period periodics by J2.
    const double k = 0.5 * kJ2 / p, k_p = k / p;
    const double cosi2 = cosi * cosi, x3 = 3 * cosi2 - 1, x1 = 1 - cosi2, x7 = 7 * cosi2 - 1;
    const double radius = r * (1 - 1.5 * k_p * beta * x3) + 0.5 * k * x1 * cos2u;
    const double u = std::atan2(sinu, cosu) - 0.25 * k_p * x7 * sin2u;
    const double node = m.node_rad + 1.5 * k_p * cosi * sin2u;
    const double inclination = m.inclination_rad + 1.5 * k_p * cosi * sini * cos2u;
    const double n_k = m.mean_motion_rad_min * k / wgs72::root_mu();
    const double radial = r_rate - n_k * x1 * sin2u;
    const double across = rf_rate + n_k * (x1 * cos2u + 1.5 * x3);

    const double su = std::sin(u), cu = std::cos(u), sn = std::sin(node), cn = std::cos(node);
    const double si = std::sin(inclination), ci = std::cos(inclination);
    const Vec3d out{-sn * ci * su + cn * cu, cn * ci * su + sn * cu, si * su};
    const Vec3d along{-sn * ci * cu - cn * su, cn * ci * cu - sn * su, si * cu};
    const double speed_m_s = 1000 * kEarthRadius_km * wgs72::root_mu() / 60;
    teme = {(1000 * kEarthRadius_km * radius) * out, speed_m_s * (radial * out + across * along)};
    return radius >= 1 ? Sgp4Status::kOk : Sgp4Status::kDecayed;  // NaN has decayed
}

}  // namespace hilcam
