#include "emulator/check/check_command.h"

#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numeric>

#include "emulator/run/still_camera.h"
#include "render/vocabulary/units.h"
#include "tests/support/plate.h"
#include "tests/support/stage.h"

namespace hilcam {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

class CheckScenario : public PlateTest {
  protected:
    CheckReport check(const std::vector<std::string>& overrides = {}, const std::string& rest = "",
                      std::size_t camera = 0) {
        std::vector<std::string> all = {"spectrum_edges_um=[0.4, 0.6, 0.95]"};
        all.insert(all.end(), overrides.begin(), overrides.end());
        return check_scenario(load_scenario(scenario("", rest), all), camera);
    }
    std::vector<std::string> warnings(const std::vector<std::string>& overrides,
                                      const std::string& rest = "") {
        return check(overrides, rest).warnings;
    }
    // A sphere of one metre radius, of reflectance 0.4, that the camera looks at.
    ScenarioConfig ball(const std::string& place) {
        write_sphere();
        return load_scenario(
            write("ball.yaml",
                  "time_utc: 2026-12-21T00:00:00Z\n"
                  "camera: {name: test, width_px: 64, height_px: 64, pitch_um: 10, focal_length_mm: 6.4, "
                  "f_number: 8,\n"
                  "  transmission: 0.01, quantum_efficiency: 0.5, full_well_e: 20000, gain_dn_e: 0.2, bits: "
                  "12,\n"
                  "  exposure_ms: 20}\n"
                  "camera_pose: {look_at_m: " +
                      place +
                      ", up: [1, 0, 0]}\nobjects:\n  - {name: ball, mesh: sphere.obj, pose: {position_m: " +
                      place +
                      "}, materials: {surfaces: [{name: \"*\", material: {reflectance: 0.4}}]}}\n"
                      "earth: {visible: false}\nmoon: {visible: false}\n"
                      "spectrum_edges_um: [0.4, 0.46, 0.52, 0.58, 0.64, 0.7, 0.76, 0.83, 0.95]\n"),
            {});
    }
    // All electrons of its picture.
    static double rendered_e(const ScenarioConfig& s) {
        StillCamera camera(s);
        camera.render({1, 1});
        const ElectronImage& electrons = camera.expose();
        return std::accumulate(electrons.all().begin(), electrons.all().end(), 0.0);
    }
    // A sphere of one metre radius as a file.
    void write_sphere() {
        const Mesh mesh = sphere(32, lambert(0.5), SpectralGrid({0.5, 0.7})).mesh;
        std::ofstream out(folder_ / "sphere.obj");
        for (const Vec3f& v : mesh.vertices_m) out << "v " << v.x << ' ' << v.y << ' ' << v.z << '\n';
        for (const auto& t : mesh.triangles)
            out << "f " << t[0] + 1 << ' ' << t[1] + 1 << ' ' << t[2] + 1 << '\n';
    }
};

TEST_F(CheckScenario, AGoodSceneHasNoWarningsAndItsFacts) {
    const CheckReport report = check();
    EXPECT_THAT(report.warnings, IsEmpty());
    ASSERT_EQ(report.reports.size(), 1u);
    const FirstSight& sight = report.reports[0].sight;
    ASSERT_EQ(sight.objects.size(), 1u);
    const SeenObject& plate = sight.objects[0];
    EXPECT_EQ(plate.place, SeenObject::Place::kVisible);
    EXPECT_NEAR(plate.distance_m, 4, 1e-12);
    EXPECT_NEAR(plate.loaded.max_m.x - plate.loaded.min_m.x, 0.1, 1e-7);
    EXPECT_EQ(plate.loaded.triangles, 2u);
    ASSERT_EQ(plate.loaded.surfaces.size(), 1u);
    EXPECT_NEAR(plate.loaded.surfaces[0].area_m2, 0.01, 1e-8);
    EXPECT_NEAR(plate.picture_share, 16.0 * 16 / (64 * 64), 1e-9);
    EXPECT_EQ(plate.visible_fraction, 1);
    // The Sun of the solstice is 23.44 degrees south of the equator; the camera looks at the pole.
    EXPECT_NEAR(sight.sun_off_boresight_rad, (90 + 23.44) * kDegree_rad, 0.001);
    EXPECT_NEAR(plate.phase_rad, (90 - 23.44) * kDegree_rad, 0.001);
    EXPECT_EQ(to_text(report).substr(0, 15), "warnings: none\n");
    EXPECT_THAT(to_text(report), HasSubstr("0.1 x 0.1 x 0 m, 2 triangles"));
    EXPECT_GT(report.memory_mb, 1);
}

TEST_F(CheckScenario, WhatIsNotInThePictureIsSaid) {
    EXPECT_THAT(warnings({"objects.0.pose.position_m=[4, 0, 4]"}),
                ElementsAre(HasSubstr("object 'plate' is outside the field: 45.00 deg off the boresight"),
                            HasSubstr("nothing that is lit is in the picture")));
    EXPECT_THAT(warnings({"objects.0.pose.position_m=[0, 0, -4]"}),
                Contains(HasSubstr("object 'plate' is behind the camera, 180.0 deg off its boresight")));
}

// From an object's own origin there is no angle between the camera and the Sun.
TEST_F(CheckScenario, AnObjectAtTheCamerasPlaceHasNoPhaseAngle) {
    const CheckReport report = check({"objects.0.pose.position_m=[0, 0, 0]"});
    EXPECT_THAT(to_text(report), HasSubstr("no phase angle, as the camera is at its origin, "));
    EXPECT_THAT(to_text(report), Not(HasSubstr("nan")));
    const nlohmann::json object = nlohmann::json::parse(to_json(report))["cameras"][0]["objects"][0];
    EXPECT_TRUE(object["phase_deg"].is_null());
    EXPECT_EQ(object["distance_m"], 0);
}

// What was taken for a name that is not there is said once, with the key's place.
TEST_F(CheckScenario, FilesThatWereTakenForOthersAreSaid) {
    write("other.mtl", "newmtl a\n");
    write("named.obj", "mtllib OTHER.mtl\nv -1 -1 0\nv 1 -1 0\nv 0 1 0\nusemtl a\nf 1 3 2\n");
    EXPECT_THAT(
        warnings({"objects.0.mesh=" + (folder_ / "named.obj").string()}),
        Contains(HasSubstr("'named.obj': materials 'OTHER.mtl': no file of that name; taken: 'other.mtl'"))
            .Times(1));
}

TEST_F(CheckScenario, AMeshBesideItsOriginIsSaid) {
    write("beside.obj", "v 99 0 0\nv 101 0 0\nv 99 2 0\nf 1 3 2\n");
    EXPECT_THAT(warnings({"objects.0.mesh=" + (folder_ / "beside.obj").string()}),
                Contains(HasSubstr("that is its origin, and the middle of its mesh is 100 m from there")));
}

TEST_F(CheckScenario, ActionsForThingsThatAreNotThereAreSaid) {
    EXPECT_THAT(
        warnings({"events=[{at_s: 1, do: lamp on}, {at_s: 1, do: joint --object 9 --joint 1 "
                  "--angle-deg 3}, {at_s: 1, do: joint --object 1 --joint 2 --angle-deg 3}]"}),
        ElementsAre(HasSubstr("events.0.do: will be refused: it is for lamp 1, and there are 0"),
                    HasSubstr("events.1.do: will be refused: it is for object 9, and there are 1"),
                    HasSubstr("events.2.do: will be refused: it is for joint 2 of 'plate', which has 0")));
    EXPECT_THAT(warnings({"events=[{at_s: 1, do: lamp on}]",
                          "lamps=[{name: flash, intensity_w_sr_um: 1, lit: false}]"}),
                IsEmpty());
}

TEST_F(CheckScenario, WhatIsHiddenIsSaid) {
    EXPECT_THAT(warnings({"objects=[{name: near, mesh: " + (folder_ / "plate.obj").string() +
                          ", pose: {position_m: [0, 0, 2]}}, {name: far, mesh: " +
                          (folder_ / "plate.obj").string() + ", pose: {position_m: [0, 0, 4]}}]"}),
                ElementsAre(HasSubstr("object 'far' is hidden: something is in front of it")));
}

TEST_F(CheckScenario, AModelInMillimetresIsSaid) {
    write_sphere();
    EXPECT_THAT(
        warnings({"objects.0.mesh=" + (folder_ / "sphere.obj").string(), "objects.0.scale=1000"}),
        Contains(HasSubstr(
            "the camera is inside the mesh of object 'plate', which is 2000 x 2000 x 2000 m; the file is "
            "probably in millimetres: scale: 0.001")));
    EXPECT_THAT(
        warnings({"objects.0.mesh=" + (folder_ / "sphere.obj").string(), "objects.0.scale=10"}),
        Contains(HasSubstr("the camera is inside the mesh of object 'plate', which is 20 x 20 x 20 m")));
    // An asteroid from where all of it is seen.
    EXPECT_THAT(warnings({"objects.0.mesh=" + (folder_ / "sphere.obj").string(), "objects.0.scale=1000",
                          "objects.0.pose.position_m=[0, 0, 30000]"}),
                IsEmpty());
}

TEST_F(CheckScenario, DarknessAndGlareAreSaid) {
    // The Earth between the Sun and the scene, which stands 7000 km from its centre on the night side.
    const std::vector<std::string> night = {
        "earth.visible=true", "earth.albedo=0.3", "camera_pose.position_m=[0, 6450000, 2786000]",
        "objects.0.pose.position_m=[0, 6450000, 2786004]", "atmosphere.model=none"};
    EXPECT_THAT(warnings(night),
                Contains(HasSubstr("object 'plate' is in eclipse: 0 % of the Sun is visible from it")));
    // Between the camera and the Sun, but for a degree, so that the Sun is not in the picture.
    EXPECT_THAT(
        warnings({"camera_pose={look_at_m: [0, -4, -1.5]}", "objects.0.pose.position_m=[0, -4, -1.5]"}),
        Contains(HasSubstr("object 'plate' shows its night side: phase angle 17")));
    EXPECT_THAT(warnings({"camera.exposure_ms=4000"}),
                Contains(HasSubstr("object 'plate' saturates: about ")));
    EXPECT_THAT(warnings({"camera.exposure_ms=0.001"}),
                Contains(HasSubstr("object 'plate' is lost in the noise")));
}

TEST_F(CheckScenario, KeysWithoutEffectAreSaid) {
    EXPECT_THAT(warnings({"mode=lockstep"}),
                ElementsAre(HasSubstr("mode: lockstep, and nothing can request a frame")));
    EXPECT_THAT(warnings({"mode=lockstep", "commands.udp.port=15999"}), IsEmpty());
    EXPECT_THAT(warnings({"mode=lockstep", "outputs.preview.port=15999"}), IsEmpty());
    EXPECT_THAT(warnings({"mode=lockstep", "events=[{at_s: 1, do: [expose]}]"}), IsEmpty());
    EXPECT_THAT(warnings({"mode=triggered"}),
                ElementsAre(HasSubstr("mode: triggered, and nothing can trigger a frame")));
    EXPECT_THAT(warnings({"mode=triggered", "commands.tcp.port=15999"}), IsEmpty());
    EXPECT_THAT(warnings({"mode=triggered", "events=[{at_s: 1, do: mode free-run}]"}), IsEmpty());
    EXPECT_THAT(warnings({"faults=[{kind: packet_drop}, {kind: packet_drop, from_frame: 9}]"}),
                ElementsAre(HasSubstr("faults: the fault 'packet_drop' (stream packets are not sent) has no "
                                      "effect without outputs.gige")));
    EXPECT_THAT(warnings({"faults=[{kind: image_black}]"}),
                ElementsAre(HasSubstr("has no effect without any of outputs")));
    EXPECT_THAT(
        warnings({"faults=[{kind: image_black}]", "outputs.files.folder=" + (folder_ / "x").string()}),
        IsEmpty());
    EXPECT_THAT(warnings({"events=[{at_s: 1, do: [fault usb_stall]}]"}),
                ElementsAre(HasSubstr("events: the fault 'usb_stall'")));
    EXPECT_THAT(
        warnings(
            {"objects.0.materials={surfaces: [{name: DefaultMateriel, material: {}}, {name: zz, material: "
             "{}}]}"}),
        ElementsAre(
            HasSubstr("object 'plate': no surface matches its material rules for 'DefaultMateriel' (the "
                      "nearest is 'DefaultMaterial'), 'zz'; the mesh's surfaces: 'DefaultMaterial'")));
    EXPECT_THAT(
        warnings({"objects.0.materials={surfaces: [{name: \"*\", material: {}}, {name: DefaultMaterial, "
                  "material: {}}]}"}),
        ElementsAre(HasSubstr("'DefaultMaterial' (an earlier rule matches that surface)")));
    // A thousand satellites of one make have one mistake.
    const std::string mesh = (folder_ / "plate.obj").string();
    const std::string rules = "materials: {surfaces: [{name: zz, material: {}}]}";
    EXPECT_THAT(
        warnings({"objects=[{name: a, mesh: " + mesh + ", pose: {position_m: [0, 0, 4]}, " + rules +
                  "}, {name: b, mesh: " + mesh + ", pose: {position_m: [0.1, 0, 4]}, " + rules + "}]"}),
        ElementsAre(HasSubstr("object 'a' and 1 more: no surface matches its material rules for 'zz'; the "
                              "mesh's surfaces: 'DefaultMaterial'")));
}

TEST_F(CheckScenario, LooksOfAMeshThatAreNotTakenAreSaidOnce) {
    write("lamp.mtl", "newmtl lamp\nKd 0.1 0.1 0.1\nKe 9 9 9\n");
    const std::string mesh =
        write("lamp.obj",
              "mtllib lamp.mtl\nusemtl lamp\nv -0.05 -0.05 0\nv 0.05 -0.05 0\nv 0.05 0.05 0\nv -0.05 0.05 0\n"
              "f 1 3 2\nf 1 4 3\n")
            .string();
    EXPECT_THAT(warnings({"objects=[{name: a, mesh: " + mesh +
                          ", pose: {position_m: [0, 0, 4]}}, {name: b, mesh: " + mesh +
                          ", pose: {position_m: [0.1, 0, 4]}}]"}),
                ElementsAre(HasSubstr("object 'a' and 1 more: emission of 'lamp': not used")));
}

TEST_F(CheckScenario, ACameraInsideABodyIsSaid) {
    EXPECT_THAT(
        warnings({"earth.visible=true"}),
        Contains(HasSubstr("camera 1 begins inside the body 'earth', 0 km from its centre: it sees nothing "
                           "else; the world's origin is that centre unless the scenario says otherwise: set "
                           "it with 'origin', move camera_pose, or set earth.visible: false")));
    // 10 km under the Moon's surface, and 10 km over it.
    const std::vector<std::string> moon = {"moon.visible=true",
                                           "origin={kind: body_fixed, body: moon, height_km: 10}"};
    EXPECT_THAT(warnings(moon), Not(Contains(HasSubstr("inside the body"))));
    EXPECT_THAT(warnings({"moon.visible=true", "origin={kind: body_fixed, body: moon, height_km: -9.9}"}),
                Contains(HasSubstr(
                    "camera 1 begins inside the body 'moon', 1727.5 km from its centre: it sees nothing "
                    "else")));
}

TEST_F(CheckScenario, WhatThisMachineLacksIsSaid) {
    EXPECT_THAT(warnings({"outputs.gige.interface=nowhere0"}),
                ElementsAre(HasSubstr("outputs.gige: interface 'nowhere0' does not exist; accepted: lo")));
    EXPECT_THAT(warnings({"outputs.gige.interface=lo"}), IsEmpty());
    std::filesystem::create_directory(folder_ / "frames");
    write("frames/frame_00000001.png", "");
    const std::string folder = "outputs.files.folder=" + (folder_ / "frames").string();
    EXPECT_THAT(warnings({folder}), ElementsAre(HasSubstr("which holds a file of another run")));
    EXPECT_THAT(warnings({folder, "outputs.files.overwrite=true"}), IsEmpty());
    EXPECT_TRUE(std::filesystem::exists(folder_ / "frames/frame_00000001.png")) << "check removes nothing";
}

// The mean over the lit part of a rendered Lambert sphere's disk is what is expected of it.
TEST_F(CheckScenario, ASphereIsAsBrightAsExpected) {
    for (const char* place : {"[0, 0, 60]", "[0, 40, 44]", "[0, -28, 52]"}) {
        const ScenarioConfig s = ball(place);
        const CheckReport report = check_scenario(s);
        const SeenObject& seen = report.reports.at(0).sight.objects.at(0);
        EXPECT_NEAR(seen.loaded.mean_reflectance(), 0.4, 1e-6);
        const double mean_e = rendered_e(s) / (lit_share(seen.phase_rad) * seen.silhouette_px);
        // Facets of the sphere, wings of the PSF beyond the frame, pixels of the silhouette.
        EXPECT_NEAR(seen.expected.signal_e / mean_e, 1, 0.03)
            << place << " phase " << degrees(seen.phase_rad);
    }
}

// f = w / 4 pi / (cos i + cos e) reflects w / 2 (1 - m ln((1 + m) / m)) of what comes in at cos i = m:
// Lommel-Seeliger's law, whose w is 8 times the reflectance that is given.
TEST_F(CheckScenario, DarkGroundIsNotTakenForBright) {
    ScenarioConfig s = ball("[0, 0, 60]");
    MaterialConfig& ground = s.objects.at(0).materials.surfaces.at(0).material;
    ground.model = kModel<brdf::LommelSeeliger>;
    ground.reflectance = Curve::constant(0.06);
    const double m = std::sqrt(0.5), expected = 8 * 0.06 / 2 * (1 - m * std::log((1 + m) / m));
    EXPECT_NEAR(check_scenario(s).reports.at(0).sight.objects.at(0).loaded.mean_reflectance(), expected,
                1e-3 * expected);
}

// Smaller than a pixel: all its light in one place.
TEST_F(CheckScenario, APointIsAsBrightAsExpected) {
    const ScenarioConfig s = ball("[0, 0, 3000]");
    const CheckReport report = check_scenario(s);
    const SeenObject& seen = report.reports.at(0).sight.objects.at(0);
    EXPECT_EQ(seen.place, SeenObject::Place::kVisible);
    // Areas this small are measured to an eighth of a pixel.
    const double true_px = kPi * std::pow(640.0 / 3000, 2);
    EXPECT_NEAR(seen.silhouette_px, true_px, 0.0625);
    const double light_e =
        seen.expected.signal_e / report.reports[0].sheet.peak_share * true_px / seen.silhouette_px;
    EXPECT_NEAR(light_e / rendered_e(s), 1, 0.03);
}

// The Moon from 1000 km above it, straight down: what is expected of the ground is what the picture has
// there.
TEST_F(CheckScenario, TheGroundIsAsFarAndAsBrightAsExpected) {
    const ScenarioConfig s = load_scenario(
        scenario(
            "",
            "origin: {kind: body_fixed, body: moon, longitude_deg: 100, latitude_deg: 10, height_km: 1000}\n"
            "camera_pose: {attitude: nadir}\n"),
        std::vector<std::string>{"spectrum_edges_um=[0.4, 0.46, 0.52, 0.58, 0.64, 0.7, 0.76, 0.83, 0.95]",
                                 "moon.visible=true", "objects=[]"});
    const CheckReport report = check_scenario(s);
    const std::optional<GroundSight>& ground = report.reports.at(0).sight.ground;
    ASSERT_TRUE(ground && ground->expected);
    EXPECT_EQ(ground->body, "moon");
    EXPECT_NEAR(ground->distance_m, 1e6, 1);
    EXPECT_NEAR(ground->pixel_m, 1e6 * 10e-6 / 6.4e-3, 1e-3);
    EXPECT_NEAR(ground->off_vertical_rad, 0, 1e-9);
    EXPECT_GT(ground->sun_elevation_rad, 10 * kDegree_rad);
    StillCamera camera(s);
    camera.render({1, 1});
    const ElectronImage& electrons = camera.expose();
    double middle_e = 0;
    for (int y = 30; y < 34; ++y)
        for (std::size_t x = 30; x < 34; ++x) middle_e += electrons.row(y)[x] / 16;
    EXPECT_NEAR(ground->expected->signal_e / middle_e, 1, 0.03);
    EXPECT_THAT(to_text(report), HasSubstr("ground      the smooth moon, 1000 km ahead: 1562 m a pixel"));
    EXPECT_FALSE(check().reports.at(0).sight.ground);
}

TEST_F(CheckScenario, AFrameThatTakesLongerThanItHasIsTold) {
    CheckReport report;
    report.reports.resize(2);
    report.reports[0].frame_time = FrameTime{30, 15, 2};
    report.reports[0].period_s = 0.04;
    report.reports[1].number = 2;
    report.reports[1].frame_time = FrameTime{30, 15, 2};
    report.reports[1].period_s = 0.05;
    EXPECT_TRUE(report.reports[0].is_late());
    EXPECT_FALSE(report.reports[1].is_late());
    EXPECT_THAT(
        to_text(report),
        HasSubstr(
            "25 frames/s leave 40 ms\n              longer than the frame period: a run lowers the quality"));
    // In lockstep frames are asked for.
    EXPECT_EQ(check({}, "mode: lockstep\n").reports.at(0).period_s, 0);
    EXPECT_NEAR(check({"camera.exposure_ms=250"}).reports.at(0).period_s, 0.25, 1e-12);
}

TEST_F(CheckScenario, AFrameIsTimedUnlessItWouldTakeMinutes) {
    const CheckReport small = check();
    ASSERT_TRUE(small.reports.at(0).frame_time);
    EXPECT_GT(small.reports[0].frame_time->render_ms, 0);
    EXPECT_GT(small.reports[0].frame_time->sensor_ms, 0);
    EXPECT_THAT(to_text(small), HasSubstr("ms in the sensor on"));
    const CheckReport fine =
        check({"camera.width_px=2000", "camera.height_px=1000", "quality.samples_per_axis=5"});
    EXPECT_FALSE(fine.reports.at(0).frame_time);
    EXPECT_THAT(to_text(fine), HasSubstr("is not timed"));
}

TEST_F(CheckScenario, EveryCameraHasABlockWithItsBaseline) {
    const std::string right =
        "more_cameras:\n  - {position_m: [0.3, 0, 0.4], attitude: [0.9961947, 0, 0.0871557, 0], camera: "
        "{name: right, "
        "width_px: 32, height_px: 32,\n     pitch_um: 10, focal_length_mm: 6.4, f_number: 8, transmission: "
        "0.01,\n"
        "     quantum_efficiency: 0.5, full_well_e: 20000, gain_dn_e: 0.2, bits: 12, exposure_ms: 20}}\n";
    const CheckReport report = check({}, right);
    ASSERT_EQ(report.reports.size(), 2u);
    EXPECT_NEAR(length(report.reports[1].sight.from_first_m), 0.5, 1e-9);
    EXPECT_NEAR(report.reports[1].sight.turned_rad, 10 * kDegree_rad, 1e-5);
    EXPECT_THAT(report.warnings, Contains(HasSubstr("camera 2: object 'plate' is outside the field")));
    EXPECT_THAT(to_text(report), HasSubstr("camera 2 of 2\n"));
    EXPECT_THAT(
        to_text(report),
        HasSubstr("baseline    0.5 m from camera 1: (0.3, 0, 0.4) m in its axes, turned by 10.0000 deg"));
    EXPECT_THAT(to_text(report), Not(HasSubstr("camera sheet: as camera 1's")));

    const CheckReport pair =
        check({},
              "more_cameras: [{camera: {name: test, width_px: 64, height_px: 64, pitch_um: "
              "10, focal_length_mm: 6.4, f_number: 8,\n"
              "  transmission: 0.01, quantum_efficiency: 0.5, full_well_e: 20000, gain_dn_e: "
              "0.2, bits: 12, offset_dn: 50, read_noise_e: 5, exposure_ms: 20}}]\n");
    EXPECT_THAT(to_text(pair), HasSubstr("camera sheet: as camera 1's\n"));
    EXPECT_THAT(to_text(pair), HasSubstr("turned by 0.0000 deg"));

    const CheckReport second = check({}, right, 2);
    ASSERT_EQ(second.reports.size(), 1u);
    EXPECT_EQ(second.reports[0].number, 2u);
    EXPECT_EQ(second.reports[0].sheet.camera.name, "right");
    EXPECT_NEAR(length(second.reports[0].sight.from_first_m), 0.5, 1e-9);
}

TEST_F(CheckScenario, OfManyObjectsTheFirstAreTold) {
    std::string objects = "objects=[";
    for (int i = 0; i < 60; ++i)
        objects += "{name: o" + std::to_string(i) + ", mesh: " + (folder_ / "plate.obj").string() +
                   ", pose: {position_m: [9, 0, " + std::to_string(i) + "]}},";
    const CheckReport report = check({objects + "]"});
    EXPECT_THAT(report.warnings,
                Contains(HasSubstr("and 50 more objects have warnings: --json gives the place of each")));
    EXPECT_EQ(report.warnings.size(), 12u);
    EXPECT_THAT(to_text(report), HasSubstr("  and 10 more objects: --json has them\n"));
}

TEST_F(CheckScenario, JsonHasTheSameFacts) {
    const CheckReport report = check({"objects.0.pose.position_m=[4, 0, 4]"});
    const nlohmann::json json = nlohmann::json::parse(to_json(report));
    EXPECT_EQ(json["warnings"].get<std::vector<std::string>>(), report.warnings);
    const nlohmann::json& camera = json["cameras"][0];
    EXPECT_EQ(camera["objects"][0]["place"].get<std::string>(), "outside");
    EXPECT_NEAR(camera["objects"][0]["off_boresight_deg"].get<double>(), 45, 1e-9);
    EXPECT_NEAR(camera["sheet"]["exposure_ms"].get<double>(), 20, 1e-9);
    EXPECT_EQ(camera["plan"].size(), report.reports[0].plan.size());
}

}  // namespace
}  // namespace hilcam
