// Scenarios by SPICE's kernels: places, attitudes, bodies, origin, camera, and what of it is refused.

#include <gmock/gmock.h>

#include "emulator/run/still_camera.h"
#include "emulator/scenario/initial_world.h"
#include "emulator/scenario/motion_builder.h"
#include "io/spice/text_kernel.h"
#include "render/vocabulary/units.h"
#include "tests/support/files.h"
#include "tests/support/spice_writer.h"
#include "tests/support/transfer_writer.h"

namespace hilcam {
namespace {

using testing::HasSubstr;

constexpr const char* kSpiceStart = "2026-03-20T14:00:00Z";
constexpr const char* kSpiceSheet =
    "{width_px: 64, height_px: 64, pitch_um: 10, focal_length_mm: 6.4, f_number: 8, quantum_efficiency: 0.5, "
    "transmission: 0.01, full_well_e: 20000, gain_dn_e: 0.2, bits: 12, exposure_ms: 1, read_noise_e: 5}";
constexpr double kShipGravity_km3_s2 = 398600.4418, kShipRadius_km = 9000;

// A circle about the Earth over its poles.
StateVector ship_orbit_km(double seconds) {
    const double rate = std::sqrt(kShipGravity_km3_s2 / (kShipRadius_km * kShipRadius_km * kShipRadius_km)),
                 a = rate * seconds;
    return {{kShipRadius_km * std::cos(a), 0, kShipRadius_km * std::sin(a)},
            {-kShipRadius_km * rate * std::sin(a), 0, kShipRadius_km * rate * std::cos(a)}};
}

class SpiceScenario : public FilesTest {
  protected:
    EphemerisTime time_;
    double start_et_s_ = 0;

    void SetUp() override {
        FilesTest::SetUp();
        start_et_s_ = time_.et_s(parse_utc(kSpiceStart));
        write_orbit();
        write_attitude();
        write_planets();
        write(
            "ship.tf",
            "KPL/FK\n\\begindata\nNAIF_BODY_NAME += ( 'SHIP' 'SHIP_CAM' )\nNAIF_BODY_CODE += ( -99 -99100 )\n"
            "FRAME_SHIP_BUS = -99000\nFRAME_-99000_NAME = 'SHIP_BUS'\nFRAME_-99000_CLASS = "
            "3\nFRAME_-99000_CLASS_ID = -99000\n"
            "CK_-99000_SCLK = -99\nSCLK01_MODULI_99 = ( 4000000000 10 )\nSCLK01_COEFFICIENTS_99 = ( 0 0 1 )\n"
            "FRAME_SHIP_CAM = -99100\nFRAME_-99100_NAME = 'SHIP_CAM'\nFRAME_-99100_CLASS = "
            "4\nFRAME_-99100_CLASS_ID = -99100\n"
            "TKFRAME_-99100_RELATIVE = 'SHIP_BUS'\nTKFRAME_-99100_SPEC = 'MATRIX'\nTKFRAME_-99100_MATRIX = ( "
            "1 0 0 0 1 0 0 0 1 )\n"
            "INS-99100_FOV_FRAME = 'SHIP_CAM'\nINS-99100_BORESIGHT = ( 0 0 1 )\nINS-99100_FOCAL_LENGTH = "
            "12.8\n"
            "INS-99100_PIXEL_PITCH = 0.02\nINS-99100_PIXEL_SAMPLES = 48\nINS-99100_PIXEL_LINES = 40\n");
    }
    std::string kernels(const std::string& rest = "") const {
        return "spice:\n  kernels: [{file: ship.bsp}, {file: ship.bc}, {file: planets.bsp}, {file: "
               "ship.tf}]\n" +
               rest;
    }
    ScenarioConfig scenario(const std::string& lines) {
        return load_scenario(write("s.yaml", std::string("time_utc: ") + kSpiceStart +
                                                 "\nseed: 3\nspectrum_edges_um: [0.5, 0.7]\ncamera: " +
                                                 kSpiceSheet + "\n" + lines),
                             {});
    }
    std::string refusal(const std::string& lines) {
        return error_of([&] { at(scenario(lines)); });
    }
    static WorldSnapshot at(const ScenarioConfig& s, double t_s = 0) {
        const TimeTai start = parse_utc(s.time_utc);
        return snapshot_at(s, start, start + std::llround(t_s * 1e9));
    }
    static std::vector<float> electrons_of(const ScenarioConfig& s) {
        StillCamera camera(s);
        camera.render({1, 1});
        const auto all = camera.expose().all();
        return {all.begin(), all.end()};
    }

