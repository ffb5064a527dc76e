// Places and attitudes as people say them: free space, local axes, pointing, nadir of any body, and what of
// it is refused.

#include <gmock/gmock.h>

#include <numeric>

#include "emulator/check/check_command.h"
#include "emulator/run/still_camera.h"
#include "emulator/scenario/initial_world.h"
#include "render/vocabulary/attitude.h"
#include "render/vocabulary/units.h"
#include "tests/support/files.h"
#include "tests/support/motion.h"
#include "tests/support/near.h"

namespace hilcam {
namespace {

using testing::Contains;
using testing::HasSubstr;

constexpr const char* kFramesSheet =
    "{width_px: 32, height_px: 32, pitch_um: 10, focal_length_mm: 6.4, f_number: 8, "
    "quantum_efficiency: 0.5, transmission: 0.01, full_well_e: 20000, gain_dn_e: 0.2, bits: 12, "
    "exposure_ms: 1}";
// 1.6 m to a side, in the plane of x and y.
constexpr const char* kFramesPlate =
    "v -0.8 -0.8 0\nv 0.8 -0.8 0\nv 0.8 0.8 0\nv -0.8 0.8 0\nf 1 2 3\nf 1 3 4\n";
constexpr const char* kFramesMoonSite =
    "origin: {kind: body_fixed, body: moon, longitude_deg: 23, latitude_deg: 40}\n";

class ScenarioFrames : public FilesTest {
  protected:
    ScenarioConfig scenario(const std::string& lines, const std::string& utc = "2026-03-20T14:00:00Z") {
        write("plate.obj", kFramesPlate);
        return load_scenario(
            write("s.yaml", "time_utc: " + utc + "\nspectrum_edges_um: [0.5, 0.7]\ncamera: " + kFramesSheet +
                                "\n" + lines),
            {});
    }
    std::string refusal(const std::string& lines) {
        return error_of([&] { scenario(lines); });
    }
    // The camera's pose, and the objects', so many seconds after the start.
    static WorldSnapshot at(const ScenarioConfig& s, double t_s = 0) {
        const TimeTai start = parse_utc(s.time_utc);
        return snapshot_at(s, start, start + std::llround(t_s * 1e9));
    }
    static Vec3d boresight(const WorldSnapshot& world) {
        return to_matrix(world.camera.world_from_body) * Vec3d{0, 0, 1};
    }
    static Vec3d picture_up(const WorldSnapshot& world) {
        return to_matrix(world.camera.world_from_body) * Vec3d{0, -1, 0};
    }
    static double rendered_e(const ScenarioConfig& s) {
        StillCamera camera(s);
        camera.render({1, 1});
        const ElectronImage& electrons = camera.expose();
        return std::accumulate(electrons.all().begin(), electrons.all().end(), 0.0);
    }
};

TEST_F(ScenarioFrames, InFreeSpaceTheSunIsWhereItIsSaid) {
    const ScenarioConfig s = scenario(
        "origin: {kind: free}\nsun: {direction: [3, 0, -4], distance_au: 2.5}\nmars: {visible: true}\n");
    const WorldSnapshot world = at(s);
    expect_near(world.bodies.sun_world_m / kAstronomicalUnit_m, {1.5, 0, -2}, 1e-15);
    EXPECT_TRUE(s.bodies[index_of(BodyId::kMars)].visible);
    for (const BodyId id : {BodyId::kEarth, BodyId::kMoon, BodyId::kJupiter})
        EXPECT_FALSE(s.bodies[index_of(id)].visible) << kBodyNames[index_of(id)];
    // The planets are where they are against the Sun, but for light time: 26.5 km/s for 35 minutes at most.
    const Vec3d mars = heliocentric(BodyId::kMars, parse_utc(s.time_utc)).position_m;
    EXPECT_LT(length(world.bodies[BodyId::kMars].world_m - world.bodies.sun_world_m - mars), 5.6e7);
    // It stays there, and time runs.
    expect_near(at(s, 86400).bodies.sun_world_m, world.bodies.sun_world_m, 0);
    EXPECT_GT(length(at(s, 86400).bodies[BodyId::kMars].world_m - world.bodies[BodyId::kMars].world_m), 1e9);
    // Without direction of its own the place of the origin among the stars is the Sun's, turned round.
    EXPECT_LT(length(world.bodies.origin_from_barycenter.velocity_m_s), 20);
}

// A plate that faces the camera, the Sun at the right shoulder: L = rho E cos 60 deg / pi falls with d^2.
TEST_F(ScenarioFrames, InFreeSpaceLightFallsWithTheSquareOfTheDistance) {
    const std::string lines =
        "objects: [{name: plate, mesh: plate.obj, pose: {position_m: [0, 0, 4], attitude_wxyz: [0, 1, 0, "
        "0]}, "
        "materials: {surfaces: [{name: \"*\", material: {reflectance: 0.5}}]}}]\norigin: {kind: free}\n";
    const double near_e = rendered_e(scenario(lines + "sun: {phase_deg: 60, azimuth_deg: 90}\n"));
    const double far_e =
        rendered_e(scenario(lines + "sun: {phase_deg: 60, azimuth_deg: 90, distance_au: 3}\n"));
    EXPECT_GT(near_e, 1e5);
    EXPECT_NEAR(near_e / far_e, 9, 0.001);
    // By its direction it is the same picture: half a turn's sine to the right, half back.
    EXPECT_EQ(rendered_e(scenario(lines + "sun: {direction: [1.7320508075688772, 0, -1]}\n")), near_e);
}

// The phase angle and the side that light comes from are those of what the camera looks at.
TEST_F(ScenarioFrames, TheSunIsPlacedByPhaseAndSide) {
    for (const double azimuth_deg : {0.0, 90.0, 200.0}) {
        const ScenarioConfig s = scenario(
            "origin: {kind: free}\ncamera_pose: {position_m: [5, 7, 1], look_at_m: [1, 2, 3], up: [0, 1, "
            "1]}\n"
            "sun: {phase_deg: 110, azimuth_deg: " +
            std::to_string(azimuth_deg) + "}\n");
        const WorldSnapshot world = at(s);
        const Vec3d sun = normalized(world.bodies.sun_world_m);
        EXPECT_NEAR(std::acos(dot(sun, normalized(Vec3d{5, 7, 1} - Vec3d{1, 2, 3}))), 110 * kDegree_rad,
                    1e-12);
        const Vec3d camera = transposed(to_matrix(world.camera.world_from_body)) * sun;
        EXPECT_NEAR(std::remainder(std::atan2(camera.x, -camera.y) / kDegree_rad - azimuth_deg, 360), 0,
                    1e-9);
    }
}

// ERFA's gd2gc and c2t00b by way of pyerfa 2.0: a place 100 m east, 200 m north and 500 m up of 10 E, 50 N,
// 200 m, and the local axes by differences of neighbouring places.
TEST_F(ScenarioFrames, LocalAxesAreEastNorthUpOfTheEllipsoid) {
    const ScenarioConfig s = scenario(
        "site: {body: earth, longitude_deg: 10, latitude_deg: 50, height_km: 0.2}\nearth: {visible: false}\n"
        "camera_pose: {frame: local, position_m: [100, 200, 500], look_at_m: [100, 200, 0], up: [0, 1, "
        "0]}\n");
    const WorldSnapshot world = at(s);
    expect_near(world.camera.position_world_m, {3259319.188336598, 2517068.2670125114, 4855035.9765669415},
                1e-5);
    expect_near(boresight(world), -Vec3d{0.509995313123521, 0.393823494797468, 0.764727294881559}, 1e-9);
    expect_near(picture_up(world), {-0.603807266394329, -0.469283484982057, 0.644352229586042}, 1e-8);
    // It turns with the Earth: 15.04 arcsec/s, eastwards.
    const WorldSnapshot later = at(s, 10);
    EXPECT_NEAR(length(later.camera.position_world_m - world.camera.position_world_m),
                10 * 7.2921159e-5 * std::hypot(4045731.2748, 713473.1231), 1);
    EXPECT_LT(length(at(s, 0.01).camera.position_world_m - at(s, -0.01).camera.position_world_m -
                     0.02 * world.camera_velocity_m_s),
              1e-6);
    EXPECT_NEAR(length(turn_between(world.camera.world_from_body, later.camera.world_from_body)),
                10 * 7.2921159e-5, 1e-9);
}

// Three lines put a camera 500 m above a site on the Moon, looking down, north up; a target and waypoints
// have the same axes.
TEST_F(ScenarioFrames, ALandingIsSaidInThreeLines) {
    const ScenarioConfig s = scenario(
        std::string(kFramesMoonSite) +
        "camera_pose:\n  frame: local\n  position_m: [0, 0, 500]\n  attitude: nadir\n"
        "objects:\n"
        "  - {name: beacon, mesh: plate.obj, pose: {frame: local, position_m: [0, 30, 0]}}\n"
        "  - name: rover\n    mesh: plate.obj\n    motion:\n      kind: keyframes\n      frame: local\n"
        "      keyframes: [{at_s: 0, position_m: [10, 0, 0], attitude_euler_deg: [90, 0, 0], euler_sequence: "
        "321},"
        " {at_s: 10, position_m: [10, 20, 0]}]\n      attitude: {law: keyframes}\n");
    for (const double t_s : {0.0, 5.0, 100.0}) {
        const WorldSnapshot world = at(s, t_s);
        const Mat3d moon = world.bodies[BodyId::kMoon].fixed_from_world;
        const Vec3d site = body_fixed_position_m(BodyId::kMoon, s.origin.place);
        // In the Moon's own axes nothing moves but the rover.
        const auto on_moon = [&](Vec3d p) { return moon * (p - world.bodies[BodyId::kMoon].world_m); };
        expect_near(on_moon(world.camera.position_world_m), (1 + 500 / length(site)) * site, 1e-6);
        expect_near(moon * boresight(world), -normalized(site), 1e-12);
        const Vec3d beacon = on_moon(world.objects[0].position_world_m) - site;
        EXPECT_NEAR(length(beacon), 30, 1e-6);
        EXPECT_NEAR(beacon.z, 30 * std::cos(40 * kDegree_rad), 1e-6) << "north";
        EXPECT_GT(dot(moon * picture_up(world), beacon), 29.999);
        const Vec3d rover = on_moon(world.objects[1].position_world_m) - site;
        EXPECT_NEAR(length(rover), std::hypot(10, 2 * std::min(t_s, 10.0)), 1e-6);
        // Yaw of 90 deg: its x looks north.
        EXPECT_NEAR(dot(moon * (to_matrix(world.objects[1].world_from_body) * Vec3d{1, 0, 0}), beacon), 30,
                    1e-6);
    }
    // A command's reader has the same motion as the first pose.
    const TimeTai start = parse_utc(s.time_utc);
    expect_near(initial_motions(s, start)[0].pose.position_world_m, at(s).camera.position_world_m, 1e-9);
}

TEST_F(ScenarioFrames, PointingByRightAscensionStaysOnTheStarsAndSlews) {
    const std::string orion = "attitude_radec_deg: [83.8221, -5.3911, 30]";
    const Quat expected = from_radec({83.8221 * kDegree_rad, -5.3911 * kDegree_rad, 30 * kDegree_rad});
    for (const std::string& lines :
         {"origin: {kind: free}\nsun: {direction: [1, 0, 0]}\ncamera_pose: {" + orion + "}\n",
          kFramesMoonSite + ("camera_pose: {frame: local, " + orion + "}\n"),
          kFramesMoonSite + ("camera_motion: {kind: fixed, frame: local, attitude: {" + orion + "}}\n")}) {
        const ScenarioConfig s = scenario(lines);
        for (const double t_s : {0.0, 1000.0})
            EXPECT_LT(length(turn_between(expected, at(s, t_s).camera.world_from_body)), 1e-12) << lines;
    }
    // Half way between two fields of one declination at the equator: the mean.
    const ScenarioConfig slew = scenario(
        "origin: {kind: free}\nsun: {direction: [1, 0, 0]}\n"
        "camera_motion: {kind: keyframes, attitude: {law: keyframes}, keyframes: ["
        "{at_s: 0, attitude_radec_deg: [10, 0, 0]}, {at_s: 60, attitude_radec_deg: [40, 0, 0]}]}\n");
    expect_near(boresight(at(slew, 30)), {std::cos(25 * kDegree_rad), std::sin(25 * kDegree_rad), 0}, 1e-12);
}

TEST_F(ScenarioFrames, NadirIsOfAnyBody) {
    const auto off = [&](const ScenarioConfig& s, BodyId id) {
        const WorldSnapshot world = at(s);
        const Vec3d to_body = world.bodies[id].world_m - world.camera.position_world_m;
        return std::acos(std::min(1.0, dot(boresight(world), normalized(to_body))));
    };
    const std::string geo = "origin: {kind: earth_fixed, height_km: 35786}\n";
    EXPECT_LT(off(scenario(geo + "camera_pose: {attitude: nadir}\n"), BodyId::kEarth), 1e-7);
    EXPECT_LT(off(scenario(geo + "camera_pose: {attitude: nadir, nadir_of: moon}\n"), BodyId::kMoon), 1e-7);
    // From the Moon's ground the Earth; a motion looks where the body is, not where its light shows it: up to
    // 21 arcsec by the observer's way, and as much by the planet's.
    const std::string earthrise = "frame: local, position_m: [0, 0, 2], attitude: nadir, nadir_of: earth";
    EXPECT_LT(off(scenario(kFramesMoonSite + ("camera_pose: {" + earthrise + "}\n")), BodyId::kEarth),
              1.1e-4);
    EXPECT_LT(off(scenario(geo + "camera_motion: {kind: fixed, attitude: {law: nadir, nadir_of: mars}}\n"),
                  BodyId::kMars),
              3e-4);
}

TEST_F(ScenarioFrames, EveryQuaternionMayBeAnotherForm) {
    const Quat expected = from_mrp({0.2, -0.25, 0.3});
    for (const char* form :
         {"attitude_mrp: [0.2, -0.25, 0.3]",
          "attitude_wxyz: [0.6771488469601677, 0.3354297693920336, -0.419287211740042, 0.5031446540880503]",
          "attitude_dcm: [0.1420874, 0.4001248, 0.9053791, -0.9626905, 0.2686647, 0.0323475, -0.2303003, "
          "-0.8761960, 0.4233702]",
          "attitude_euler_deg: [70.449659, -64.874389, 4.369185], euler_sequence: 321"}) {
        SCOPED_TRACE(form);
        const std::string f = form;
        const ScenarioConfig s = scenario(
            "camera_pose: {" + f +
            "}\nearth: {visible: false}\nobjects:\n"
            "  - {name: a, mesh: plate.obj, pose: {" +
            f +
            "}}\n"
            "  - {name: b, mesh: plate.obj, motion: {kind: fixed, attitude: {" +
            f +
            "}}}\n"
            "  - {name: c, mesh: plate.obj, motion: {kind: keyframes, attitude: {law: keyframes}, keyframes: "
            "[{at_s: 0, " +
            f + "}]}}\n");
        const WorldSnapshot world = at(s);
        for (const Quat& found : {world.camera.world_from_body, world.objects[0].world_from_body,
                                  world.objects[1].world_from_body, world.objects[2].world_from_body})
            EXPECT_LT(length(turn_between(expected, found)), 1e-7);
    }
    // A mount's quaternion is called otherwise.
    const ScenarioConfig pair = scenario(
        std::string("more_cameras: [{attitude_mrp: [0.2, -0.25, 0.3], camera: ") + kFramesSheet + "}]\n");
    EXPECT_LT(length(turn_between(expected, scenario_of_camera(pair, 1).mount.thing_from_camera)), 1e-14);
}

TEST_F(ScenarioFrames, WhatHasNoEffectIsRefused) {
    for (const auto& [lines, message] : std::vector<std::pair<std::string, std::string>>{
             {"origin: {longitude_deg: 3}\n",
              "origin.longitude_deg: has no effect with kind: earth_center; accepted: kind: earth_fixed or "
              "body_fixed, or no 'longitude_deg'"},
             {"origin: {kind: body_center, body: moon, height_km: 3}\n", "origin.height_km: has no effect"},
             {"origin: {kind: earth_fixed, body: moon}\n",
              "origin.body: has no effect with kind: earth_fixed"},
             {"origin: {kind: free, latitude_deg: 3}\nsun: {direction: [1, 0, 0]}\n",
              "origin.latitude_deg: has no effect with kind: free"},
             {"sun: {direction: [1, 0, 0]}\n", "sun.direction: has no effect"},
             {"sun: {distance_au: 2}\n", "sun.distance_au: has no effect"},
             {"origin: {kind: free}\n", "sun: has no position of the Sun"},
             {"origin: {kind: free}\nsun: {direction: [0, 0, 0]}\n", "sun.direction: found a vector without"},
             {"origin: {kind: free}\nsun: {direction: [1, 0, 0], phase_deg: 3}\n",
              "sun.phase_deg: found besides"},
             {"origin: {kind: free}\nsun: {direction: [1, 0, 0], azimuth_deg: 3}\n",
              "sun.azimuth_deg: has no effect without 'phase_deg'"},
             {"origin: {kind: free}\nsun: {phase_deg: 3}\ncamera_motion: {kind: fixed}\n",
              "sun.phase_deg: needs a camera_pose"},
             {"origin: {kind: free}\nsun: {direction: [1, 0, 0]}\ncamera_pose: {attitude: nadir}\n",
              "camera_pose.attitude: is nadir in free space"},
             {std::string(kFramesMoonSite) +
                  "camera_pose: {frame: local, attitude: nadir, nadir_of: earth, rate_deg_s: [0, 0, 1]}\n",
              "camera_pose.rate_deg_s: has no effect when nadir points to another body than the site's"},
             {"camera_pose: {nadir_of: moon}\n", "camera_pose.nadir_of: has no effect"},
             {"camera_motion: {kind: fixed, attitude: {nadir_of: moon}}\n",
              "attitude.nadir_of: has no effect"},
             {"camera_motion: {kind: fixed, attitude: {law: sun, attitude_mrp: [0, 0, 1]}}\n",
              "attitude.attitude_mrp: has no effect with this law"}})
        EXPECT_THAT(refusal(lines), HasSubstr(message)) << lines;
}

TEST_F(ScenarioFrames, LocalAxesNeedASiteOnTheOriginsBody) {
    EXPECT_THAT(
        refusal("camera_pose: {frame: local}\n"),
        HasSubstr("camera_pose.frame: found 'local', and no site for its axes; accepted: with site:"));
    EXPECT_THAT(refusal("objects: [{name: a, mesh: plate.obj, motion: {kind: fixed, frame: local}}]\n"),
                HasSubstr("objects.0.motion.frame: found 'local', and no site"));
    EXPECT_THAT(
        refusal("site: {body: moon, longitude_deg: 1, latitude_deg: 2}\ncamera_pose: {frame: local}\n"),
        HasSubstr("a site on the body 'moon', and an origin at 'earth'; accepted: an origin on the "
                  "site's body, as origin: {kind: body_center, body: moon}"));
    EXPECT_THAT(
        refusal("terrain: {heights: {file: a, columns: 2, rows: 2, spacing_m: 1}, pose: {frame: local}}\n"),
        HasSubstr("pose.frame: found 'local'; accepted: terrain.place"));
}

TEST_F(ScenarioFrames, AnAttitudeIsSaidOnceAndWhole) {
    const auto pose = [&](const std::string& keys) { return refusal("camera_pose: {" + keys + "}\n"); };
    EXPECT_THAT(pose("attitude_wxyz: [1, 0, 0, 0], attitude_mrp: [0, 0, 0]"),
                HasSubstr("camera_pose.attitude_mrp: found besides 'attitude_wxyz'; accepted: one of them"));
    EXPECT_THAT(pose("attitude_mrp: [0, 0, 0], look_at_m: [1, 0, 0]"),
                HasSubstr("camera_pose.attitude_mrp: has no effect with look_at_m and up"));
    EXPECT_THAT(pose("attitude_euler_deg: [1, 2, 3]"),
                HasSubstr("attitude_euler_deg: has no 'euler_sequence'"));
    EXPECT_THAT(pose("euler_sequence: 321"), HasSubstr("euler_sequence: has no effect without"));
    EXPECT_THAT(pose("attitude_euler_deg: [1, 2, 3], euler_sequence: 322"),
                HasSubstr("found '322'; accepted: 121 | 123"));
    EXPECT_THAT(pose("attitude_radec_deg: [1, 91, 3]"), HasSubstr("found a declination of 91"));
    EXPECT_THAT(pose("attitude_dcm: [1, 0, 0, 0, 1, 0, 0, 0, 0.9998]"),
                HasSubstr("unit length and right angles by 0.00039996; accepted: 0.0001 or less"));
    EXPECT_THAT(pose("attitude_dcm: [1, 0, 0, 0, 1, 0, 0, 0, -1]"), HasSubstr("found a matrix that mirrors"));
    EXPECT_THAT(pose("attitude_dcm: [1, 0, 0]"), HasSubstr("accepted: a list of 9 numbers"));
    EXPECT_THAT(
        refusal("camera_motion: {kind: fixed, attitude: {frame: lvlh, attitude_radec_deg: [1, 2, 3]}}\n"),
        HasSubstr("attitude_radec_deg: is relative to ICRF; accepted: with frame: world"));
    EXPECT_THAT(
        refusal(kFramesMoonSite +
                std::string("camera_motion: {kind: keyframes, frame: local, keyframes: [{at_s: 0}, "
                            "{at_s: 1, attitude_radec_deg: [1, 2, 3]}], attitude: {law: keyframes}}\n")),
        HasSubstr("keyframes.1.attitude_radec_deg: is relative to ICRF"));
}

TEST_F(ScenarioFrames, ACheckTellsPointingAndSite) {
    const std::string plate = "objects: [{name: plate, mesh: plate.obj, pose: {frame: local}}]\n";
    const CheckReport report = check_scenario(scenario(
        kFramesMoonSite + plate + "camera_pose: {frame: local, position_m: [1, 2, 30], attitude: nadir}\n"));
    EXPECT_THAT(to_text(report), HasSubstr("the camera is 1 m east, 2 m north, 30 m above it (moon)"));
    const CheckReport stars = check_scenario(
        scenario("origin: {kind: free}\nsun: {direction: [1, 0, 0]}\natmosphere: {model: precomputed}\n"
                 "site: {body: moon, longitude_deg: 1, latitude_deg: 2}\n"
                 "camera_pose: {attitude_radec_deg: [83.8221, -5.3911, 30]}\n"));
    const std::string text = to_text(stars);
    EXPECT_THAT(text,
                HasSubstr("right ascension 83.8221 deg, declination -5.3911 deg, roll 30.00 deg (ICRF)"));
    EXPECT_THAT(text, testing::Not(HasSubstr("km away")));
    EXPECT_THAT(text, testing::Not(HasSubstr("site   ")));
    EXPECT_THAT(stars.warnings, Contains(HasSubstr("site: nothing uses its local axes")));
    EXPECT_THAT(stars.warnings, Contains(HasSubstr("atmosphere: has no effect, as the Earth is not shown")));
}

// What the tutorials are about: each sees what it is for, and nothing of it is doubtful.
TEST(ShippedFrames, AreAsTheyAreMeant) {
    // The middle of each picture says it.
    const auto checked = [](const std::string& name, std::vector<std::string> overrides) {
        for (const char* size : {"camera.width_px=120", "camera.height_px=90"}) overrides.push_back(size);
        return check_scenario(
            load_scenario(HILCAM_SOURCE_DIR "/configs/scenarios/" + name + ".yaml", overrides));
    };
    const CheckReport landing = checked("landing", {});
    EXPECT_THAT(landing.warnings, testing::IsEmpty());
    expect_near(landing.reports[0].sight.from_site_m.value(), {-60, -40, 500}, 1e-6);
    const CheckReport asteroid = checked("asteroid", {"stars.faintest_magnitude=3"});
    EXPECT_THAT(asteroid.warnings, testing::IsEmpty());
    EXPECT_EQ(asteroid.reports[0].sight.objects[0].place, SeenObject::Place::kVisible);
    EXPECT_EQ(asteroid.reports[0].sight.objects[0].loaded.triangles, 81920u);
    const CheckReport stars = checked("star_tracker", {"stars.faintest_magnitude=3"});
    EXPECT_THAT(stars.warnings, testing::IsEmpty());
    EXPECT_NEAR(stars.reports[0].sight.pointing.declination_rad, 7.407 * kDegree_rad, 1e-12);
}

}  // namespace
}  // namespace hilcam
