#include <gtest/gtest.h>

#include <random>

#include "emulator/motion/ephemeris.h"
#include "emulator/motion/kepler_orbit.h"
#include "emulator/motion/relative_motion.h"
#include "emulator/motion/world_frame.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/node_polynomial.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

constexpr double kMu = 3.986004355e14;

// --- Kepler ---

// Energy and momentum by their closed forms, all along an ellipse and a hyperbola. Each of the two terms of
// the energy is rounded by some 16 * 2^-53 of its size, 2 a / r times that of their difference.
TEST(KeplerOrbit, ConservesEnergyAndMomentum) {
    for (const double e : {0.0, 0.001, 0.3, 0.9, 0.99, 1.5, 20.0}) {
        const double a = e < 1 ? 8e6 : -8e6;
        const KeplerOrbit orbit({a, e, 1.1, 2.2, 3.3, 0.4}, kMu);
        for (double t = -20000; t <= 20000; t += 777) {
            const StateVector s = orbit.at(t);
            const double r = length(s.position_m),
                         energy = 0.5 * dot(s.velocity_m_s, s.velocity_m_s) - kMu / r;
            const double digits = 16 * std::ldexp(1.0, -53);
            EXPECT_NEAR(energy, -kMu / (2 * a), digits * (kMu / r + kMu / std::abs(a))) << e << " at " << t;
            const double momentum = length(cross(s.position_m, s.velocity_m_s));
            EXPECT_NEAR(momentum / std::sqrt(kMu * a * (1 - e * e)), 1,
                        digits * r * length(s.velocity_m_s) / momentum)
                << e << " at " << t;
        }
    }
}

TEST(KeplerOrbit, PassesItsApsidesAndComesBack) {
    const double a = 2.4e7, e = 0.7;
    const KeplerOrbit orbit({a, e, 0.5, 1, 2, 0}, kMu);
    const double period_s = 2 * kPi * std::sqrt(a * a * a / kMu);
    EXPECT_NEAR(length(orbit.at(0).position_m), a * (1 - e), 1e-7);
    EXPECT_NEAR(length(orbit.at(period_s / 2).position_m), a * (1 + e), 1e-7);
    // A period later the mean anomaly has the rounding of 2 pi, at periapsis v / n of the way.
    EXPECT_LT(length(orbit.at(period_s).position_m - orbit.at(0).position_m), 1e-6);
}

// The closed form of a circle over the poles: from the node to the pole in a quarter of the period.
TEST(KeplerOrbit, HasItsAxesTheRightWayRound) {
    const double a = 7e6;
    const KeplerOrbit orbit({a, 0, kPi / 2, kPi / 2, 0, 0}, kMu);
    const double quarter_s = 0.5 * kPi * std::sqrt(a * a * a / kMu);
    EXPECT_LT(length(orbit.at(0).position_m - Vec3d{0, a, 0}), 1e-7);
    EXPECT_LT(length(orbit.at(quarter_s).position_m - Vec3d{0, 0, a}), 1e-7);
    EXPECT_GT(orbit.at(0).velocity_m_s.z, 7000);
}

// Central differences over 2 h: an error of h^2 / 6 of the third derivative, n^3 a (a / r)^5 at most, and the
// positions' rounding over h.
TEST(KeplerOrbit, VelocityIsThePositionsDerivative) {
    for (const double e : {0.2, 2.0}) {
        const double a = e < 1 ? 1e7 : -1e7, h = 0.1;
        const KeplerOrbit orbit({a, e, 0.3, 0.2, 0.1, 0}, kMu);
        const double n = std::sqrt(kMu / std::pow(std::abs(a), 3));
        const double third = n * n * n * std::abs(a) / std::pow(std::abs(1 - e), 5);
        for (double t = -5000; t < 5000; t += 611) {
            const Vec3d difference = (orbit.at(t + h).position_m - orbit.at(t - h).position_m) / (2 * h);
            EXPECT_LT(length(difference - orbit.at(t).velocity_m_s), h * h / 6 * third * 4 + 1e-7)
                << e << " " << t;
        }
    }
}