  private:
    // States each minute, type 13 with windows of four, and the same as a message (Hermite of degree 7).
    void write_orbit() {
        std::vector<double> words, times;
        std::string oem =
            "CCSDS_OEM_VERS = 2.0\nMETA_START\nOBJECT_NAME = SHIP\nOBJECT_ID = -99\nCENTER_NAME = "
            "EARTH\nREF_FRAME = ICRF\n"
            "TIME_SYSTEM = TAI\nSTART_TIME = " +
            tai_text(-600) + "\nSTOP_TIME = " + tai_text(600) +
            "\nINTERPOLATION = HERMITE\nINTERPOLATION_DEGREE = 7\nMETA_STOP\n";
        for (int i = -10; i <= 10; ++i) {
            const StateVector s = ship_orbit_km(60.0 * i);
            words.insert(words.end(), {s.position_m.x, s.position_m.y, s.position_m.z, s.velocity_m_s.x,
                                       s.velocity_m_s.y, s.velocity_m_s.z});
            times.push_back(start_et_s_ + 60.0 * i);
            std::ostringstream line;
            line.precision(17);
            line << tai_text(60 * i);
            for (const Vec3d& v : {s.position_m, s.velocity_m_s})
                line << ' ' << v.x << ' ' << v.y << ' ' << v.z;
            oem += line.str() + "\n";
        }
        words.insert(words.end(), times.begin(), times.end());
        words.insert(words.end(), {3, 21});
        write("ship.bsp", SpiceWriter("SPK", true)
                              .add({"SHIP", times.front(), times.back(), {-99, 399, 1, 13}, words})
                              .bytes());
        write("ship.oem", oem);
    }
    // UTC is 37 s behind TAI in 2026.
    static std::string tai_text(int seconds) {
        std::string text = format_utc(parse_utc(kSpiceStart) + (seconds + 37LL) * kSecond_ns);
        text.pop_back();
        return text;
    }
    // The bus looks along -x of ICRF at the start and turns about z by 0.001 rad/s.
    void write_attitude() {
        std::vector<double> words, times;
        for (int i = -5; i <= 5; ++i) {
            const Quat q = conjugate(bus(10.0 * i));
            words.insert(words.end(), {q.w, q.x, q.y, q.z});
            times.push_back(10 * (start_et_s_ + 10.0 * i));
        }
        const double first = times.front();
        words.insert(words.end(), times.begin(), times.end());
        words.insert(words.end(), {first, 1, 11});
        write("ship.bc",
              SpiceWriter("CK").add({"BUS", times.front(), times.back(), {-99000, 1, 3, 0}, words}).bytes());
    }
    // The Sun moves on from the barycentre, the Earth stands 1.5e8 km before it, Mars 2e8 km; 433 near Mars.
    void write_planets() {
        const double span = 86400, begin = start_et_s_ - span;
        const auto body = [&](int code, int center, Vec3d place_km, Vec3d rate_km_s) {
            const Vec3d mid = place_km, slope = span * rate_km_s;
            return WrittenArray{
                "B",
                begin,
                begin + 2 * span,
                {code, center, 1, 2},
                {begin + span, span, mid.x, slope.x, mid.y, slope.y, mid.z, slope.z, begin, 2 * span, 8, 1}};
        };
        write("planets.bsp", SpiceWriter("SPK")
                                 .add(body(10, 0, {1e6, 0, 0}, {0, 0.01, 0}))
                                 .add(body(399, 0, {-1.5e8, 1e6, 0}, {0, 30, 0}))
                                 .add(body(4, 0, {0, 2e8, 5e6}, {-24, 0, 0}))
                                 .add(body(2000433, 10, {0, 2.1e8, 0}, {-20, 1, 0}))
                                 .bytes());
    }

