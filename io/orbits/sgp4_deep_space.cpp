#include "io/orbits/sgp4_deep_space.h"

#include <cmath>

#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

// The Earth's rotation [rad/min].
constexpr double kSiderealRate = 4.37526908801129966e-3;
// Within 3 degrees of the equator, prograde or retrograde, the node's rate is left out.
constexpr double kFlat_rad = 5.2359877e-2;
constexpr double kStep_min = 720;

// Greenwich mean sidereal time of 1982 (Aoki et al., Astron. Astrophys. 105, 1982), UT1 = UTC.
double sidereal_rad(double days_1950) {
    const double t = (days_1950 + 2433281.5 - 2451545.0) / 36525;
    const double seconds =
        -6.2e-6 * t * t * t + 0.093104 * t * t + (876600.0 * 3600 + 8640184.812866) * t + 67310.54841;
    const double angle = std::fmod(seconds * kDegree_rad / 240, kTurn_rad);
    return angle < 0 ? angle + kTurn_rad : angle;
}

}  // namespace

// The Sun or the Moon, relative to the orbit's plane.
struct DeepSpace::Body {
    double cosg, sing, cosi, sini, cosh, sinh;  // perigee, inclination, node (relative to the orbit's)
    double strength;                            // [rad/min]
    double anomaly_at_epoch, mean_motion, eccentricity;
};

// Products of direction cosines: X and Z in the theory.
struct DeepSpace::Geometry {
    double z1, z2, z3, z11, z12, z13, z21, z22, z23, z31, z32, z33, s5, s6, s7;
};

DeepSpace::DeepSpace(const Sgp4Elements& epoch, const DeepSpaceRates& rates)
    : epoch_(epoch), rates_(rates), sidereal_at_epoch_rad_(sidereal_rad(epoch.epoch_days_1950)) {
    const double sin_node = std::sin(epoch.node_rad), cos_node = std::cos(epoch.node_rad);
    // Days since 1900 January 0.5; the Moon's node, and its orbit relative to the equator.
    const double day = epoch.epoch_days_1950 + 18261.5;
    const double moon_node = std::fmod(4.5236020 - 9.2422029e-4 * day, kTurn_rad);
    const double s = std::sin(moon_node), c = std::cos(moon_node);
    const double cosi = 0.91375164 - 0.03568096 * c, sini = std::sqrt(1 - cosi * cosi);
    const double sinh = 0.089683511 * s / sini, cosh = std::sqrt(1 - sinh * sinh);
    const double perigee = 5.8351514 + 0.0019443680 * day;
    const double arc =
        perigee + std::atan2(0.39785416 * s / sini, cosh * c + 0.91744867 * sinh * s) - moon_node;

    const Body sun{0.1945905,  -0.98088458, 0.91744867,   0.39785416,
                   cos_node,   sin_node,    2.9864797e-6, std::fmod(6.2565837 + 0.017201977 * day, kTurn_rad),
                   1.19459e-5, 0.01675};
    const Body moon{std::cos(arc),
                    std::sin(arc),
                    cosi,
                    sini,
                    cosh * cos_node + sinh * sin_node,
                    sin_node * cosh - cos_node * sinh,
                    4.7968065e-7,
                    std::fmod(4.7199672 + 0.22997150 * day - perigee, kTurn_rad),
                    1.5835218e-4,
                    0.05490};
    add_body(sun, bodies_[0]);
    add_body(moon, bodies_[1]);

    const double theta = std::fmod(sidereal_at_epoch_rad_, kTurn_rad), n = rates.mean_motion;
    if (n > 0.0034906585 && n < 0.0052359877) set_day_resonance(theta);
    if (n >= 8.26e-3 && n <= 9.24e-3 && epoch.eccentricity >= 0.5) set_half_day_resonance(theta);
}

