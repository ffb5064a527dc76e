#include "io/spice/spk_segment.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "io/orbits/two_body.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/units.h"
#include "tests/support/spice_writer.h"

namespace hilcam {
namespace {

using testing::HasSubstr;

WrittenArray segment(int type, double start, double stop, std::vector<double> words) {
    return {"TEST", start, stop, {-99, 399, 1, type}, std::move(words)};
}

std::unique_ptr<SpkSegment> loaded(const WrittenArray& array, bool big_endian = false) {
    const DafFile file(SpiceWriter("SPK", big_endian).add(array).bytes(), "test.bsp");
    return load_spk_segment(file, file.arrays().front());
}

std::string refusal(const WrittenArray& array) {
    try {
        loaded(array);
    } catch (const InputError& error) {
        return error.what();
    }
    return "nothing";
}

// A motion whose coordinates are cubics of the time from t0, in km.
struct Cubic {
    double t0;
    Vec3d c0{7000, -200, 30}, c1{1.5, 7.25, -0.5}, c2{-0.001, 0.002, 0.003}, c3{1e-6, -2e-6, 5e-7};
    Vec3d position_km(double t) const {
        const double s = t - t0;
        return c0 + s * (c1 + s * (c2 + s * c3));
    }
    Vec3d velocity_km_s(double t) const {
        const double s = t - t0;
        return c1 + s * (2 * c2 + 3 * s * c3);
    }
};

void expect_on(const Cubic& motion, const SpkSegment& segment, double from, double to,
               double tolerance_m = 1e-6) {
    for (int i = 0; i <= 40; ++i) {
        const double t = from + (to - from) * i / 40;
        const StateVector s = segment.at(t);
        EXPECT_NEAR(length(s.position_m - 1e3 * motion.position_km(t)), 0, tolerance_m) << t;
        EXPECT_NEAR(length(s.velocity_m_s - 1e3 * motion.velocity_km_s(t)), 0, tolerance_m) << t;
    }
}

// Coefficients of a cubic on [mid - radius, mid + radius]: 1 = T0, s = T1, s^2 = (T2 + T0) / 2, s^3 = (T3 + 3 T1) / 4.
std::array<Vec3d, 4> chebyshev_of(const Cubic& m, double mid, double radius) {
    const Vec3d p0 = m.position_km(mid), p1 = radius * m.velocity_km_s(mid);
    const double s = mid - m.t0;
    const Vec3d p2 = radius * radius * (m.c2 + 3 * s * m.c3), p3 = radius * radius * radius * m.c3;
    return {p0 + 0.5 * p2, p1 + 0.75 * p3, 0.5 * p2, 0.25 * p3};
}
std::array<Vec3d, 3> rates_of(const Cubic& m, double mid, double radius) {
    const Vec3d v0 = m.velocity_km_s(mid), v1 = radius * (2 * m.c2 + 6 * (mid - m.t0) * m.c3),
                v2 = 3 * radius * radius * m.c3;
    return {v0 + 0.5 * v2, v1, 0.5 * v2};
}
template <class Set>
void append(std::vector<double>& words, const Set& set) {
    for (const auto& c : set) words.push_back(c.x);
    for (const auto& c : set) words.push_back(c.y);
    for (const auto& c : set) words.push_back(c.z);
}

// Three records of 200 s.
std::vector<double> chebyshev_words(const Cubic& m, double begin, bool rates) {
    std::vector<double> words;
    for (int i = 0; i < 3; ++i) {
        const double mid = begin + 100 + 200 * i;
        words.insert(words.end(), {mid, 100});
        append(words, chebyshev_of(m, mid, 100));
        if (rates) {
            auto v = rates_of(m, mid, 100);
            append(words, std::array{v[0], v[1], v[2], Vec3d{}});
        }
    }
    words.insert(words.end(), {begin, 200, rates ? 26.0 : 14.0, 3});
    return words;
}

TEST(SpkSegment, ChebyshevPolynomialsGiveTheMotionInBothByteOrders) {
    const Cubic m{1000};
    for (const bool big : {false, true}) {
        expect_on(m, *loaded(segment(2, 1000, 1600, chebyshev_words(m, 1000, false)), big), 1000, 1600);
        expect_on(m, *loaded(segment(3, 1000, 1600, chebyshev_words(m, 1000, true)), big), 1000, 1600);
    }
}

TEST(SpkSegment, VelocitiesAloneAreIntegratedFromTheMiddle) {
    // Type 20 in astronomical units and days, from a Julian date.
    const double au_km = 149597870.7, day_s = 86400, begin = 0.25 * day_s;
    const Cubic m{begin};
    std::vector<double> words;
    for (int i = 0; i < 2; ++i) {
        const double mid = begin + (i + 0.5) * 0.01 * day_s, radius = 0.005 * day_s;
        const auto v = rates_of(m, mid, radius);
        const Vec3d p = m.position_km(mid);
        const auto one = [&](double Vec3d::*axis) {
            for (const Vec3d& c : v) words.push_back(c.*axis * day_s / au_km);
            words.push_back(p.*axis / au_km);
        };
        one(&Vec3d::x), one(&Vec3d::y), one(&Vec3d::z);
    }
    words.insert(words.end(), {au_km, day_s, 2451545, 0.25, 0.01, 12, 2});
    // A Julian date leaves an instant 40 us: 0.3 m here.
    expect_on(m, *loaded(segment(20, begin, begin + 1728, words)), begin, begin + 1728, 1e-3);
}

std::vector<double> states(const Cubic& m, const std::vector<double>& times) {
    std::vector<double> words;
    for (const double t : times) {
        const Vec3d p = m.position_km(t), v = m.velocity_km_s(t);
        words.insert(words.end(), {p.x, p.y, p.z, v.x, v.y, v.z});
    }
    return words;
}

TEST(SpkSegment, InterpolatedStatesGivePolynomialsOfTheirDegree) {
    const Cubic m{500};
    std::vector<double> even, uneven;
    for (int i = 0; i < 230; ++i)
        even.push_back(500 + 10.0 * i), uneven.push_back(500 + 10.0 * i + 3 * (i % 3));
    const auto with_times = [](std::vector<double> words, const std::vector<double>& times,
                               std::vector<double> tail) {
        words.insert(words.end(), times.begin(), times.end());
        for (std::size_t i = 99; i + 1 < times.size(); i += 100) words.push_back(times[i]);
        words.insert(words.end(), tail.begin(), tail.end());
        return words;
    };
    for (const double degree : {3.0, 4.0, 7.0}) {
        std::vector<double> words = states(m, even);
        words.insert(words.end(), {500, 10, degree, 230});
        expect_on(m, *loaded(segment(8, 500, 2790, words)), 500, 2790);
        expect_on(
            m, *loaded(segment(9, 500, uneven.back(), with_times(states(m, uneven), uneven, {degree, 230}))),
            500, uneven.back());
    }
    for (const double window : {2.0, 3.0, 4.0}) {
        std::vector<double> words = states(m, even);
        words.insert(words.end(), {500, 10, window - 1, 230});
        expect_on(m, *loaded(segment(12, 500, 2790, words)), 500, 2790);
        expect_on(m,
                  *loaded(segment(13, 500, uneven.back(),
                                  with_times(states(m, uneven), uneven, {window - 1, 230}))),
                  500, uneven.back());
    }
    // Type 18 with Lagrange's polynomials, then with position and velocity apart, whose velocity is not the derivative.
    expect_on(m, *loaded(segment(18, 500, uneven.back(), with_times(states(m, uneven), uneven, {1, 8, 230}))),
              530, uneven.back() - 30);
    std::vector<double> packets;
    for (const double t : uneven) {
        const Vec3d p = m.position_km(t), v = m.velocity_km_s(t), a = 2 * m.c2 + 6 * (t - m.t0) * m.c3;
        for (const Vec3d& part : {p, v, 2 * v, 2 * a})
            packets.insert(packets.end(), {part.x, part.y, part.z});
    }
    const auto apart = loaded(segment(18, 500, uneven.back(), with_times(packets, uneven, {0, 4, 230})));
    const StateVector s = apart->at(1234.5);
    EXPECT_NEAR(length(s.position_m - 1e3 * m.position_km(1234.5)), 0, 1e-6);
    EXPECT_NEAR(length(s.velocity_m_s - 2e3 * m.velocity_km_s(1234.5)), 0, 1e-6);
}

// Type 14 over spans of any length, which begin at all times but the last.
std::vector<double> packets_words(const Cubic& m, const std::vector<double>& times) {
    std::vector<double> words = {3};
    const double count = static_cast<double>(times.size() - 1);
    for (std::size_t i = 0; i + 1 < times.size(); ++i) {
        const double mid = 0.5 * (times[i] + times[i + 1]), radius = 0.5 * (times[i + 1] - times[i]);
        words.insert(words.end(), {mid, radius});
        append(words, chebyshev_of(m, mid, radius));
        const auto v = rates_of(m, mid, radius);
        append(words, std::array{v[0], v[1], v[2], Vec3d{}});
    }
    const auto begins = static_cast<double>(words.size());
    words.insert(words.end(), times.begin(), times.end() - 1);
    const auto end = static_cast<double>(words.size());
    // Constants, reference directory and its type, references, packet directory, packets, reserved, size, offset, items.
    words.insert(words.end(), {0, 1, end, 0, 3, begins, count, end, 0, 0, 1, count, end, 0, 26, 0, 17});
    return words;
}

// Type 19: spans by turns of all three subtypes, each with states of its own from 30 s before to 30 s after it.
std::vector<double> piecewise_words(const Cubic& m, const std::vector<double>& spans, bool later) {
    std::vector<double> words, begins;
    for (std::size_t i = 0; i + 1 < spans.size(); ++i) {
        const std::size_t subtype = i % 3;
        begins.push_back(static_cast<double>(words.size() + 1));
        std::vector<double> times;
        for (double t = spans[i] - 30; t <= spans[i + 1] + 30; t += 10) times.push_back(t);
        for (const double t : times) {
            const Vec3d p = m.position_km(t), v = m.velocity_km_s(t), a = 2 * m.c2 + 6 * (t - m.t0) * m.c3;
            words.insert(words.end(), {p.x, p.y, p.z, v.x, v.y, v.z});
            if (subtype == 0) words.insert(words.end(), {v.x, v.y, v.z, a.x, a.y, a.z});
        }
        words.insert(words.end(), times.begin(), times.end());
        for (std::size_t k = 99; k + 1 < times.size(); k += 100) words.push_back(times[k]);
        words.insert(words.end(), {static_cast<double>(subtype), subtype == 1 ? 8.0 : 4.0,
                                   static_cast<double>(times.size())});
    }
    begins.push_back(static_cast<double>(words.size() + 1));
    words.insert(words.end(), spans.begin(), spans.end());
    for (std::size_t k = 99; k + 1 <= spans.size() - 1; k += 100) words.push_back(spans[k]);
    words.insert(words.end(), begins.begin(), begins.end());
    words.insert(words.end(), {later ? 1.0 : 0.0, static_cast<double>(spans.size() - 1)});
    return words;
}

TEST(SpkSegment, PacketsOfAnyLengthAndSeriesOneAfterTheOtherGiveTheMotion) {
    const Cubic m{300};
    for (const bool big : {false, true})
        expect_on(m, *loaded(segment(14, 0, 1600, packets_words(m, {0, 40, 200, 900, 1600})), big), 0, 1600);
    // More than a hundred spans have a directory, and so have more than a hundred states.
    std::vector<double> spans;
    for (int i = 0; i <= 203; ++i) spans.push_back(40.0 * i);
    spans.push_back(40 * 203 + 2000);
    for (const bool later : {false, true})
        expect_on(m, *loaded(segment(19, 0, spans.back(), piecewise_words(m, spans, later))), 0,
                  spans.back());
}

// Two series that disagree: where they meet, the flag says which counts.
TEST(SpkSegment, AnInstantBetweenTwoSeriesBelongsToTheOneThatIsSaid) {
    for (const bool later : {false, true}) {
        std::vector<double> words;
        for (const double x : {1.0, 2.0}) {
            for (int i = 0; i < 2; ++i) words.insert(words.end(), {x, 0, 0, 0, 0, 0});
            words.insert(words.end(), {x - 1, x, 1, 2, 2});
        }
        words.insert(words.end(), {0, 1, 2, 1, 18, 35, later ? 1.0 : 0.0, 2});
        const auto s = loaded(segment(19, 0, 2, words));
        EXPECT_EQ(s->at(0).position_m.x, 1000);
        EXPECT_EQ(s->at(0.999).position_m.x, 1000);
        EXPECT_EQ(s->at(1).position_m.x, later ? 2000 : 1000);
        EXPECT_EQ(s->at(1.001).position_m.x, 2000);
        EXPECT_EQ(s->at(2).position_m.x, 2000);
    }
}

TEST(SpkSegment, AWindowIsMovedInwardsAtTheEnds) {
    // A cubic through four states is not the motion, so that the choice of states shows: degree 3 of t^4.
    std::vector<double> words, times = {0, 1, 2, 3, 4, 5};
    for (const double t : times) words.insert(words.end(), {t * t * t * t, 0, 0, 0, 0, 0});
    words.insert(words.end(), {0, 1, 3, 6});
    const auto s = loaded(segment(8, 0, 5, words));
    // Error of interpolation of t^4 through nodes a, b, c, d is (t-a)(t-b)(t-c)(t-d).
    const auto expected = [](double t, double a) {
        return 1e3 * (std::pow(t, 4) - (t - a) * (t - a - 1) * (t - a - 2) * (t - a - 3));
    };
    EXPECT_NEAR(s->at(0.5).position_m.x, expected(0.5, 0), 1e-8);
    EXPECT_NEAR(s->at(1.5).position_m.x, expected(1.5, 0), 1e-8);
    EXPECT_NEAR(s->at(2.5).position_m.x, expected(2.5, 1), 1e-8);
    EXPECT_NEAR(s->at(4.75).position_m.x, expected(4.75, 2), 1e-8);
}

TEST(SpkSegment, TwoBodiesFollowKeplersLaws) {
    const double mu = 398600.4418, r = 42164, rate = std::sqrt(mu / (r * r * r));
    const auto circle = [&](double t) {
        const double a = rate * t;
        return StateVector{{r * std::cos(a), r * std::sin(a), 0},
                           {-r * rate * std::sin(a), r * rate * std::cos(a), 0}};
    };
    std::vector<double> words;
    for (const double t : {0.0, 5000.0, 12000.0}) {
        const StateVector s = circle(t);
        words.insert(words.end(), {s.position_m.x, s.position_m.y, s.position_m.z, s.velocity_m_s.x,
                                   s.velocity_m_s.y, s.velocity_m_s.z});
    }
    words.insert(words.end(), {0, 5000, 12000, mu, 3});
    const auto s = loaded(segment(5, -3000, 15000, words));
    for (const double t : {-3000.0, 0.0, 777.0, 5000.0, 9000.0, 15000.0}) {
        EXPECT_NEAR(length(s->at(t).position_m - 1e3 * circle(t).position_m), 0, 1e-4) << t;
        EXPECT_NEAR(length(s->at(t).velocity_m_s - 1e3 * circle(t).velocity_m_s), 0, 1e-8) << t;
    }
    // States that do not agree fade into each other; the velocity is the derivative of the position.
    words[6] += 10;
    const auto faded = loaded(segment(5, 0, 12000, words));
    const Vec3d difference =
        (faded->at(2500.5).position_m - faded->at(2499.5).position_m) - faded->at(2500).velocity_m_s;
    EXPECT_NEAR(length(difference), 0, 1e-3);
}

TEST(TwoBody, EllipsesParabolasAndHyperbolasKeepEnergyAndMomentum) {
    for (const double speed : {0.3, 1.0, std::sqrt(2.0), 1.9})
        for (const double t : {-40.0, -1.0, 0.1, 3.0, 200.0}) {
            const StateVector start{{1, 0.2, 0}, {0.1, speed, 0.3}};
            const StateVector s = two_body_state(start, 1, t);
            const auto energy = [](const StateVector& v) {
                return 0.5 * dot(v.velocity_m_s, v.velocity_m_s) - 1 / length(v.position_m);
            };
            EXPECT_NEAR(energy(s), energy(start), 1e-11) << speed << " " << t;
            EXPECT_NEAR(
                length(cross(s.position_m, s.velocity_m_s) - cross(start.position_m, start.velocity_m_s)), 0,
                1e-11);
            const StateVector back = two_body_state(s, 1, -t);
            EXPECT_NEAR(length(back.position_m - start.position_m), 0, 1e-9) << speed << " " << t;
        }
}

// A record of m terms whose acceleration is D1 + D2 tau / g1 + D3 tau (tau + g1) / (g1 g2).
std::vector<double> differences(std::size_t m, double epoch) {
    std::vector<double> r = {epoch};
    for (std::size_t i = 0; i < m; ++i) r.push_back(i == 0 ? 100 : i == 1 ? 250 : 400);
    r.insert(r.end(), {7000, 1, -200, 7, 30, -0.5});
    for (const double scale : {1.0, -2.0, 0.5})
        for (std::size_t i = 0; i < m; ++i)
            r.push_back(scale * (i == 0 ? 1e-3 : i == 1 ? 2e-4 : i == 2 ? -3e-5 : 0));
    r.insert(r.end(), {4, 3, 3, 3});
    return r;
}

TEST(SpkSegment, ModifiedDifferencesAreIntegratedExactly) {
    for (const std::size_t m : {15u, 20u}) {
        std::vector<double> words = differences(m, 1000);
        const auto second = differences(m, 2000);
        words.insert(words.end(), second.begin(), second.end());
        words.insert(words.end(), {1000, 2000});
        if (m == 20) words.push_back(static_cast<double>(4 * m + 11));
        words.push_back(2);
        const auto s = loaded(segment(m == 15 ? 1 : 21, 500, 2000, words));
        for (const double t : {500.0, 900.0, 1000.0}) {
            const double d = t - 1000;
            // Integrals of 1, tau / 100 and (tau^2 + 100 tau) / 25000.
            const double v = 1e-3 * d + 2e-4 * d * d / 200 - 3e-5 * (d * d * d / 3 + 50 * d * d) / 25000;
            const double p = 1e-3 * d * d / 2 + 2e-4 * d * d * d / 600 -
                             3e-5 * (d * d * d * d / 12 + 50 * d * d * d / 3) / 25000;
            const StateVector at = s->at(t);
            EXPECT_NEAR(at.position_m.x, 1e3 * (7000 + d + p), 1e-6);
            EXPECT_NEAR(at.position_m.y, 1e3 * (-200 + 7 * d - 2 * p), 1e-6);
            EXPECT_NEAR(at.velocity_m_s.z, 1e3 * (-0.5 + 0.5 * v), 1e-9);
        }
        EXPECT_NEAR(s->at(1000.001).position_m.x, 1e3 * (7000 - 999.999), 2e6);  // the second record counts
        EXPECT_GT(std::abs(s->at(1000.001).position_m.x - s->at(1000).position_m.x), 1e3);
    }
}

TEST(SpkSegment, DamagedSegmentsAreRefusedInOneLine) {
    const Cubic m{0};
    std::vector<double> words = chebyshev_words(m, 0, false);
    words.back() = 4;
    EXPECT_THAT(
        refusal(segment(2, 0, 600, words)),
        HasSubstr("test.bsp: segment 1 ('TEST', body -99, type 2): has 46 words; its counts ask for 60"));
    words.back() = 0.5;
    EXPECT_THAT(refusal(segment(2, 0, 600, words)),
                HasSubstr("records: found 0.5; accepted: a whole number"));
    EXPECT_THAT(
        refusal(segment(11, 0, 1, {1, 2})),
        HasSubstr("found type 11; accepted: 1, 2, 3, 5, 8, 9, 10, 12, 13, 14, 15, 17, 18, 19, 20, 21"));
    EXPECT_THAT(refusal(segment(14, 0, 1, {1, 2})),
                HasSubstr("items at its end: found 2; accepted: a whole number, 17"));
    words = packets_words(m, {0, 40, 200, 600});
    words[0] = 2;
    EXPECT_THAT(refusal(segment(14, 0, 600, words)),
                HasSubstr("degree: found 2 and packets of 26 words; accepted: 2 and six times"));
    words = piecewise_words(m, {0, 250, 700}, true);
    EXPECT_THAT(refusal(segment(19, 0, 701, words)),
                HasSubstr("its series go from 0 to 700 s; accepted: over all of its span"));
    words[words.size() - 4] = 1e6;
    EXPECT_THAT(refusal(segment(19, 0, 700, words)), HasSubstr("begin of a series: found 1000000; accepted"));
    EXPECT_THAT(refusal(segment(9, 0, 1, {0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1, 5, 5, 1, 2})),
                HasSubstr("time 2: found 5 after 5"));
    EXPECT_THAT(refusal(segment(8, 0, 1, {0, 0, 0, 0, 0, 0, 0, 1, 3, 1})),
                HasSubstr("has 1 states; accepted: as many as its window, 4"));
    EXPECT_THAT(refusal(segment(5, 0, 1, {1, 0, 0, 0, 1, 0, 0, -4, 1})),
                HasSubstr("gravity: found -4; accepted: above 0"));
    EXPECT_THAT(refusal(segment(2, 9, 1, {1, 2})), HasSubstr("ends at 1 s, before it begins at 9 s"));
    EXPECT_THAT(refusal(segment(2, 0, 1, {NAN, 2})), HasSubstr("word 1 is no number"));
}

}  // namespace
}  // namespace hilcam