TEST(KeplerOrbit, AnomaliesAreEachOthersInverse) {
    for (const double e : {0.0, 0.5, 0.999, 1.001, 3.0})
        for (double m = -7; m < 7; m += 0.37) {
            const double x = eccentric_anomaly(m, e);
            const double again = e < 1 ? x - e * std::sin(x) : e * std::sinh(x) - x;
            EXPECT_NEAR(again, m, 1e-14 * (1 + std::abs(m) + std::abs(x))) << e << " " << m;
        }
    // 60 deg past periapsis of e = 0.5: tan(E / 2) = tan 30 deg / sqrt 3, E = 2 atan(1/3).
    const double eccentric = 2 * std::atan(1.0 / 3);
    EXPECT_NEAR(mean_anomaly(kPi / 3, 0.5), eccentric - 0.5 * std::sin(eccentric), 1e-15);
    EXPECT_THROW(mean_anomaly(kPi * 0.99, 1.5), InputError);
    EXPECT_THROW(KeplerOrbit({7e6, 1.2, 0, 0, 0, 0}, kMu), InputError);
}

// --- relative motion ---

// Clohessy & Wiltshire's equations in Fehse's axes, by differences of the velocities.
TEST(RelativeMotion, SolvesItsEquations) {
    const double n = 1.1e-3, h = 1;
    const StateVector start{{10, -20, 30}, {0.1, 0.05, -0.02}};
    EXPECT_LT(length(drifted(start, n, 0).position_m - start.position_m), 1e-12);
    EXPECT_LT(length(drifted(start, n, 0).velocity_m_s - start.velocity_m_s), 1e-15);
    for (double t = 0; t < 12000; t += 1234) {
        const StateVector s = drifted(start, n, t), before = drifted(start, n, t - h),
                          after = drifted(start, n, t + h);
        const Vec3d acceleration = (after.velocity_m_s - before.velocity_m_s) / (2 * h);
        const Vec3d velocity = (after.position_m - before.position_m) / (2 * h);
        // (n h)^2 / 6 of the rates, which are 0.3 m/s and n times that.
        EXPECT_LT(length(velocity - s.velocity_m_s), 1e-6);
        const Vec3d& p = s.position_m;
        const Vec3d& v = s.velocity_m_s;
        EXPECT_LT(length(acceleration - Vec3d{2 * n * v.z, -n * n * p.y, 3 * n * n * p.z - 2 * n * v.x}),
                  1e-9);
    }
}

// Against two Kepler orbits over a revolution. What the equations leave out is of second order in the
// distance d: d^2 / r in the energy, and of that 3 pi per revolution in the drift; the loop is 200 m wide.
TEST(RelativeMotion, IsThatOfTwoKeplerOrbits) {
    const double a = 7e6, n = std::sqrt(kMu / (a * a * a)), d = 100;
    const KeplerOrbit chief({a, 0, 0.9, 0.5, 0, 0}, kMu);
    const StateVector loop{{0, 40, d}, {2 * n * d, 0, 0}};  // closed: no drift
    const auto world = [](const StateVector& base, const StateVector& lvlh) {
        const TurningAxes axes = lvlh_axes(base);
        const Vec3d arm = axes.icrf_from_axes * lvlh.position_m;
        return StateVector{
            base.position_m + arm,
            base.velocity_m_s + axes.icrf_from_axes * lvlh.velocity_m_s + cross(axes.rate_rad_s, arm)};
    };
    EXPECT_NEAR(mean_motion_rad_s(chief.at(0), kMu), n, 1e-14 * n);
    // The deputy's own orbit, by integration of two-body motion (fourth-order Runge-Kutta in 1 s: below 1
    // um).
    StateVector deputy = world(chief.at(0), loop);
    const auto rate = [](const StateVector& s) {
        const double r = length(s.position_m);
        return StateVector{s.velocity_m_s, (-kMu / (r * r * r)) * s.position_m};
    };
    const auto plus = [](const StateVector& s, const StateVector& k, double h) {
        return StateVector{s.position_m + h * k.position_m, s.velocity_m_s + h * k.velocity_m_s};
    };
    for (int t = 0; t < 5829; ++t) {
        const StateVector k1 = rate(deputy), k2 = rate(plus(deputy, k1, 0.5)),
                          k3 = rate(plus(deputy, k2, 0.5)), k4 = rate(plus(deputy, k3, 1));
        deputy = plus(plus(plus(plus(deputy, k1, 1.0 / 6), k2, 1.0 / 3), k3, 1.0 / 3), k4, 1.0 / 6);
        const StateVector expected = world(chief.at(t + 1), drifted(loop, n, t + 1));
        ASSERT_LT(length(expected.position_m - deputy.position_m), 10 * 4 * d * d / a) << t;
    }
}

