// Things that move as a scenario says.

#include <gmock/gmock.h>

#include "emulator/scenario/initial_world.h"
#include "emulator/scenario/motion_builder.h"
#include "io/config/config_yaml.h"
#include "render/sky/own_bodies.h"
#include "render/vocabulary/time_system.h"
#include "render/vocabulary/units.h"
#include "tests/support/files.h"
#include "tests/support/motion.h"

namespace hilcam {
namespace {

using testing::HasSubstr;

constexpr std::int64_t kSecond = 1'000'000'000;

class MotionScenario : public FilesTest {
  protected:
    // A scenario with these lines for its motions.
    ScenarioConfig scenario(const std::string& lines, const std::string& utc = "2014-01-23T11:18:07Z") {
        write("iss.tle", kIss);
        const auto file =
            write("s.yaml", "time_utc: " + utc +
                                "\ncamera: {width_px: 16, height_px: 16, pitch_um: 5, focal_length_mm: "
                                "50, f_number: 8, quantum_efficiency: 0.5, full_well_e: 10000, "
                                "read_noise_e: 5, gain_dn_e: 0.3, bits: 12, exposure_ms: 1, "
                                "frame_rate_hz: 10}\n" +
                                lines);
        return load_scenario(file, {});
    }
    struct World {
        TimeTai start;
        WorldState state;
        explicit World(const ScenarioConfig& s)
            : start(parse_utc(s.time_utc)),
              state(initial_motions(s, start), s.origin, {}, {}, load_motion_sources(s)) {}
        WorldSnapshot at(double t_s) {
            WorldSnapshot out;
            out.objects.resize(state.placed_objects());
            ShownCommand shown;
            state.sample(start + std::llround(t_s * 1e9), out, shown);
            return out;
        }
    };
};

constexpr const char* kPair =
    "camera_motion: {kind: cw, of: iss, position_m: [-200, 0, 0], attitude: {law: object, of: iss}}\n"
    "objects:\n"
    "  - {name: iss, mesh: iss.obj, motion: {kind: tle, tle: {file: iss.tle}, attitude: {law: nadir, second: "
    "velocity, "
    "second_axis: [1, 0, 0]}}}\n";

// A camera on the V-bar of the ISS, 200 m behind it, looks at it.
TEST_F(MotionScenario, APairFlies) {
    World world(scenario(kPair));
    const WorldSnapshot now = world.at(0);
    EXPECT_LT(length(now.objects[0].position_world_m - Vec3d{-3918876.50458, -1887648.38745, 5209088.01512}),
              0.2);
    const Vec3d arm = now.objects[0].position_world_m - now.camera.position_world_m;
    EXPECT_NEAR(length(arm), 200, 1e-6);
    EXPECT_LT(length(to_matrix(now.camera.world_from_body) * Vec3d{0, 0, 1} - arm / 200), 1e-8);
    // Behind it: the ISS flies away from the camera, along its own x axis.
    const Vec3d ahead = to_matrix(now.objects[0].world_from_body) * Vec3d{1, 0, 0};
    EXPECT_GT(dot(arm / 200, ahead), 0.999);
    // A hold point on the V-bar stays where it is; velocities are those of the positions.
    const WorldSnapshot later = world.at(1000);
    EXPECT_NEAR(length(later.objects[0].position_world_m - later.camera.position_world_m), 200, 1e-6);
    const Vec3d moved = world.at(0.01).camera.position_world_m - world.at(-0.01).camera.position_world_m;
    // SGP4's velocity is its positions' derivative but for (1.5 J2)^2 of it.
    EXPECT_LT(length(moved / 0.02 - now.camera_velocity_m_s), 2.7e-6 * 7700);
    EXPECT_EQ(world.state.held(), 0u);
}

TEST_F(MotionScenario, ACommandTakesOver) {
    World world(scenario(kPair));
    Motion here;
    here.time = world.start;
    here.pose.position_world_m = {1, 2, 3};
    world.state.set(1, here, {1, 100});
    const WorldSnapshot now = world.at(5);
    EXPECT_EQ(now.objects[0].position_world_m.y, 2);
    // The camera follows it, where it is now: LVLH of a thing at rest is the world's axes.
    EXPECT_LT(length(now.camera.position_world_m - Vec3d{-199, 2, 3}), 1e-6);
}

TEST_F(MotionScenario, ThingsMayLookAtEachOtherButNotCarryEachOther) {
    const auto two = [](const std::string& first, const std::string& second) {
        return "objects:\n  - {name: a, mesh: a.obj, motion: " + first +
               "}\n  - {name: b, mesh: b.obj, motion: " + second + "}\n";
    };
    World world(scenario(two("{kind: fixed, attitude: {law: object, of: b}}",
                             "{kind: fixed, position_m: [10, 0, 0], attitude: {law: object, of: a}}")));
    const WorldSnapshot now = world.at(0);
    EXPECT_NEAR((to_matrix(now.objects[0].world_from_body) * Vec3d{0, 0, 1}).x, 1, 1e-15);
    EXPECT_NEAR((to_matrix(now.objects[1].world_from_body) * Vec3d{0, 0, 1}).x, -1, 1e-15);
    const auto error = [&](const std::string& text) {
        return error_of([&] { load_motion_sources(scenario(text)); });
    };
    EXPECT_THAT(error(two("{kind: fixed, frame: object, of: b}", "{kind: fixed, frame: lvlh, of: a}")),
                HasSubstr("motion of 'a': follows itself"));
    EXPECT_THAT(error(two("{kind: cw, of: b}", "{kind: cw, of: a}")), HasSubstr("follows itself"));
    EXPECT_THAT(error(two("{kind: cw, of: c}", "{kind: fixed}")),
                HasSubstr("of: found 'c'; accepted: camera, a, b"));
}

// What an orbit or attitude message has that is not used is said once, with the motion's key.
TEST_F(MotionScenario, WhatAMessageHasThatIsNotUsedIsSaid) {
    std::string oem =
        "CCSDS_OEM_VERS = 2.0\nMETA_START\nOBJECT_NAME = T\nOBJECT_ID = T\nCENTER_NAME = Earth\nREF_FRAME = "
        "ICRF\n"
        "TIME_SYSTEM = UTC\nSTART_TIME = 2014-01-23T11:18:00\nSTOP_TIME = 2014-01-23T11:19:00\nTRACKING_ID = "
        "7\n"
        "META_STOP\n2014-01-23T11:18:00 7000 0 0 0 7.5 0\n2014-01-23T11:19:00 7000 450 0 0 7.5 0\n";
    write("t.oem", oem);
    EXPECT_THAT(
        motion_warnings(scenario("camera_motion: {kind: oem, oem: {file: t.oem}}\n")),
        testing::ElementsAre(testing::AllOf(HasSubstr("camera_motion: "),
                                            HasSubstr("t.oem:10: the keyword 'TRACKING_ID' is not used"))));
    EXPECT_THAT(motion_warnings(scenario("camera_motion: {kind: tle, tle: {file: iss.tle}}\n")),
                testing::IsEmpty());
}

TEST_F(MotionScenario, WhatIsMissingIsNamed) {
    const auto error = [&](const std::string& motion) {
        return error_of([&] { load_motion_sources(scenario("camera_motion: " + motion + "\n")); });
    };
    EXPECT_THAT(error("{kind: tle}"), HasSubstr("has no 'tle'; kind tle needs it"));
    EXPECT_THAT(error("{kind: fixed, frame: lvlh}"), HasSubstr("has no 'of'"));
    EXPECT_THAT(error("{kind: kepler, kepler: {semi_major_axis_km: 7000, eccentricity: 1.5}}"),
                HasSubstr("semi_major_axis_km"));
    EXPECT_THAT(error("{kind: fixed, attitude: {axis: [0, 0, 1], second_axis: [0, 0, 1], law: nadir}}"),
                HasSubstr("motion of 'camera': axis and second_axis"));
    EXPECT_THAT(
        error_of([&] { scenario("camera_pose: {position_m: [0, 0, 1]}\ncamera_motion: {kind: fixed}\n"); }),
        HasSubstr("either 'camera_pose' or 'camera_motion'"));
    EXPECT_THAT(error_of([&] {
                    load_motion_sources(scenario("camera_motion: {kind: tle, tle: {file: iss.tle}}\n",
                                                 "2026-01-01T00:00:00Z"));
                }),
                HasSubstr("iss.tle:2: found the instant 2026-01-01T00:00:00.000Z; it ends at 2014-02-19"));
}

// Eros as Archinal et al. 2018 have it: 11.35, 17.22, 326.07 + 1639.38864745 d; against a body of the same angles.
TEST_F(MotionScenario, APoleAndARateAreTheIausAngles) {
    World world(
        scenario("objects:\n  - {name: eros, mesh: iss.obj, motion: {kind: fixed, position_m: [0, 0, 9000], "
                 "attitude: {law: pole, "
                 "pole_deg: [11.35, 17.22], meridian_deg: 326.07, rate_deg_day: 1639.38864745}}}\n"));
    OwnBody eros;
    eros.synchronous = false;
    eros.pole_right_ascension_rad = 11.35 * kDegree_rad, eros.pole_declination_rad = 17.22 * kDegree_rad;
    eros.meridian_rad = 326.07 * kDegree_rad, eros.rate_rad_s = 1639.38864745 * kDegree_rad / 86400;
    for (const double after_s : {0.0, 1.0, 5000.0}) {
        const WorldSnapshot now = world.at(after_s);
        const Mat3d world_from_body = to_matrix(now.objects[0].world_from_body);
        const Mat3d expected = transposed(fixed_from_icrf(eros, {}, now.time));
        for (const Vec3d axis : {Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}})
            EXPECT_LT(length(world_from_body * axis - expected * axis), 1e-8) << after_s;
    }
    const auto error = [&](const std::string& attitude) {
        return error_of([&] { scenario("camera_motion: {kind: fixed, attitude: " + attitude + "}\n"); });
    };
    EXPECT_THAT(error("{law: pole}"), HasSubstr("it needs 'pole_deg'"));
    EXPECT_THAT(error("{rate_deg_day: 3}"), HasSubstr("rate_deg_day: has no effect with this law"));
}

// Outside of what a file knows, with `hold`: the nearest place, at rest, and counted.
TEST_F(MotionScenario, OutsideItStandsStillAndSaysSo) {
    World world(scenario("camera_motion: {kind: tle, tle: {file: iss.tle, valid_days: 1}, outside: hold}\n"));
    const WorldSnapshot now = world.at(0), later = world.at(100);
    EXPECT_EQ(now.camera.position_world_m, later.camera.position_world_m);
    EXPECT_EQ(length(now.camera_velocity_m_s), 0);
    EXPECT_EQ(world.state.held(), 2u);
    EXPECT_THAT(world.state.first_gap(), HasSubstr("iss.tle:2: found the instant "));
    EXPECT_THAT(world.state.first_gap(), HasSubstr("Z; it ends at 2014-01-21T22:23:04.000Z"));
}

// What it was turned by its orbit stays as it was, and so does what follows it there; none of it moves.
TEST_F(MotionScenario, WhatStandsKeepsItsAxesAndItsFollowers) {
    const std::string iss =
        "objects:\n  - {name: iss, mesh: iss.obj, motion: {kind: tle, tle: {file: iss.tle, valid_days: 3}, "
        "outside: hold, attitude: {law: nadir, second: velocity, second_axis: [1, 0, 0]}}}\n";
    World world(
        scenario("camera_motion: {kind: cw, of: iss, position_m: [-200, 0, 0], attitude: {law: held, "
                 "frame: lvlh, of: iss}}\n" +
                 iss));
    const double end_s =
        static_cast<double>(read_element_sets(kIss, "iss.tle").at(0).epoch - world.start) * 1e-9 + 3 * 86400;
    const WorldSnapshot before = world.at(end_s - 1e-4), after = world.at(end_s + 1e-4),
                        later = world.at(end_s + 1000);
    // In 0.2 ms it flies 1.5 m and turns by 2e-7 rad.
    const auto turned = [](const Pose& a, const Pose& b) {
        return length(turn_between(a.world_from_body, b.world_from_body));
    };
    EXPECT_LT(turned(before.objects[0], after.objects[0]), 1e-6);
    EXPECT_LT(turned(before.camera, after.camera), 1e-6);
    EXPECT_LT(length(before.camera.position_world_m - after.camera.position_world_m), 2);
    EXPECT_LT(turned(after.objects[0], later.objects[0]), 1e-12);
    EXPECT_LT(turned(after.camera, later.camera), 1e-12);
    EXPECT_EQ(after.camera.position_world_m, later.camera.position_world_m);
    EXPECT_EQ(length(after.camera_velocity_m_s), 0);
    EXPECT_EQ(length(after.camera_rate_rad_s), 0);
}

// Velocity and rate are those of the poses, whatever moves the camera and turns it: by central differences
// over 20 ms, whose remainder is (w h)^2 / 6 of a rate, with keyframes' cubics and slerps none. Positions of
// 7e6 m are rounded to 1e-9 m.
TEST_F(MotionScenario, RatesAreThoseOfThePosesForEverySource) {
    const std::string places[] = {
        "kind: fixed, position_m: [1.0e7, 0, 0], velocity_m_s: [0.3, 1, 0.2]",
        "kind: fixed, frame: body_fixed, position_m: [4.0e6, 3.0e6, 4.0e6], velocity_m_s: [0, 50, 3]",
        "kind: keyframes, keyframes: [{at_s: -100, position_m: [7.0e6, 0, 0]}, {at_s: 50, position_m: "
        "[7.0e6, "
        "900, 0]}, "
        "{at_s: 100, position_m: [7.0e6, 900, 700], attitude_wxyz: [0, 1, 0, 0]}]",
        "kind: kepler, kepler: {semi_major_axis_km: 7000, eccentricity: 0.1, inclination_deg: 50, "
        "true_anomaly_deg: 40}",
        "kind: tle, tle: {file: iss.tle}",
        "kind: fixed, frame: lvlh, of: iss, position_m: [-100, 20, 30], velocity_m_s: [0.1, 0.2, 0.3]",
        "kind: fixed, frame: object, of: iss, position_m: [-100, 20, 30]",
        "kind: cw, of: iss, position_m: [-100, 20, 30], velocity_m_s: [0.1, 0.2, 0.3]"};
    const std::string turns[] = {
        "law: held, rate_deg_s: [1, 2, 3]",
        "law: held, frame: lvlh, rate_deg_s: [1, 2, 3]",
        "law: held, frame: body_fixed",
        "law: held, frame: object, of: iss",
        "law: nadir, second: velocity",
        "law: velocity, second: nadir",
        "law: velocity, second: sun",
        "law: nadir, second: orbit_normal",
        "law: sun",
        "law: object, of: iss",
        "law: held, rate_deg_s: [1, 2, 3], jitter: {rms_arcsec: [10, 20, 30], min_hz: 0.01, max_hz: 0.1}"};
    for (const std::string& place : places)
        for (const std::string& turn : turns) {
            // The plane of what is no orbit turns: lvlh_axes() takes it to be at rest.
            const bool no_orbit = place.find("kepler") == std::string::npos &&
                                  place.find("tle") == std::string::npos &&
                                  place.find("iss") == std::string::npos;
            if (no_orbit && turn.find("lvlh") != std::string::npos) continue;
            World world(
                scenario("camera_motion: {" + place + ", attitude: {" + turn +
                         "}}\nobjects:\n  - {name: iss, mesh: iss.obj, motion: {kind: tle, tle: {file: "
                         "iss.tle}, attitude: {law: nadir, second: velocity, second_axis: [1, 0, 0]}}}\n"));
            constexpr double t = 20, h = 0.01;
            const WorldSnapshot before = world.at(t - h), now = world.at(t), after = world.at(t + h);
            const Vec3d velocity = (after.camera.position_world_m - before.camera.position_world_m) / (2 * h);
            const Vec3d rate =
                turn_between(before.camera.world_from_body, after.camera.world_from_body) / (2 * h);
            // SGP4's velocity is its positions' derivative but for (1.5 J2)^2 of it, and J2 bends the orbit
            // by a thousandth.
            EXPECT_LT(length(velocity - now.camera_velocity_m_s), 2.7e-6 * 8000) << place << "\n" << turn;
            EXPECT_LT(length(rate - now.camera_rate_rad_s), 5e-6) << place << "\n" << turn;
        }
}

// A place on the ground of longitude 0 has turned by the measured UT1 - UTC: 0.3 s of 2 pi a sidereal
// day, 15.04 arcsec/s.
TEST_F(MotionScenario, EachScenarioHasAnEarthOfItsOwn) {
    const std::string place =
        "origin: {kind: earth_fixed, longitude_deg: 0, latitude_deg: 0, height_km: 0}\n";
    World plain(scenario(place));
    World measured(scenario(place + "earth_orientation: {ut1_minus_utc_s: 0.3}\n"));
    const auto turn = [](World& a, World& b) {
        const Mat3d from = a.at(0).bodies.earth().fixed_from_world,
                    to = b.at(0).bodies.earth().fixed_from_world;
        return length(to.x - from.x) / kArcsecond_rad;
    };
    EXPECT_NEAR(turn(plain, measured), 0.3 * 15.041, 1e-3);
    World again(scenario(place));
    EXPECT_EQ(turn(plain, again), 0);
}

TEST_F(MotionScenario, LeapSecondsExpire) {
    const std::string table =
        "#@\t3991593600\n2272060800 10\n3692217600 37\n3707856000 38\n";  // one nobody ordered
    write("leaps.list", table);
    const std::string line = "leap_seconds: {file: leaps.list";
    struct Restore {
        ~Restore() { use_leap_seconds({}); }
    } restore;
    scenario(line + "}\n", "2026-01-01T00:00:00Z");
    EXPECT_EQ(parse_utc("2026-01-01T00:00:00Z").ns, (20454LL * 86400 + 38) * kSecond);
    EXPECT_THAT(error_of([&] { scenario(line + "}\n", "2027-01-01T00:00:00Z"); }),
                HasSubstr("leaps.list: expired at 2026-06-28T00:00:00.000Z, before the scenario's time_utc"));
    EXPECT_THAT(scenario(line + ", expired: warn}\n", "2027-01-01T00:00:00Z").warnings,
                testing::ElementsAre(HasSubstr("leaps.list: expired")));
    // The table is that of the scenario that was read last.
    EXPECT_THAT(scenario("").warnings, testing::IsEmpty());
    EXPECT_EQ(parse_utc("2026-01-01T00:00:00Z").ns, (20454LL * 86400 + 37) * kSecond);
}

}  // namespace
}  // namespace hilcam