// Adds a body's secular rates and periodic terms.
void DeepSpace::add_body(const Body& b, Periodics& p) {
    const double e = epoch_.eccentricity, e2 = e * e, beta2 = 1 - e2, beta = std::sqrt(beta2);
    const double sini = std::sin(epoch_.inclination_rad), cosi = std::cos(epoch_.inclination_rad);
    const double sinw = std::sin(epoch_.perigee_rad), cosw = std::cos(epoch_.perigee_rad);
    const double a1 = b.cosg * b.cosh + b.sing * b.cosi * b.sinh;
    const double a3 = -b.sing * b.cosh + b.cosg * b.cosi * b.sinh;
    const double a7 = -b.cosg * b.sinh + b.sing * b.cosi * b.cosh;
    const double a8 = b.sing * b.sini;
    const double a9 = b.sing * b.sinh + b.cosg * b.cosi * b.cosh;
    const double a10 = b.cosg * b.sini;
    const double a2 = cosi * a7 + sini * a8, a4 = cosi * a9 + sini * a10;
    const double a5 = -sini * a7 + cosi * a8, a6 = -sini * a9 + cosi * a10;
    const double x1 = a1 * cosw + a2 * sinw, x2 = a3 * cosw + a4 * sinw;
    const double x3 = -a1 * sinw + a2 * cosw, x4 = -a3 * sinw + a4 * cosw;
    const double x5 = a5 * sinw, x6 = a6 * sinw, x7 = a5 * cosw, x8 = a6 * cosw;

    Geometry g{};
    g.z31 = 12 * x1 * x1 - 3 * x3 * x3;
    g.z32 = 24 * x1 * x2 - 6 * x3 * x4;
    g.z33 = 12 * x2 * x2 - 3 * x4 * x4;
    g.z1 = 2 * (3 * (a1 * a1 + a2 * a2) + g.z31 * e2) + beta2 * g.z31;
    g.z2 = 2 * (6 * (a1 * a3 + a2 * a4) + g.z32 * e2) + beta2 * g.z32;
    g.z3 = 2 * (3 * (a3 * a3 + a4 * a4) + g.z33 * e2) + beta2 * g.z33;
    g.z11 = -6 * a1 * a5 + e2 * (-24 * x1 * x7 - 6 * x3 * x5);
    g.z12 = -6 * (a1 * a6 + a3 * a5) + e2 * (-24 * (x2 * x7 + x1 * x8) - 6 * (x3 * x6 + x4 * x5));
    g.z13 = -6 * a3 * a6 + e2 * (-24 * x2 * x8 - 6 * x4 * x6);
    g.z21 = 6 * a2 * a5 + e2 * (24 * x1 * x5 - 6 * x3 * x7);
    g.z22 = 6 * (a4 * a5 + a2 * a6) + e2 * (24 * (x2 * x5 + x1 * x6) - 6 * (x4 * x7 + x3 * x8));
    g.z23 = 6 * a4 * a6 + e2 * (24 * x2 * x6 - 6 * x4 * x8);
    g.s5 = x1 * x3 + x2 * x4;
    g.s6 = x2 * x3 + x1 * x4;
    g.s7 = x2 * x4 - x1 * x3;

    const double s3 = b.strength / rates_.mean_motion, s2 = -0.5 * s3 / beta, s4 = s3 * beta;
    const double s1 = -15 * e * s4;
    const bool flat = epoch_.inclination_rad < kFlat_rad || epoch_.inclination_rad > kPi - kFlat_rad;
    const double node = flat || sini == 0 ? 0 : -b.mean_motion * s2 * (g.z21 + g.z23) / sini;
    secular_.e += s1 * b.mean_motion * g.s5;
    secular_.i += s2 * b.mean_motion * (g.z11 + g.z13);
    secular_.l += -b.mean_motion * s3 * (g.z1 + g.z3 - 14 - 6 * e2);
    secular_.g += s4 * b.mean_motion * (g.z31 + g.z33 - 6) - cosi * node;
    secular_.h += node;

    p = {b.anomaly_at_epoch,
         b.mean_motion,
         b.eccentricity,
         2 * s1 * g.s6,
         2 * s1 * g.s7,
         2 * s2 * g.z12,
         2 * s2 * (g.z13 - g.z11),
         -2 * s3 * g.z2,
         -2 * s3 * (g.z3 - g.z1),
         -2 * s3 * (-21 - 9 * e2) * b.eccentricity,
         2 * s4 * g.z32,
         2 * s4 * (g.z33 - g.z31),
         -18 * s4 * b.eccentricity,
         -2 * s2 * g.z22,
         -2 * s2 * (g.z23 - g.z21)};
}