TEST(Lvlh, TurnsWithTheOrbit) {
    const double r = 7e6, v = std::sqrt(kMu / r);
    const TurningAxes axes = lvlh_axes({{r, 0, 0}, {0, 0, v}});  // over the poles
    const Vec3d x = axes.icrf_from_axes * Vec3d{1, 0, 0}, z = axes.icrf_from_axes * Vec3d{0, 0, 1};
    EXPECT_LT(length(x - Vec3d{0, 0, 1}), 1e-15);
    EXPECT_LT(length(z - Vec3d{-1, 0, 0}), 1e-15);
    EXPECT_LT(length(axes.rate_rad_s - Vec3d{0, -v / r, 0}), 1e-17);
}

// --- interpolation ---

// A polynomial of degree nodes - 1 (Lagrange) or 2 nodes - 1 (Hermite) comes back, value and rate. Its
// coefficients are below 1 on [-1, 1], nodes lie there: rounding of 2^-53 times Lebesgue's constant of 16
// equal nodes at the edge (some 2000) and the number of steps.
TEST(NodePolynomial, ReproducesPolynomialsOfItsDegree) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> unit(-1, 1);
    for (const bool with_rates : {false, true})
        for (std::size_t count = 2; count <= (with_rates ? 8u : 16u); ++count) {
            const std::size_t terms = with_rates ? 2 * count : count;
            std::vector<double> c(terms);
            for (double& x : c) x = unit(random);
            const auto polynomial = [&](double t, double& rate) {
                double value = 0;
                rate = 0;
                for (std::size_t i = terms; i-- > 0;) rate = rate * t + value, value = value * t + c[i];
                return value;
            };
            std::vector<Node<1>> nodes(count);
            for (std::size_t i = 0; i < count; ++i) {
                nodes[i].t = -1 + 2 * (static_cast<double>(i) + 0.3 * unit(random) / 2) /
                                      static_cast<double>(count - 1);
                nodes[i].value[0] = polynomial(nodes[i].t, nodes[i].rate[0]);
            }
            for (double t = -0.99; t < 1; t += 0.17) {
                double rate = 0;
                const double value = polynomial(t, rate);
                const ValueAndRate<1> found = polynomial_at<1>(nodes, with_rates, t);
                EXPECT_NEAR(found.value[0], value, 1e-10) << count << with_rates;
                EXPECT_NEAR(found.rate[0], rate, 1e-8) << count << with_rates;
            }
        }
}

