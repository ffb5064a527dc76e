#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "io/orbits/sgp4.h"
#include "io/orbits/two_body.h"
#include "io/spice/earth_of_date.h"
#include "io/spice/spk_segment.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/units.h"
#include "tests/support/spice_writer.h"

namespace hilcam {
namespace {

using testing::HasSubstr;

std::unique_ptr<SpkSegment> loaded_elements(int type, double start, double stop, std::vector<double> words,
                                            int frame = 1) {
    const DafFile file(
        SpiceWriter("SPK").add({"TEST", start, stop, {-99, 399, frame, type}, std::move(words)}).bytes(),
        "test.bsp");
    return load_spk_segment(file, file.arrays().front());
}
std::string elements_refusal(int type, std::vector<double> words, int frame = 1, double start_et_s = 0) {
    try {
        loaded_elements(type, start_et_s, start_et_s + 100, std::move(words), frame);
    } catch (const InputError& error) {
        return error.what();
    }
    return "nothing";
}

// --- Type 17

// The elements and the results of the example in the header of NAIF's eqncpv_c.c (CSPICE N0067), to the digits there.
TEST(SpkEquinoctial, GivesTheStatesOfNaifsExample) {
    const double p = 1e4, gravity = 398600.436, e = 0.1, a = p / (1 - e), n = std::sqrt(gravity / a) / a;
    const double argument = 30 * kDegree_rad, node = 15 * kDegree_rad, inclination = 10 * kDegree_rad,
                 anomaly = 45 * kDegree_rad, epoch = -1e8;
    const auto segment =
        loaded_elements(17, -2e8, 0,
                        {epoch, a, e * std::sin(argument + node), e * std::cos(argument + node),
                         anomaly + argument + node, std::tan(inclination / 2) * std::sin(node),
                         std::tan(inclination / 2) * std::cos(node), 0, n, 0, -kPi / 2, kPi / 2});
    struct Row {
        Vec3d position_km, velocity_km_s;
    };
    const std::array<Row, 4> published = {{
        {{-10732.167433, 3902.505791, 1154.451615}, {-2.540767, -5.152269, -0.761576}},
        {{-11278.382863, 2586.179875, 955.184099}, {-1.827156, -5.362916, -0.830020}},
        {{-11645.295454, 1228.612448, 740.709574}, {-1.108096, -5.482811, -0.883256}},
        {{-11832.799901, -147.990984, 514.805250}, {-0.393421, -5.515905, -0.921508}},
    }};
    for (std::size_t i = 0; i < published.size(); ++i) {
        const StateVector s = segment->at(epoch - 1e4 + 250 * static_cast<double>(i + 1));
        EXPECT_LT(length(s.position_m - 1e3 * published[i].position_km), 2e-3) << i;
        EXPECT_LT(length(s.velocity_m_s - 1e3 * published[i].velocity_km_s), 2e-3) << i;
    }
}

// Where node and periapsis turn by given rates about an equator that leans, the velocity is the position's derivative, and both
// angles turn at those rates.
TEST(SpkEquinoctial, PrecessesAsToldAndItsVelocityIsTheDerivative) {
    const double a = 24'000, n = 1.7e-4, node_rate = -3e-7, periapsis_rate = 2e-7;
    const auto segment =
        loaded_elements(17, 0, 1e6, {0, a, 0.1, 0.2, 1.0, 0.3, -0.1, periapsis_rate, n, node_rate, 2.0, 0.9});
    for (const double t : {10.0, 3e3, 4.5e5, 9e5}) {
        const Vec3d by_difference = 0.5 * (segment->at(t + 1).position_m - segment->at(t - 1).position_m);
        EXPECT_LT(length(segment->at(t).velocity_m_s - by_difference), 2e-4) << t;
        // The orbit's pole turns about the equator's by the node's rate.
        const Vec3d pole{std::cos(0.9) * std::cos(2.0), std::cos(0.9) * std::sin(2.0), std::sin(0.9)};
        const double inclination = 2 * std::atan(std::hypot(0.3, 0.1));
        const double node = std::atan2(0.3, -0.1) + node_rate * t;
        const Vec3d x{-std::sin(2.0), std::cos(2.0), 0}, y = cross(pole, x);
        const Vec3d normal =
            std::cos(inclination) * pole + std::sin(inclination) * (std::sin(node) * x - std::cos(node) * y);
        EXPECT_NEAR(dot(normal, segment->at(t).position_m) / (1e3 * a), 0, 1e-12) << t;
    }
}

// --- Type 15

struct Conic {
    double epoch = 0;
    Vec3d pole{0, 0, 1}, periapsis{1, 0, 0};
    double semi_latus = 9000, eccentricity = 0.2, flag = 0;
    Vec3d body_pole{0, 0, 1};
    double gravity = 398600.4418, j2 = 1.08262668e-3, radius = 6378.137;
    std::vector<double> words() const {
        return {epoch,       pole.x,     pole.y,       pole.z, periapsis.x, periapsis.y,
                periapsis.z, semi_latus, eccentricity, flag,   body_pole.x, body_pole.y,
                body_pole.z, gravity,    j2,           radius};
    }
    double period_s() const {
        const double a = semi_latus / (1 - eccentricity * eccentricity);
        return kTurn_rad * std::sqrt(a * a * a / gravity);
    }
};

// Without J2, or by the flag, it is the motion of two bodies, hyperbolas too.
TEST(SpkPrecessingConic, WithoutJ2ItIsTheMotionOfTwoBodies) {
    for (const double e : {0.0, 0.2, 1.0, 1.7}) {
        Conic c;
        c.eccentricity = e, c.flag = 3;
        const auto flagged = loaded_elements(15, -1e5, 1e5, c.words());
        c.flag = 0, c.j2 = 0;
        const auto without = loaded_elements(15, -1e5, 1e5, c.words());
        const double speed = std::sqrt(c.gravity / c.semi_latus) * (1 + e);
        const StateVector start{{c.semi_latus / (1 + e), 0, 0}, {0, speed, 0}};
        for (const double t : {-5e4, -100.0, 0.0, 3333.0, 9e4}) {
            const StateVector expected = two_body_state(start, c.gravity, t);
            EXPECT_LT(length(flagged->at(t).position_m - 1e3 * expected.position_m), 1e-3) << e << ' ' << t;
            EXPECT_LT(length(without->at(t).velocity_m_s - 1e3 * expected.velocity_m_s), 1e-6)
                << e << ' ' << t;
        }
    }
}

// The orbits of a Sun-synchronous satellite: at 800 km and 98.60 deg the node goes with the mean Sun, 0.9856 deg a day (Wertz &
// Larson, Space Mission Analysis and Design, 3rd ed., 1999, table of orbits). The inclination there has two digits: 0.1 %.
TEST(SpkPrecessingConic, ASunSynchronousNodeGoesWithTheSun) {
    const double inclination = 98.60 * kDegree_rad;
    Conic c;
    c.pole = {0, -std::sin(inclination), std::cos(inclination)};
    c.semi_latus = 6378.137 + 800, c.eccentricity = 1e-9;
    const auto segment = loaded_elements(15, 0, 1e8, c.words());
    const double day = 86400, days = 100;
    const auto node_rad = [&](double t) {
        const StateVector s = segment->at(t);
        const Vec3d normal = cross(s.position_m, s.velocity_m_s);
        return std::atan2(normal.x, -normal.y);
    };
    const double moved_deg = std::remainder(node_rad(days * day) - node_rad(0), kTurn_rad) / kDegree_rad;
    EXPECT_NEAR(moved_deg, 0.98565 * days, 0.001 * 98.565);
}

// After whole periods node and periapsis have moved by 2 pi times their rates, each only where its flag lets it, and not where the
// orbit meets the body.
TEST(SpkPrecessingConic, NodeAndPeriapsisGoByTheirFlags) {
    Conic c;
    c.pole = normalized(Vec3d{0.5, 0.1, 0.8});
    c.periapsis = normalized(cross(c.pole, Vec3d{0, 1, 0.3}));
    c.body_pole = normalized(Vec3d{-0.2, 0.3, 1});
    const double cosine = dot(c.pole, c.body_pole), periods = 40;
    const double scale =
        1.5 * c.j2 * (c.radius / c.semi_latus) * (c.radius / c.semi_latus) * kTurn_rad * periods;
    const auto turned = [](Vec3d v, Vec3d axis, double angle) {
        const Vec3d along = dot(v, axis) * axis;
        return along + std::cos(angle) * (v - along) + std::sin(angle) * cross(axis, v);
    };
    for (const double flag : {0.0, 1.0, 2.0, 3.0}) {
        c.flag = flag;
        const double node = flag == 2 || flag == 3 ? 0 : -scale * cosine;
        const double periapsis = flag == 1 || flag == 3 ? 0 : scale * (2.5 * cosine * cosine - 0.5);
        const Vec3d expected = turned(turned(c.periapsis, c.pole, periapsis), c.body_pole, node);
        const StateVector s = loaded_elements(15, 0, 1e8, c.words())->at(periods * c.period_s());
        EXPECT_LT(length(normalized(s.position_m) - expected), 1e-9) << flag;
    }
    c.flag = 0, c.radius = 8000;  // the periapsis is 7500 km
    const StateVector s = loaded_elements(15, 0, 1e8, c.words())->at(periods * c.period_s());
    EXPECT_LT(length(normalized(s.position_m) - c.periapsis), 1e-9);
}

TEST(SpkElements, DamagedSegmentsAreRefusedInOneLine) {
    EXPECT_THAT(elements_refusal(15, {1, 2}), HasSubstr("type 15): has 2 words; its counts ask for 16"));
    EXPECT_THAT(elements_refusal(17, {1, 2}), HasSubstr("type 17): has 2 words; its counts ask for 12"));
    Conic c;
    c.semi_latus = 0;
    EXPECT_THAT(elements_refusal(15, c.words()), HasSubstr("semi-latus rectum: found 0; accepted: above 0"));
    c = {};
    c.periapsis = {1, 0, 0.1};
    EXPECT_THAT(elements_refusal(15, c.words()), HasSubstr("periapsis: does not lie in the orbit's plane"));
    c = {};
    c.eccentricity = -0.1;
    EXPECT_THAT(elements_refusal(15, c.words()),
                HasSubstr("eccentricity: found -0.1; accepted: 0 and above"));
    EXPECT_THAT(elements_refusal(17, {0, 7000, 0.7, 0.7, 0, 0, 0, 0, 1e-3, 0, 0, 0}),
                HasSubstr("eccentricity: found 0.9899494937; accepted: up to 0.9"));
    EXPECT_THAT(elements_refusal(17, {0, -1, 0, 0, 0, 0, 0, 0, 1e-3, 0, 0, 0}),
                HasSubstr("semi-major axis: found -1; accepted: above 0"));
}

// --- Type 10

const std::vector<double> kWgs72 = {1.082616e-3, -2.53881e-6, -1.65597e-6, 7.43669161e-2,
                                    120,         78,          6378.135,    1};

// A packet: elements, then the nutation, which is not read.
struct Elements {
    double bstar, inclination_deg, node_deg, eccentricity, perigee_deg, anomaly_deg, turns_day, epoch_et_s;
    std::vector<double> packet() const {
        return {0,
                0,
                bstar,
                inclination_deg * kDegree_rad,
                node_deg * kDegree_rad,
                eccentricity,
                perigee_deg * kDegree_rad,
                anomaly_deg * kDegree_rad,
                turns_day * kTurn_rad / 1440,
                epoch_et_s,
                9,
                9,
                9,
                9};
    }
};
std::vector<double> two_line_words(const std::vector<Elements>& sets,
                                   std::vector<double> constants = kWgs72) {
    std::vector<double> words = std::move(constants);
    for (const Elements& e : sets) {
        const std::vector<double> packet = e.packet();
        words.insert(words.end(), packet.begin(), packet.end());
    }
    const auto times = static_cast<double>(words.size()), count = static_cast<double>(sets.size());
    for (const Elements& e : sets) words.push_back(e.epoch_et_s);
    const auto end = static_cast<double>(words.size());
    words.insert(words.end(), {0, 8, end, 0, 0, times, count, end, 0, 0, 8, count, end, 0, 14, 0, 17});
    return words;
}
// 2020-05-25T14:35:35.525184 UTC and 2020-05-26T02:25:00 UTC: TDB - UTC is 69.184 s and 1.0 and 0.9 ms (Fairhead & Bretagnon).
constexpr double kEpoch_et_s = 643'689'404.7102276, kLater_et_s = 643'731'969.1850327;
const Elements kLume{0.34965e-4, 97.2676, 47.2136, 0.0020001, 220.6050, 139.3698, 15.24999521, kEpoch_et_s};

Vec3d in_teme(double et_s, Vec3d j2000) {
    return transposed(earth_of_date(EarthAxes::kTeme, et_s).reference_from_frame) * j2000;
}

// NAIF's CSPICE gives this state of LUME-1 (SpiceyPy's tests, test_evsgp4: km, km/s, TEME), here by way of J2000 and back.
TEST(SpkTwoLine, GivesTheStateThatCspiceGives) {
    const auto segment = loaded_elements(10, kEpoch_et_s - 1e5, kEpoch_et_s + 1e5, two_line_words({kLume}));
    const StateVector s = segment->at(kLater_et_s);
    EXPECT_LT(length(in_teme(kLater_et_s, s.position_m) -
                     1e3 * Vec3d{-4644.60403398, -5038.95025539, -337.27141116}),
              0.05);
    EXPECT_LT(
        length(in_teme(kLater_et_s, s.velocity_m_s) - 1e3 * Vec3d{-0.45719025, 0.92884817, -7.55917355}),
        2e-4);
}

// Between two sets the state goes from the one's to the other's, and its velocity with it.
TEST(SpkTwoLine, OneSetFadesIntoTheNext) {
    Elements next = kLume;
    next.epoch_et_s += 86'400;
    next.anomaly_deg = std::fmod(139.3698 + 360 * 15.24999521, 360);
    const auto both = loaded_elements(10, kEpoch_et_s, next.epoch_et_s, two_line_words({kLume, next}));
    const auto first = loaded_elements(10, kEpoch_et_s, next.epoch_et_s, two_line_words({kLume})),
               second = loaded_elements(10, kEpoch_et_s, next.epoch_et_s, two_line_words({next}));
    EXPECT_LT(length(both->at(kEpoch_et_s).position_m - first->at(kEpoch_et_s).position_m), 1e-6);
    EXPECT_LT(length(both->at(next.epoch_et_s).position_m - second->at(next.epoch_et_s).position_m), 1e-6);
    const double middle = kEpoch_et_s + 43'200;
    EXPECT_LT(length(both->at(middle).position_m -
                     0.5 * (first->at(middle).position_m + second->at(middle).position_m)),
              1e-3);
    // SGP4's own velocity is a centimetre a second off its positions: what fades adds its part alone.
    for (const double t : {kEpoch_et_s + 5000, middle, kEpoch_et_s + 80'000}) {
        const auto beyond = [&](const SpkSegment& segment) {
            return segment.at(t).velocity_m_s -
                   0.5 * (segment.at(t + 1).position_m - segment.at(t - 1).position_m);
        };
        const double weight = 0.5 + 0.5 * std::cos(kPi * (t - kEpoch_et_s) / 86'400);
        EXPECT_LT(length(beyond(*both) - weight * beyond(*first) - (1 - weight) * beyond(*second)), 1e-4);
        EXPECT_GT(length(first->at(t).position_m - second->at(t).position_m), 10);
    }
}

TEST(SpkTwoLine, DamagedSegmentsAreRefusedInOneLine) {
    const auto refused_set = [](std::vector<double> words, int frame = 1, double start_et_s = kEpoch_et_s) {
        return elements_refusal(10, std::move(words), frame, start_et_s);
    };
    std::vector<double> other = kWgs72;
    other[6] = 6378.137;
    EXPECT_EQ(refused_set(two_line_words({kLume}, other)), "nothing");  // within what kernels round
    other[0] = 1.0827e-3;
    EXPECT_THAT(refused_set(two_line_words({kLume}, other)),
                HasSubstr("J2: found 0.0010827; accepted: 0.001082616 (WGS 72)"));
    EXPECT_THAT(refused_set(two_line_words({kLume}), 17), HasSubstr("frame: found 17; accepted: 1 (J2000)"));
    Elements broken = kLume;
    broken.eccentricity = 1.5;
    EXPECT_THAT(refused_set(two_line_words({broken})), HasSubstr("packet 1: eccentricity: found 1.5"));
    broken = kLume;
    broken.turns_day = 17.5;
    EXPECT_THAT(refused_set(two_line_words({broken})),
                HasSubstr("packet 1: its elements are no orbit above the ground"));
    std::vector<double> words = two_line_words({kLume});
    words[words.size() - 18] += 1;
    EXPECT_THAT(refused_set(words), HasSubstr("packet 1: its epoch is"));
    EXPECT_THAT(refused_set({1, 2}), HasSubstr("items at its end: found 2"));
    EXPECT_THAT(refused_set(two_line_words({kLume}), 1, 0),
                HasSubstr("packet 1: stands for 0 s, years from its epoch"));
    broken = kLume;
    broken.epoch_et_s = 1e12;
    EXPECT_THAT(refused_set(two_line_words({broken})),
                HasSubstr("packet 1: its epoch is 1e+12 s; accepted: the years"));
}

// Vallado, Fundamentals of Astrodynamics and Applications, 4th ed., 2013, example 3-15: a state of 2004-04-06T07:51:28.386009 UTC
// in TEME, and in J2000 by IAU 1976/1980 without corrections.
TEST(EarthOfDate, TemeTurnsIntoJ2000AsPublished) {
    constexpr double kEt_s = 134'509'952.5716639;
    const Vec3d found = earth_of_date(EarthAxes::kTeme, kEt_s).reference_from_frame *
                        Vec3d{5094180.16210, 6127644.65950, 6380344.53270};
    EXPECT_LT(length(found - Vec3d{5102509.600, 6123011.520, 6378136.300}), 0.5);
}

// The rate is the derivative of the turn, and the true equator nutates about the mean one by 9.2 arcsec.
TEST(EarthOfDate, AxesTurnAtTheirRates) {
    for (const EarthAxes axes :
         {EarthAxes::kMeanEquator, EarthAxes::kTrueEquator, EarthAxes::kMeanEcliptic, EarthAxes::kTeme})
        for (const double et_s : {-3e8, 0.0, 7.5e8}) {
            const FrameTurn turn = earth_of_date(axes, et_s), later = earth_of_date(axes, et_s + 20'000);
            const auto z = [](const FrameTurn& t) { return transposed(t.reference_from_frame).z; };
            const Vec3d moved = z(later) - z(turn);
            const Vec3d by_rate = 1e4 * (cross(turn.rate_rad_s, z(turn)) + cross(later.rate_rad_s, z(later)));
            EXPECT_LT(length(moved - by_rate), 1e-3 * length(moved) + 1e-12);
        }
    double max_rad = 0;
    for (double et_s = 0; et_s < 6e8; et_s += 1e6) {
        const Vec3d mean = transposed(earth_of_date(EarthAxes::kMeanEquator, et_s).reference_from_frame).z,
                    real = transposed(earth_of_date(EarthAxes::kTrueEquator, et_s).reference_from_frame).z;
        max_rad = std::max(max_rad, length(mean - real));
    }
    EXPECT_NEAR(max_rad / kArcsecond_rad, 9.2, 1.0);
}

}  // namespace
}  // namespace hilcam