// Sets the resonance of one-day orbits: three terms in the mean longitude relative to the Earth.
void DeepSpace::set_day_resonance(double theta) {
    constexpr double kQ22 = 1.7891679e-6, kQ31 = 2.1460748e-6, kQ33 = 2.2123015e-7;
    constexpr double kPhase2 = 0.13130908, kPhase4 = 2.8843198, kPhase6 = 0.37448087;
    const double e2 = square(epoch_.eccentricity), n = rates_.mean_motion;
    const double cosi = std::cos(epoch_.inclination_rad), sini = std::sin(epoch_.inclination_rad);
    const double g200 = 1 + e2 * (-2.5 + 0.8125 * e2), g310 = 1 + 2 * e2, g300 = 1 + e2 * (-6 + 6.60937 * e2);
    const double f220 = 0.75 * square(1 + cosi);
    const double f311 = 0.9375 * sini * sini * (1 + 3 * cosi) - 0.75 * (1 + cosi);
    const double f330 = 1.875 * (1 + cosi) * square(1 + cosi);
    const double per_a = std::pow(n / wgs72::root_mu(), 2.0 / 3.0);
    const double scale = 3 * n * n * per_a * per_a;
    resonance_ = Resonance::kDay;
    terms_[0] = {scale * f311 * g310 * kQ31 * per_a, 0, 1, kPhase2};
    terms_[1] = {2 * scale * f220 * g200 * kQ22, 0, 2, 2 * kPhase4};
    terms_[2] = {3 * scale * f330 * g300 * kQ33 * per_a, 0, 3, 3 * kPhase6};
    term_count_ = 3;
    lambda_at_epoch_ =
        std::fmod(epoch_.mean_anomaly_rad + epoch_.node_rad + epoch_.perigee_rad - theta, kTurn_rad);
    lambda_rate_ = rates_.mean_anomaly + rates_.perigee + rates_.node - kSiderealRate + secular_.l +
                   secular_.g + secular_.h - n;
}

namespace {

double cubic(double e, double c0, double c1, double c2, double c3) {
    return c0 + c1 * e + c2 * e * e + c3 * e * e * e;
}

// Eccentricity functions of the half-day resonance, fitted in pieces.
struct HalfDayG {
    double g201, g211, g310, g322, g410, g422, g520, g521, g532, g533;
};
HalfDayG half_day_g(double e) {
    HalfDayG g{};
    g.g201 = -0.306 - (e - 0.64) * 0.440;
    if (e <= 0.65) {
        g.g211 = cubic(e, 3.616, -13.2470, 16.2900, 0);
        g.g310 = cubic(e, -19.302, 117.3900, -228.4190, 156.5910);
        g.g322 = cubic(e, -18.9068, 109.7927, -214.6334, 146.5816);
        g.g410 = cubic(e, -41.122, 242.6940, -471.0940, 313.9530);
        g.g422 = cubic(e, -146.407, 841.8800, -1629.014, 1083.4350);
        g.g520 = cubic(e, -532.114, 3017.977, -5740.032, 3708.2760);
    } else {
        g.g211 = cubic(e, -72.099, 331.819, -508.738, 266.724);
        g.g310 = cubic(e, -346.844, 1582.851, -2415.925, 1246.113);
        g.g322 = cubic(e, -342.585, 1554.908, -2366.899, 1215.972);
        g.g410 = cubic(e, -1052.797, 4758.686, -7193.992, 3651.957);
        g.g422 = cubic(e, -3581.690, 16178.110, -24462.770, 12422.520);
        g.g520 = e > 0.715 ? cubic(e, -5149.66, 29936.92, -54087.36, 31324.56)
                           : cubic(e, 1464.74, -4664.75, 3763.64, 0);
    }
    if (e < 0.7) {
        g.g533 = cubic(e, -919.22770, 4988.6100, -9064.7700, 5542.21);
        g.g521 = cubic(e, -822.71072, 4568.6173, -8491.4146, 5337.524);
        g.g532 = cubic(e, -853.66600, 4690.2500, -8624.7700, 5341.4);
    } else {
        g.g533 = cubic(e, -37995.780, 161616.52, -229838.20, 109377.94);
        g.g521 = cubic(e, -51752.104, 218913.95, -309468.16, 146349.42);
        g.g532 = cubic(e, -40023.880, 170470.89, -242699.48, 115605.82);
    }
    return g;
}

}  // namespace