OemSegment circle(double r_m, double n_rad_s, std::int64_t step_s, int count, Interpolation how) {
    OemSegment s;
    for (int i = 0; i < count; ++i) {
        const double a = n_rad_s * static_cast<double>(i * step_s);
        s.states.push_back({{i * step_s * 1'000'000'000},
                            r_m * Vec3d{std::cos(a), std::sin(a), 0},
                            r_m * n_rad_s * Vec3d{-std::sin(a), std::cos(a), 0}});
    }
    s.usable_start = s.states.front().time, s.usable_stop = s.states.back().time;
    s.interpolation = how;
    return s;
}

// Cauchy's remainder for a circle, of which every derivative of order k is R n^k: with m nodes h apart around
// the instant, R (n h)^8 / 8! times the largest product of distances in the middle interval: of four double
// nodes (0.5 1.5)^4, of eight (0.5 1.5 2.5 3.5)^2. Reached to a factor of two in the middle of it.
TEST(Ephemeris, StaysWithinTheRemainderOnACircle) {
    const double r = 7e6, n = 1.078e-3, h = 300;
    const double derivative = r * std::pow(n * h, 8) / 40320;
    struct Case {
        Interpolation how;
        double product;
    };
    for (const Case& c : {Case{{InterpolationMethod::kHermite, 7}, std::pow(0.75, 4)},
                          Case{{InterpolationMethod::kUnsaid, 0}, std::pow(0.75, 4)},
                          Case{{InterpolationMethod::kLagrange, 7}, std::pow(0.5 * 1.5 * 2.5 * 3.5, 2)}}) {
        const OemSegment s = circle(r, n, 300, 20, c.how);
        const double bound = derivative * c.product;
        double worst = 0, worst_velocity = 0;
        for (std::int64_t t = 9 * 300; t <= 10 * 300; t += 10) {
            const double a = n * static_cast<double>(t);
            const StateVector found = interpolate_state(s, {t * 1'000'000'000});
            worst = std::max(worst, length(found.position_m - r * Vec3d{std::cos(a), std::sin(a), 0}));
            worst_velocity = std::max(
                worst_velocity, length(found.velocity_m_s - r * n * Vec3d{-std::sin(a), std::cos(a), 0}));
        }
        EXPECT_LT(worst, bound * 1.5);  // each axis has the bound of its own instant: a root of two
        EXPECT_GT(worst, bound / 2);
        // Lagrange's velocities have n times the bound; Hermite's the derivative of the product, below 4 / h.
        EXPECT_LT(worst_velocity,
                  c.how.method == InterpolationMethod::kLagrange ? bound * n * 1.01 : 4 * bound / h);
    }
}

// The largest degree, at both ends of the segment and at its samples.
TEST(Ephemeris, GoesThroughItsSamples) {
    for (const Interpolation how :
         {Interpolation{InterpolationMethod::kHermite, 31}, Interpolation{InterpolationMethod::kLagrange, 31},
          Interpolation{InterpolationMethod::kLinear, 1}}) {
        const OemSegment s = circle(7e6, 1e-3, 60, 40, how);
        for (const StateSample& sample : s.states) {
            const StateVector found = interpolate_state(s, sample.time);
            // All terms after the first have the distance to the nearest sample as a factor: none.
            EXPECT_LT(length(found.position_m - sample.position_m), 1e-8);
            EXPECT_LT(length(found.velocity_m_s - sample.velocity_m_s), 1e-8);
        }
    }
}

constexpr double kTwo53 = 1 / 9007199254740992.0;

// Each degree that a message may have, at both ends and in the middle. No method is worse than a line between neighbours, off by r (n h)^2 / 8;
// Hermite's, with slopes, than a cubic, off by r (n h)^4 / 384. The last digits grow by 2^degree at the ends (Lebesgue's constant of even
// steps), of a place half as much for each of the digits.
TEST(Ephemeris, EveryDegreeOfEveryMethodGivesThePlace) {
    const double r = 7e6, n = 1.078e-3, h = 60, line_m = r * std::pow(n * h, 2) / 8,
                 cubic_m = r * std::pow(n * h, 4) / 384;
    const auto look = [&](const Interpolation& how, double bound_m) {
        const OemSegment s = circle(r, n, 60, 40, how);
        const double digits_m = std::ldexp(r * kTwo53, how.degree);
        for (const std::int64_t t : {0, 7, 30, 61, 1170, 1201, 1230, 2300, 2340}) {
            const double a = n * static_cast<double>(t);
            const StateVector found = interpolate_state(s, {t * 1'000'000'000});
            EXPECT_LT(length(found.position_m - r * Vec3d{std::cos(a), std::sin(a), 0}),
                      1.01 * bound_m + digits_m)
                << static_cast<int>(how.method) << ' ' << how.degree << " at " << t;
            EXPECT_NEAR(length(found.velocity_m_s), r * n, 0.05 * r * n + digits_m) << how.degree;
        }
    };
    look({InterpolationMethod::kUnsaid, 0}, cubic_m);
    look({InterpolationMethod::kLinear, 1}, line_m);
    for (int degree = 1; degree <= kMaxInterpolationDegree; ++degree) {
        look({InterpolationMethod::kLagrange, degree}, line_m);
        if (degree % 2 == 1) look({InterpolationMethod::kHermite, degree}, cubic_m);
    }
}

// Attitudes likewise, whose quaternions turn by half the angle: w h / 2.
TEST(Ephemeris, EveryDegreeOfEveryMethodGivesTheAttitude) {
    const Vec3d axis = normalized(Vec3d{1, 2, -1});
    const double w = 0.005, h = 60, half = 0.5 * w * h, line_rad = 2 * half * half / 8;
    const auto look = [&](const Interpolation& how, bool rates) {
        AemSegment s;
        s.interpolation = how;
        s.has_rates = rates;
        for (int i = 0; i < 40; ++i)
            s.attitudes.push_back({{i * 60'000'000'000}, from_rotation_vector((w * h * i) * axis), w * axis});
        for (const std::int64_t t : {0, 7, 30, 1170, 1201, 2300, 2340}) {
            const ReferenceAttitude found = interpolate_attitude(s, {t * 1'000'000'000});
            const Quat error = conjugate(found.reference_from_body) *
                               from_rotation_vector((w * static_cast<double>(t)) * axis);
            const double digits = std::ldexp(kTwo53, how.degree);
            EXPECT_LT(2 * length(Vec3d{error.x, error.y, error.z}), 1.01 * line_rad + digits)
                << static_cast<int>(how.method) << ' ' << how.degree << ' ' << rates << " at " << t;
            EXPECT_LT(length(found.rate_body_rad_s - w * axis), 0.1 * w + digits) << how.degree;
        }
    };
    for (const bool rates : {false, true}) {
        look({InterpolationMethod::kUnsaid, 0}, rates);
        look({InterpolationMethod::kLinear, 1}, rates);
        for (int degree = 1; degree <= kMaxInterpolationDegree; ++degree) {
            look({InterpolationMethod::kLagrange, degree}, rates);
            if (degree % 2 == 1) look({InterpolationMethod::kHermite, degree}, rates);
        }
    }
}

TEST(Ephemeris, KnowsItsSpansAndGaps) {
    std::vector<OemSegment> segments(2, circle(7e6, 1e-3, 60, 3, {}));
    for (StateSample& s : segments[1].states) s.time = s.time + 300'000'000'000;
    segments[1].usable_start = {300'000'000'000}, segments[1].usable_stop = {420'000'000'000};
    const auto at = [&](std::int64_t s) { return validity_of(segments, TimeTai{s * 1'000'000'000}); };
    EXPECT_EQ(at(-1).status, MotionStatus::kBefore);
    EXPECT_EQ(at(60).status, MotionStatus::kOk);
    EXPECT_EQ(at(150).status, MotionStatus::kGap);
    EXPECT_EQ(at(150).nearest.ns, 120'000'000'000);
    EXPECT_EQ(at(290).nearest.ns, 300'000'000'000);
    EXPECT_EQ(at(421).status, MotionStatus::kAfter);
    EXPECT_EQ(&segment_of(segments, {300'000'000'000}), &segments[1]);
    EXPECT_THROW(require_no_gap(segments, "x.oem"), InputError);
    segments[1].usable_start = segments[0].usable_stop;
    EXPECT_NO_THROW(require_no_gap(segments, "x.oem"));
}

// Turning at a constant rate w about a fixed axis, the quaternion's components have frequency w / 2: Cauchy's
// remainder as above, (w h / 2)^8 / 8! times the product, twice that in the angle. The linear way has no
// error.
TEST(Ephemeris, AttitudesTurnWithinTheRemainder) {
    const Vec3d axis = normalized(Vec3d{1, 2, -1});
    const double w = 0.01, h = 60;
    struct Case {
        Interpolation how;
        bool rates;
        double product;
    };
    for (const Case& c : {Case{{InterpolationMethod::kLinear, 1}, false, 0},
                          Case{{InterpolationMethod::kHermite, 7}, true, std::pow(0.75, 4)},
                          Case{{InterpolationMethod::kHermite, 7}, false, std::pow(6.5625, 2)},
                          Case{{InterpolationMethod::kLagrange, 7}, true, std::pow(6.5625, 2)}}) {
        AemSegment s;
        s.interpolation = c.how;
        s.has_rates = c.rates;
        for (int i = 0; i < 12; ++i)
            s.attitudes.push_back({{i * 60'000'000'000}, from_rotation_vector((w * h * i) * axis), w * axis});
        const double bound = 2 * std::pow(0.5 * w * h, 8) / 40320 * c.product + 1e-14;
        double worst = 0, worst_rate = 0;
        for (std::int64_t t = 5 * 60; t <= 6 * 60; t += 3) {
            const ReferenceAttitude found = interpolate_attitude(s, {t * 1'000'000'000});
            const Quat error = conjugate(found.reference_from_body) *
                               from_rotation_vector((w * static_cast<double>(t)) * axis);
            worst = std::max(worst, 2 * length(Vec3d{error.x, error.y, error.z}));
            worst_rate = std::max(worst_rate, length(found.rate_body_rad_s - w * axis));
        }
        EXPECT_LT(worst, bound * 1.5);
        EXPECT_LT(worst_rate, 6 * bound / h + 1e-14);
    }
}

}  // namespace
}  // namespace hilcam