  protected:
    static Quat bus(double seconds) {
        const Mat3d at_start{{0, 1, 0}, {0, 0, -1}, {-1, 0, 0}};  // rows: the bus's x, y, z in ICRF
        return from_rotation_vector({0, 0, 0.001 * seconds}) * to_quat(transposed(at_start));
    }
};

constexpr const char* kShipByKernels =
    "camera_motion:\n  kind: spice\n  spice: {object: SHIP}\n  attitude: {law: spice, spice: {instrument: "
    "SHIP_CAM}}\n";

TEST_F(SpiceScenario, ThingsStandAndTurnAsTheKernelsSay) {
    const ScenarioConfig s = scenario(kernels() + kShipByKernels);
    for (const double t : {0.0, 12.5, 31.0}) {
        const Pose pose = at(s, t).camera;
        // Hermite's polynomial of degree 7 over three minutes of this orbit.
        EXPECT_NEAR(length(pose.position_world_m - 1e3 * ship_orbit_km(t).position_m), 0, 2e-3) << t;
        const Quat d = conjugate(pose.world_from_body) * bus(t);
        EXPECT_NEAR(std::abs(d.w), 1, 1e-12) << t;
    }
}

TEST_F(SpiceScenario, KernelsInTransferFormatAreTheSame) {
    for (const auto& [binary, text] : std::vector<std::pair<const char*, const char*>>{
             {"ship.bsp", "ship.xsp"}, {"ship.bc", "ship.xc"}, {"planets.bsp", "planets.xsp"}}) {
        const DafFile file(folder_ / binary);
        std::vector<WrittenArray> arrays;
        for (const DafArray& a : file.arrays())
            arrays.push_back({a.name, a.doubles[0], a.doubles[1], a.integers, file.words(a)});
        write(text, transfer_daf(file.kind(), arrays));
    }
    const ScenarioConfig one = scenario(kernels() + kShipByKernels),
                         other = scenario(
                             "spice:\n  kernels: [{file: ship.xsp}, {file: ship.xc}, {file: planets.xsp}, "
                             "{file: ship.tf}]\n" +
                             std::string(kShipByKernels));
    for (const double t : {0.0, 17.0, 31.0}) {
        const WorldSnapshot a = at(one, t), b = at(other, t);
        EXPECT_EQ(length(a.camera.position_world_m - b.camera.position_world_m), 0);
        EXPECT_EQ(a.camera.world_from_body.w, b.camera.world_from_body.w);
        EXPECT_EQ(length(a.bodies.sun_world_m - b.bodies.sun_world_m), 0);
    }
}

// The table of naif0011.tls ends with 2012; IERS Bulletins C 49 and 52 have the two that follow.
TEST_F(SpiceScenario, AnOldLeapSecondKernelIsWarnedOf) {
    const auto kernel = [&](const std::string& more) {
        return write("leap.tls",
                     "KPL/LSK\n\\begindata\nDELTET/DELTA_T_A = 32.184\nDELTET/K = 1.657D-3\n"
                     "DELTET/EB = 1.671D-2\nDELTET/M = ( 6.239996D0 1.99096871D-7 )\n"
                     "DELTET/DELTA_AT = ( 10, @1972-JAN-1, 34, @2009-JAN-1, 35, @2012-JUL-1" +
                         more + " )\n");
    };
    const std::string with_leaps = "spice:\n  kernels: [{file: leap.tls}]\n";
    kernel("");
    const ScenarioConfig old = scenario(with_leaps);
    ASSERT_EQ(old.warnings.size(), 1u);
    EXPECT_THAT(old.warnings[0], HasSubstr("leap.tls:"));
    EXPECT_THAT(old.warnings[0],
                HasSubstr("lacks the leap seconds of 2015-07-01, 2017-01-01, which the program has: later "
                          "times follow the kernel and are up to 2 s off UTC"));
    // 2026-03-20T14:00:00Z is 1774015237 s of TAI by Bulletin C 52, and 2 s less by the kernel, which is used.
    EXPECT_EQ(parse_utc(kSpiceStart).ns, 1'774'015'235'000'000'000);
    // A list of the scenario's own goes before the kernel.
    write("l.list", "#@\t4102444800\n2272060800\t10\n3692217600\t37\n");
    EXPECT_THAT(scenario(with_leaps + "leap_seconds: {file: l.list}\n").warnings, testing::IsEmpty());
    kernel(", 36, @2015-JUL-1, 37, @2017-JAN-1");
    EXPECT_THAT(scenario(with_leaps).warnings, testing::IsEmpty());
    EXPECT_EQ(parse_utc(kSpiceStart).ns, 1'774'015'237'000'000'000);
    kernel(", 36, @2015-JUL-1, 37, @2017-JAN-1, 38, @2030-JAN-1");
    EXPECT_THAT(scenario(with_leaps).warnings, testing::IsEmpty());
    use_leap_seconds({});
}

TEST_F(SpiceScenario, AMessageMadeFromAKernelGivesTheSameFrames) {
    const std::string by_message =
        "camera_motion:\n  kind: oem\n  oem: {file: ship.oem}\n  attitude: {law: spice, spice: {instrument: "
        "SHIP_CAM}}\n";
    const ScenarioConfig one = scenario(kernels() + kShipByKernels), other = scenario(kernels() + by_message);
    // Instants of the message are whole nanoseconds: 8 um of the way.
    EXPECT_NEAR(length(at(one, 17).camera.position_world_m - at(other, 17).camera.position_world_m), 0, 2e-5);
    const std::vector<float> a = electrons_of(one), b = electrons_of(other);
    ASSERT_EQ(a.size(), b.size());
    const float most = *std::max_element(a.begin(), a.end());
    EXPECT_GT(most, 100);
    EXPECT_LT(most, 20000);  // the Earth fills no well
    std::size_t apart = 0;
    for (std::size_t i = 0; i < a.size(); ++i) apart += std::abs(a[i] - b[i]) > 0.5f;
    EXPECT_EQ(apart, 0u);
}

TEST_F(SpiceScenario, BodiesAreSeenWithLightTimeAndAberrationAsNaifDefinesThem) {
    // LT+S of "Aberration Corrections Required Reading": the target at the time its light left, turned towards the
    // observer's velocity by the angle whose sine is |direction x velocity| / c.
    const ScenarioConfig s = scenario(kernels());
    const WorldSnapshot world = at(s);
    KernelBodies& bodies = s.spice->loaded->bodies;
    const double et_s = s.spice->loaded->set.time.et_s(parse_utc(kSpiceStart));
    StateVector observer;
    bodies.require(399, "test"), bodies.require(4, "test"), bodies.require(10, "test");
    ASSERT_TRUE(bodies.state(399, 0, et_s, observer));
    for (const auto& [code, seen] :
         {std::pair{4, world.bodies[BodyId::kMars].world_m}, {10, world.bodies.sun_world_m}}) {
        StateVector target;
        double light_s = 0;
        Vec3d to;
        for (int i = 0; i < 4; ++i) {
            ASSERT_TRUE(bodies.state(code, 0, et_s - light_s, target));
            to = target.position_m - observer.position_m;
            light_s = length(to) / kSpeedOfLight_m_s;
        }
        const Vec3d axis = cross(normalized(to), observer.velocity_m_s / kSpeedOfLight_m_s);
        const Quat turn = from_rotation_vector(std::asin(length(axis)) * normalized(axis));
        const Vec3d apparent = to_matrix(turn) * to;
        // NAIF's aberration is Newton's, the program's Einstein's: (v/c)^2 / 4 or 2.5e-9 rad; light time is one step here.
        EXPECT_NEAR(length(normalized(seen) - normalized(apparent)), 0, 1e-8) << code;
        EXPECT_NEAR(length(seen) / length(apparent), 1, 1e-4) << code;
        // Without them it would be off by 20 arcsec and more.
        EXPECT_GT(length(normalized(seen) - normalized(to)), 5e-5) << code;
    }
    // The program's own series put the Sun elsewhere.
    const WorldSnapshot own = at(scenario(kernels("  bodies: own\n")));
    EXPECT_GT(length(own.bodies.sun_world_m - world.bodies.sun_world_m), 1e9);
}

TEST_F(SpiceScenario, AnOriginAtAThingOfTheKernelsHasTheSunWhereTheyHaveIt) {
    const ScenarioConfig s =
        scenario(kernels() +
                 "origin: {kind: spice, object: EROS}\n"
                 "camera_pose: {position_m: [0, 0, -1e7]}\n"
                 "bodies: [{name: eros, equatorial_radius_km: 17, center: sun, spice: {object: EROS}}]\n");
    const WorldSnapshot world = at(s);
    EXPECT_NEAR(length(world.bodies.sun_world_m), 2.1e11, 1e8);
    EXPECT_NEAR(normalized(world.bodies.sun_world_m).y, -1, 2e-4);
    EXPECT_FALSE(s.origin.center());
}

TEST_F(SpiceScenario, AnInstrumentKernelGivesTheCamera) {
    const ScenarioConfig s = scenario(kernels("  camera: SHIP_CAM\n") + kShipByKernels);
    EXPECT_NEAR(s.camera.focal_length_m, 0.0128, 1e-15);
    EXPECT_NEAR(s.camera.pitch_m, 20e-6, 1e-18);
    EXPECT_EQ(s.camera.width_px, 48);
    EXPECT_EQ(s.camera.height_px, 40);
}

// A kernel may say anything: what is out of the bounds of motion is refused at the start, and stands later.
TEST_F(SpiceScenario, AShipOutOfBoundsIsRefusedAtTheStartAndStandsLater) {
    const auto far = [&](double x_km, double x_km_s) {
        const double span = 86400, begin = start_et_s_ - span;
        return write("far.bsp",
                     SpiceWriter("SPK")
                         .add({"FAR",
                               begin,
                               begin + 2 * span,
                               {-98, 399, 1, 2},
                               {begin + span, span, x_km, span * x_km_s, 0, 0, 0, 0, begin, 2 * span, 8, 1}})
                         .bytes());
    };
    const std::string lines =
        "spice: {kernels: [{file: far.bsp}, {file: planets.bsp}]}\n"
        "camera_motion: {kind: spice, spice: {object: '-98'}, attitude: {law: nadir}}\n";
    for (const double x_km : {1e18, -1e300}) {
        far(x_km, 0);
        EXPECT_THAT(refusal(lines), HasSubstr("motion of 'camera': spice: -98: at 2026-03-20T14:00:00.000Z: "
                                              "found a place "));
        EXPECT_THAT(refusal(lines), HasSubstr(" m from the world's origin; accepted: at most 1.5e+15 m"));
    }
    far(1, 4e5);
    EXPECT_THAT(refusal(lines), HasSubstr("found a velocity 400000000 m/s; accepted: at most 300000000 m/s"));

    far(1.4999e12, 2e5);  // over the bound after 500 s
    const ScenarioConfig s = scenario(lines);
    EXPECT_NEAR(at(s).camera.position_world_m.x, 1.4999e15, 1e9);
    EXPECT_THAT(error_of([&] { at(s, 1000); }),
                HasSubstr("the motion of the camera's body at 2026-03-20T14:16"));
    const TimeTai start = parse_utc(s.time_utc);
    WorldState world(initial_motions(s, start), s.origin, {}, {}, load_motion_sources(s));
    WorldSnapshot snapshot;
    ShownCommand shown;
    for (const std::int64_t t : {400, 1000, 2000}) world.sample(start + t * 1'000'000'000, snapshot, shown);
    EXPECT_NEAR(snapshot.camera.position_world_m.x, 1.4999e15 + 400 * 2e8, 1e9);
    EXPECT_EQ(world.impossible(), 2u);
}

TEST_F(SpiceScenario, PosesAndOrbitsOutOfBoundsAreRefused) {
    EXPECT_THAT(refusal("camera_pose: {position_m: [1.4e15, 1.4e15, 0]}\n"),
                HasSubstr("pose of 'camera': found a place 1.979898987e+15 m from the world's origin"));
    EXPECT_THAT(refusal("camera_motion: {kind: kepler, center: sun, kepler: {semi_major_axis_km: -1, "
                        "eccentricity: 1.5}}\n"),
                HasSubstr("motion of 'camera': "));
    EXPECT_THAT(refusal("bodies: [{name: dart, equatorial_radius_km: 17, center: sun, kepler: "
                        "{semi_major_axis_km: -1, eccentricity: 1.5}}]\n"),
                HasSubstr("body 'dart': about its center at the scenario's start: found a velocity "));
    EXPECT_THAT(refusal("events: [{at_s: 1, do: [pose --position-m 1e16 0 0]}]\n"),
                HasSubstr("exceeds the limits of motion"));
}

TEST_F(SpiceScenario, MistakesAreNamed) {
    EXPECT_THAT(refusal(kShipByKernels), HasSubstr("spice: the scenario has no kernels; accepted: with"));
    EXPECT_THAT(refusal("origin: {kind: spice, object: EROS}\n"),
                HasSubstr("origin.kind: found 'spice', and the scenario has no kernels"));
    EXPECT_THAT(refusal(kernels() + "camera_motion: {kind: spice, spice: {object: NAUTILUS}}\n"),
                HasSubstr("motion of 'camera': spice.object: found 'NAUTILUS'; accepted: a name"));
    EXPECT_THAT(refusal(kernels() + "camera_motion: {kind: spice, spice: {object: SATURN}}\n"),
                HasSubstr("no SPK has the body 699"));
    EXPECT_THAT(refusal(kernels() +
                        "camera_motion: {kind: fixed, attitude: {law: spice, spice: {frame: NOWHERE}}}\n"),
                HasSubstr("attitude.spice.frame: found the frame 'NOWHERE'"));
    EXPECT_THAT(refusal("spice: {kernels: [{file: missing.bsp}]}\n"), HasSubstr("missing.bsp"));
    EXPECT_THAT(refusal(kernels("  camera: SHIP\n")),
                HasSubstr("spice.camera: found 'SHIP', and no kernel has INS-99_"));
    // The kernels end ten minutes after the start; a day later they know nothing.
    const std::string late = error_of([&] {
        std::string text = std::string("time_utc: 2026-03-21T13:00:00Z\ncamera: ") + kSpiceSheet + "\n" +
                           kernels() + kShipByKernels;
        at(load_scenario(write("late.yaml", text), {}));
    });
    EXPECT_THAT(late, HasSubstr("2026-03-20T14:10:00"));
}

}  // namespace
}  // namespace hilcam