// Sets the resonance of half-day orbits with an eccentricity above 0.5: ten terms.
void DeepSpace::set_half_day_resonance(double theta) {
    constexpr double kRoot22 = 1.7891679e-6, kRoot32 = 3.7393792e-7, kRoot44 = 7.3636953e-9;
    constexpr double kRoot52 = 1.1428639e-7, kRoot54 = 2.1765803e-9;
    constexpr double kG22 = 5.7686396, kG32 = 0.95240898, kG44 = 1.8014998, kG52 = 1.0508330,
                     kG54 = 4.4108898;
    const double c = std::cos(epoch_.inclination_rad), s = std::sin(epoch_.inclination_rad);
    const double c2 = c * c, s2 = s * s, n = rates_.mean_motion;
    const HalfDayG g = half_day_g(epoch_.eccentricity);
    const double f220 = 0.75 * (1 + 2 * c + c2), f221 = 1.5 * s2;
    const double f321 = 1.875 * s * (1 - 2 * c - 3 * c2), f322 = -1.875 * s * (1 + 2 * c - 3 * c2);
    const double f441 = 35 * s2 * f220, f442 = 39.3750 * s2 * s2;
    const double f522 = 9.84375 * s * (s2 * (1 - 2 * c - 5 * c2) + 0.33333333 * (-2 + 4 * c + 6 * c2));
    const double f523 = s * (4.92187512 * s2 * (-2 - 4 * c + 10 * c2) + 6.56250012 * (1 + 2 * c - 3 * c2));
    const double f542 = 29.53125 * s * (2 - 8 * c + c2 * (-12 + 8 * c + 10 * c2));
    const double f543 = 29.53125 * s * (-2 - 8 * c + c2 * (12 + 8 * c - 10 * c2));
    const double per_a = std::pow(n / wgs72::root_mu(), 2.0 / 3.0);
    const double k2 = 3 * n * n * per_a * per_a, k3 = k2 * per_a, k4 = k3 * per_a, k5 = k4 * per_a;
    resonance_ = Resonance::kHalfDay;
    terms_ = {{{k2 * kRoot22 * f220 * g.g201, 2, 1, kG22},
               {k2 * kRoot22 * f221 * g.g211, 0, 1, kG22},
               {k3 * kRoot32 * f321 * g.g310, 1, 1, kG32},
               {k3 * kRoot32 * f322 * g.g322, -1, 1, kG32},
               {2 * k4 * kRoot44 * f441 * g.g410, 2, 2, kG44},
               {2 * k4 * kRoot44 * f442 * g.g422, 0, 2, kG44},
               {k5 * kRoot52 * f522 * g.g520, 1, 1, kG52},
               {k5 * kRoot52 * f523 * g.g532, -1, 1, kG52},
               {2 * k5 * kRoot54 * f542 * g.g521, 1, 2, kG54},
               {2 * k5 * kRoot54 * f543 * g.g533, -1, 2, kG54}}};
    term_count_ = terms_.size();
    lambda_at_epoch_ = std::fmod(epoch_.mean_anomaly_rad + 2 * epoch_.node_rad - 2 * theta, kTurn_rad);
    lambda_rate_ = rates_.mean_anomaly + secular_.l + 2 * (rates_.node + secular_.h - kSiderealRate) - n;
}

