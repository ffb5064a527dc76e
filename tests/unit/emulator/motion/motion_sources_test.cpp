#include <gmock/gmock.h>

#include "emulator/motion/attitude_laws.h"
#include "emulator/motion/placed_frame.h"
#include "emulator/motion/trajectories.h"
#include "render/sky/earth_frames.h"
#include "render/vocabulary/earth_orientation.h"
#include "render/vocabulary/time_system.h"
#include "render/vocabulary/units.h"
#include "tests/support/motion.h"

namespace hilcam {
namespace {

using testing::HasSubstr;

constexpr std::int64_t kSecond = 1'000'000'000;

StateVector state_of(const Trajectory& trajectory, TimeTai time, const OriginConfig& origin = {}) {
    const WorldFrame frame(time, origin);
    return trajectory.at({frame, {}});
}

// --- a published place and time ---

// Skyfield's documentation (rhodesmill.org/skyfield/earth-satellites.html): the ISS by this element set at
// 2014-01-23T11:18:07 UTC, over Lake Superior's north shore; GCRS position in km, WGS 84 latitude 50 deg
// 14' 37.4" and longitude -86 deg 23' 23.3". Skyfield goes by IAU 2000A and the true UT1; ours, without UT1 -
// UTC, differs in GCRS by IAU 2000B's 1 mas and by the equinox's complementary terms, 2.6 mas of 6800 km: 0.1
// m.
TEST(TleTrajectory, TheIssIsWhereAnotherProgramSays) {
    const auto iss = make_tle(read_element_sets(kIss, "iss.tle").at(0), 30 * 86400.0);
    const TimeTai time = parse_utc("2014-01-23T11:18:07Z");
    const StateVector found = state_of(*iss, time);
    EXPECT_LT(length(found.position_m - Vec3d{-3918876.50458, -1887648.38745, 5209088.01512}), 0.2);
    // Over the ground: 0.05" of printing, and of longitude UT1 - UTC, below 0.9 s by definition, 13.5".
    const Vec3d place = earth_fixed_from_icrf(time, {}) * found.position_m;
    const Vec3d expected = earth_fixed_position_m({-(86 + 23 / 60.0 + 23.3 / 3600) * kDegree_rad,
                                                   (50 + 14 / 60.0 + 37.4 / 3600) * kDegree_rad, 420.874e3});
    const double north = std::asin(normalized(place).z) - std::asin(normalized(expected).z);
    EXPECT_LT(std::abs(north), 0.2 * kArcsecond_rad);
    EXPECT_LT(std::abs(std::atan2(place.y, place.x) - std::atan2(expected.y, expected.x)),
              13.6 * kArcsecond_rad);
    EXPECT_NEAR(length(place), length(expected), 50);
}

// A satellite that decays: known until then, and it stands still after.
TEST(TleTrajectory, EndsWhereTheTheoryEnds) {
    const std::string text =
        "1 28872U 05037B   05333.02012661  .25992681  00000-0  24476-3 0  1534\n"
        "2 28872  96.4736 157.9986 0303955 244.0492 110.6523 16.46015938 10708\n";
    const ElementSet tle = read_element_sets(text, "decays.tle").at(0);
    const auto trajectory = make_tle(tle, 86400);
    // The published set says that it decays between 50 and 55 minutes.
    EXPECT_EQ(trajectory->validity(tle.epoch + 50 * 60 * kSecond).status, MotionStatus::kOk);
    const MotionValidity after = trajectory->validity(tle.epoch + 55 * 60 * kSecond);
    EXPECT_EQ(after.status, MotionStatus::kAfter);
    EXPECT_NEAR(length(state_of(*trajectory, after.nearest).position_m), 6378135, 200);
}

// --- ephemerides in the world ---

// Vallado 2013, example 3-15 (see tests/unit/render/sky/earth_frames_test.cpp): a state in ITRF with that
// day's orientation of the Earth, and in GCRF.
TEST(WorldFrame, EarthFixedStatesAreThePublishedOnes) {
    const TimeTai time = from_calendar({2004, 4, 6, 7, 51, 28.386009}, TimeSystem::kUtc).value();
    OriginConfig origin;
    origin.earth = {-0.4399619, -0.140682 * kArcsecond_rad, 0.333309 * kArcsecond_rad};
    const TurningAxes earth = WorldFrame(time, origin).body_fixed(BodyId::kEarth);
    const StateVector found = world_state({{}, earth}, {{-1033479.3830, 7901295.2754, 6380356.5958},
                                                        {-3225.636520, -2872.451450, 5531.924446}});
    // Nutation of 2000B and printing.
    EXPECT_LT(length(found.position_m - Vec3d{5102508.95290, 6123011.39910, 6378136.93380}), 0.25);
    // The rate in the table's time has the length of day of that date, 1.6 ms: 2e-8 of omega x r, 580 m/s.
    EXPECT_LT(length(found.velocity_m_s - Vec3d{-4743.2201610, 790.5364950, 5533.7557240}), 2.5e-4);
}

// The same motion written in seven frames is the same in the world: to the rounding of a double, and for
// velocities that of the sample's frame.
TEST(OemTrajectory, TurnsEveryFrameIntoTheWorlds) {
    const TimeTai start = parse_utc("2026-03-20T06:00:00Z");
    const KeplerOrbit orbit({7e6, 0.01, 1, 2, 3, 0}, 3.986e14);
    const auto segments_in = [&](CcsdsFrame frame) {
        OemSegment s;
        s.center_name = "EARTH";
        s.frame = frame;
        s.interpolation = {InterpolationMethod::kHermite, 11};
        for (int i = 0; i < 12; ++i) {
            const TimeTai time = start + i * 30 * kSecond;
            const StateVector icrf = orbit.at(30.0 * i);
            StateVector in = icrf;
            if (frame == CcsdsFrame::kEme2000 || frame == CcsdsFrame::kTeme || frame == CcsdsFrame::kTod ||
                frame == CcsdsFrame::kMod) {
                const Mat3d turn = transposed(frame == CcsdsFrame::kTeme  ? icrf_from_teme(time, {})
                                              : frame == CcsdsFrame::kTod ? icrf_from_true_of_date(time)
                                              : frame == CcsdsFrame::kMod ? icrf_from_mean_of_date(time)
                                                                          : icrf_from_eme2000());
                in = {turn * icrf.position_m, turn * icrf.velocity_m_s};
            } else if (frame == CcsdsFrame::kEarthFixed || frame == CcsdsFrame::kGtod) {
                // Without polar motion the two are one.
                const Mat3d turn = earth_fixed_from_icrf(time, {});
                const Vec3d position = turn * icrf.position_m;
                in = {position, turn * icrf.velocity_m_s - cross(Vec3d{0, 0, kEarthRate_rad_s}, position)};
            }
            s.states.push_back({time, in.position_m, in.velocity_m_s});
        }
        s.usable_start = s.states.front().time, s.usable_stop = s.states.back().time;
        return std::vector<OemSegment>{s};
    };
    for (const CcsdsFrame frame :
         {CcsdsFrame::kIcrf, CcsdsFrame::kEme2000, CcsdsFrame::kEarthFixed, CcsdsFrame::kTeme,
          CcsdsFrame::kTod, CcsdsFrame::kMod, CcsdsFrame::kGtod}) {
        const auto trajectory = make_oem(segments_in(frame), "t.oem");
        const StateVector found = state_of(*trajectory, start + 155 * kSecond);
        const StateVector expected = orbit.at(155);
        // Hermite's remainder with six nodes 30 s apart, (n h)^12 / 12! R (0.5 1.5 2.5)^4, is below 1e-15 m.
        // Velocities in axes of date lack precession and nutation, 2e-11 rad/s at most.
        const bool of_date = frame != CcsdsFrame::kIcrf && frame != CcsdsFrame::kEme2000;
        const double turning_m_s = of_date ? 2e-11 * 7e6 : 0;
        EXPECT_LT(length(found.position_m - expected.position_m), 1e-6 + 30 * turning_m_s)
            << static_cast<int>(frame);
        EXPECT_LT(length(found.velocity_m_s - expected.velocity_m_s), 1e-6 + 2 * turning_m_s)
            << static_cast<int>(frame);
    }
    auto mars = segments_in(CcsdsFrame::kIcrf);
    mars[0].center_name = "PHOBOS";
    mars[0].line = 5;
    try {
        make_oem(mars, "t.oem");
        FAIL();
    } catch (const InputError& error) {
        EXPECT_THAT(error.what(), HasSubstr("t.oem:5: CENTER_NAME: found 'PHOBOS'; accepted: SUN, MERCURY"));
    }
}

// GTOD is ITRF but for the pole's motion: 10 m with a pole that is 0.3 arcsec off, at the height of the ground.
TEST(OemTrajectory, GtodLacksThePolesMotionAlone) {
    const TimeTai start = parse_utc("2026-03-20T06:00:00Z");
    OriginConfig origin;
    origin.earth = {0.1, 0.3 * kArcsecond_rad, 0};
    const auto found = [&](CcsdsFrame frame) {
        OemSegment s;
        s.center_name = "Earth";
        s.frame = frame;
        for (int i = 0; i < 4; ++i) s.states.push_back({start + i * kSecond, {0, 0, 6.4e6}, {}});
        s.usable_start = s.states.front().time, s.usable_stop = s.states.back().time;
        return state_of(*make_oem({s}, "t.oem"), start + kSecond, origin).position_m;
    };
    EXPECT_NEAR(length(found(CcsdsFrame::kGtod) - found(CcsdsFrame::kEarthFixed)),
                6.4e6 * 0.3 * kArcsecond_rad, 1e-3);
}

// A world that turns with the Earth: its origin stands still in the Earth's axes, which a place has, too.
TEST(WorldFrame, AnOriginMayTurn) {
    OriginConfig origin;
    origin.kind = OriginConfig::Kind::kEarthFixed;
    origin.place = {0.3, 0.8, 4e5};
    const WorldFrame frame(parse_utc("2026-03-20T06:00:00Z"), origin);
    PlacedFrame earth;
    earth.kind = PlacedFrame::Kind::kBodyFixed;
    const auto place = make_fixed(earth, {earth_fixed_position_m(origin.place), {}}, frame.time());
    const StateVector s = place->at({frame, {}});
    EXPECT_LT(length(s.position_m), 1e-8);
    EXPECT_LT(length(s.velocity_m_s), 1e-11);
}

// --- attitude laws ---

// Whatever looks where: the axis looks there, the second axis lies in the plane of both aims on its aim's
// side, and the rate is the attitude's, by central differences: (w h)^2 / 6 of it, and rounding over h.
TEST(Pointing, LooksWhereItShallAndKnowsItsRate) {
    const TimeTai start = parse_utc("2026-03-20T06:00:00Z");
    const KeplerOrbit own({7e6, 0.02, 1, 2, 3, 0}, gravity_m3_s2({})),
        other({7.01e6, 0.02, 1, 2, 3.001, 0}, gravity_m3_s2({}));
    const std::vector<Aim> aims = {{Aim::Kind::kNadir, {}, {}, 0},           {Aim::Kind::kSun, {}, {}, 0},
                                   {Aim::Kind::kVelocity, {}, {}, 0},        {Aim::Kind::kThing, {}, {}, 0},
                                   {Aim::Kind::kOrbitNormal, {}, {}, 0},     {Aim::Kind::kNorth, {}, {}, 0},
                                   {Aim::Kind::kDirection, {1, 2, 3}, {}, 0}};
    for (const Aim& first : aims)
        for (const Aim& second : aims) {
            if (first.kind == second.kind) continue;
            const Pointing p{{0, 0, 1}, first, {0, -1, 0}, second};
            const auto law = make_pointing(p);
            Motion thing;
            const auto at = [&](double t) {
                const WorldFrame frame(start + std::llround(t * 1e9), {});
                const StateVector s = other.at(t);
                thing.pose.position_world_m = s.position_m, thing.velocity_world_m_s = s.velocity_m_s;
                return law->at({frame, std::span(&thing, 1)}, own.at(t));
            };
            const auto direction = [&](const Aim& aim) {
                const WorldFrame frame(start + 100 * kSecond, {});
                const StateVector s = own.at(100);
                switch (aim.kind) {
                    case Aim::Kind::kNadir:
                        return -s.position_m;
                    case Aim::Kind::kSun:
                        return frame.center({std::nullopt}).position_m - s.position_m;
                    case Aim::Kind::kVelocity:
                        return s.velocity_m_s;
                    case Aim::Kind::kThing:
                        return other.at(100).position_m - s.position_m;
                    case Aim::Kind::kOrbitNormal:
                        return cross(s.position_m, s.velocity_m_s);
                    case Aim::Kind::kNorth:
                        return Vec3d{0, 0, 1};
                    case Aim::Kind::kDirection:
                        break;
                }
                return aim.direction;
            };
            const AttitudeState a = at(100);
            const Mat3d world = to_matrix(a.world_from_body);
            const Vec3d looks = world * p.axis, up = world * p.second_axis;
            EXPECT_GT(dot(looks, normalized(direction(first))), 1 - 1e-14);
            EXPECT_NEAR(dot(up, normalized(cross(direction(first), direction(second)))), 0, 1e-9);
            EXPECT_GT(dot(up, direction(second)), 0);
            constexpr double h = 0.05;
            const Vec3d rate =
                turn_between(at(100 - h).world_from_body, at(100 + h).world_from_body) / (2 * h);
            // Rates are 1e-3 rad/s; J2 is not in the orbit, so the velocity's is exact here.
            EXPECT_LT(length(rate - a.rate_body_rad_s), 1e-9)
                << static_cast<int>(first.kind) << " " << static_cast<int>(second.kind);
        }
    EXPECT_THROW(make_pointing({{0, 0, 1}, {}, {0, 0, -2}, {}}), InputError);
}

// Over a pole nadir and north are parallel: it still has an attitude.
TEST(Pointing, IsDefinedOverThePole) {
    Pointing p;
    p.aim.kind = Aim::Kind::kNadir;
    const WorldFrame frame(parse_utc("2026-03-20T06:00:00Z"), {});
    const AttitudeState a = make_pointing(p)->at({frame, {}}, StateVector{{0, 0, 7e6}, {7500, 0, 0}});
    EXPECT_LT(length(to_matrix(a.world_from_body) * Vec3d{0, 0, 1} - Vec3d{0, 0, -1}), 1e-12);
    EXPECT_TRUE(is_finite(a.rate_body_rad_s));
}

TEST(Turning, SpinsInItsFrame) {
    const TimeTai start = parse_utc("2026-03-20T06:00:00Z");
    PlacedFrame lvlh;
    lvlh.kind = PlacedFrame::Kind::kLvlh;
    const auto law = make_turning(lvlh, {{}, {0, 0, 0.1}}, start);
    const KeplerOrbit orbit({7e6, 0, 1, 2, 3, 0}, gravity_m3_s2({}));
    const auto at = [&](double t) {
        const WorldFrame frame(start + std::llround(t * 1e9), {});
        Motion self;
        self.pose.position_world_m = orbit.at(t).position_m,
        self.velocity_world_m_s = orbit.at(t).velocity_m_s;
        return law->at({frame, std::span(&self, 1)}, orbit.at(t));
    };
    // 10 pi s at 0.1 rad/s is half a turn about the local vertical.
    const double half_s = 10 * kPi;
    const Vec3d z = to_matrix(at(half_s).world_from_body) * Vec3d{0, 0, 1};
    EXPECT_LT(length(z + normalized(orbit.at(half_s).position_m)), 1e-9);
    const Vec3d x = to_matrix(at(half_s).world_from_body) * Vec3d{1, 0, 0};
    EXPECT_LT(length(x + normalized(orbit.at(half_s).velocity_m_s)), 1e-8);
    const Vec3d rate = turn_between(at(4.99).world_from_body, at(5.01).world_from_body) / 0.02;
    EXPECT_LT(length(rate - at(5).rate_body_rad_s), 1e-7);  // (w h)^2 / 24 of 0.1
}

// Over 2000 seeds the variance of an axis is that asked for, to 4 standard deviations of a variance of so
// many Gaussian draws, sqrt(2 / 2000); an axis that is not asked for stays still.
TEST(AttitudeJitter, HasTheDeviationAskedFor) {
    constexpr int kSeeds = 2000;
    JitterBand band;
    band.rms_rad = {1e-5, 2e-5, 0};
    double x2 = 0, y2 = 0;
    for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
        const AttitudeJitter jitter(band, seed, 3, {});
        const Vec3d turn = turn_between({}, jitter.applied({}, {}, {7 * kSecond}).world_from_body);
        x2 += turn.x * turn.x, y2 += turn.y * turn.y;
        EXPECT_LT(std::abs(turn.z), 1e-8);
    }
    const double tolerance = 4 * std::sqrt(2.0 / kSeeds);
    EXPECT_NEAR(x2 / kSeeds / 1e-10, 1, tolerance);
    EXPECT_NEAR(y2 / kSeeds / 4e-10, 1, tolerance);
}

TEST(AttitudeJitter, KnowsItsRateAndRepeats) {
    JitterBand band;
    band.rms_rad = {1e-5, 1e-5, 1e-5};
    const AttitudeJitter jitter(band, 5, 1, {}), again(band, 5, 1, {}), other(band, 5, 2, {});
    const auto angle = [](const AttitudeJitter& j, std::int64_t ns) {
        return turn_between({}, j.applied({}, {}, {ns}).world_from_body);
    };
    const std::int64_t h = 100'000, t = 3 * kSecond;
    const Vec3d rate = (angle(jitter, t + h) - angle(jitter, t - h)) / (2e-9 * h);
    // 2 pi 10 Hz of 1e-5 rad; (w h)^2 / 6 and the product of angle and rate are left out.
    EXPECT_LT(length(rate - jitter.applied({}, {}, {t}).rate_body_rad_s), 3e-8);
    EXPECT_EQ(angle(jitter, t).x, angle(again, t).x);
    EXPECT_NE(angle(jitter, t).x, angle(other, t).x);
}

// --- keyframes ---

TEST(Keyframes, PassThroughTheirPlaces) {
    const Quat quarter = from_rotation_vector({0, 0, kPi / 2});
    std::vector<Keyframe> frames(3);
    for (int i = 0; i < 3; ++i) frames[static_cast<std::size_t>(i)].time = {i * 10 * kSecond};
    frames[1].position_m = {100, 0, 0}, frames[2].position_m = {100, 100, 0};
    frames[1].attitude = quarter;
    const Keyframes k(frames);
    for (const Keyframe& f : frames) EXPECT_LT(length(k.state_at(f.time).position_m - f.position_m), 1e-12);
    // The middle one's velocity is its neighbours' chord, (100, 100) / 20 s.
    EXPECT_LT(length(k.state_at({10 * kSecond}).velocity_m_s - Vec3d{5, 5, 0}), 1e-12);
    const double h = 1e-3;
    const std::int64_t h_ns = 1'000'000;
    const Vec3d difference =
        (k.state_at({4 * kSecond + h_ns}).position_m - k.state_at({4 * kSecond - h_ns}).position_m) / (2 * h);
    EXPECT_LT(length(difference - k.state_at({4 * kSecond}).velocity_m_s), 1e-6);
    EXPECT_LT(length(turn_between(k.attitude_at({5 * kSecond}).world_from_body,
                                  from_rotation_vector({0, 0, kPi / 4}))),
              1e-12);
    EXPECT_NEAR(k.attitude_at({5 * kSecond}).rate_body_rad_s.z, kPi / 20, 1e-15);
    EXPECT_EQ(length(k.attitude_at({15 * kSecond}).rate_body_rad_s), 0);  // no attitude given: as before
    EXPECT_EQ(k.state_at({-5 * kSecond}).position_m.x, 0);
    EXPECT_EQ(k.state_at({99 * kSecond}).velocity_m_s.x, 0);
    frames[2].time = frames[1].time;
    EXPECT_THROW(Keyframes{frames}, InputError);
}

}  // namespace
}  // namespace hilcam