void DeepSpace::integrate(double t, double& lambda, double& n) const {
    lambda = lambda_at_epoch_;
    n = rates_.mean_motion;
    double at = 0;
    for (;;) {
        const double perigee = epoch_.perigee_rad + rates_.perigee * at;
        double n_rate = 0, n_rate_rate = 0;
        for (std::size_t i = 0; i < term_count_; ++i) {
            const ResonanceTerm& term = terms_[i];
            const double angle = term.perigee_times * perigee + term.times * lambda - term.phase_rad;
            n_rate += term.amplitude * std::sin(angle);
            n_rate_rate += term.times * term.amplitude * std::cos(angle);
        }
        const double lambda_rate = n + lambda_rate_;
        n_rate_rate *= lambda_rate;
        const bool last = std::abs(t - at) < kStep_min;
        const double step = last ? t - at : std::copysign(kStep_min, t);
        lambda += lambda_rate * step + n_rate * step * step * 0.5;
        n += n_rate * step + n_rate_rate * step * step * 0.5;
        if (last) return;
        at += step;
    }
}

void DeepSpace::add_secular(double t, MeanElements& m) const {
    m.eccentricity += secular_.e * t;
    m.inclination_rad += secular_.i * t;
    m.perigee_rad += secular_.g * t;
    m.node_rad += secular_.h * t;
    m.mean_anomaly_rad += secular_.l * t;
    if (resonance_ == Resonance::kNone) return;
    const double theta = std::fmod(sidereal_at_epoch_rad_ + t * kSiderealRate, kTurn_rad);
    double lambda = 0;
    integrate(t, lambda, m.mean_motion_rad_min);
    m.mean_anomaly_rad = resonance_ == Resonance::kDay ? lambda - m.node_rad - m.perigee_rad + theta
                                                       : lambda - 2 * m.node_rad + 2 * theta;
}

void DeepSpace::change_of(const Periodics& p, double t, Change& out) {
    const double mean = p.anomaly_at_epoch + p.mean_motion * t;
    const double anomaly = mean + 2 * p.eccentricity * std::sin(mean);
    const double sine = std::sin(anomaly);
    const double f2 = 0.5 * sine * sine - 0.25, f3 = -0.5 * sine * std::cos(anomaly);
    out.e += p.e2 * f2 + p.e3 * f3;
    out.i += p.i2 * f2 + p.i3 * f3;
    out.l += p.l2 * f2 + p.l3 * f3 + p.l4 * sine;
    out.g += p.g2 * f2 + p.g3 * f3 + p.g4 * sine;
    out.h += p.h2 * f2 + p.h3 * f3;
}

void DeepSpace::add_periodics(double t, MeanElements& m) const {
    Change change;
    for (const Periodics& body : bodies_) change_of(body, t, change);
    m.inclination_rad += change.i;
    m.eccentricity += change.e;
    const double sini = std::sin(m.inclination_rad), cosi = std::cos(m.inclination_rad);
    if (m.inclination_rad >= 0.2) {
        m.perigee_rad += change.g - cosi * change.h / sini;
        m.node_rad += change.h / sini;
        m.mean_anomaly_rad += change.l;
        return;
    }
    // Lyddane's variables (Astron. J. 68, 1963): sin i sin node and sin i cos node have no division by sin i.
    const double s = std::sin(m.node_rad), c = std::cos(m.node_rad);
    const double alpha = sini * s + change.h * c + change.i * cosi * s;
    const double beta = sini * c - change.h * s + change.i * cosi * c;
    const double before = std::fmod(m.node_rad, kTurn_rad);
    const double sum =
        m.mean_anomaly_rad + m.perigee_rad + cosi * before + change.l + change.g - change.i * before * sini;
    m.node_rad = std::atan2(alpha, beta);
    if (std::abs(before - m.node_rad) > kPi) m.node_rad += m.node_rad < before ? kTurn_rad : -kTurn_rad;
    m.mean_anomaly_rad += change.l;
    m.perigee_rad = sum - m.mean_anomaly_rad - cosi * m.node_rad;
}

}  // namespace hilcam
