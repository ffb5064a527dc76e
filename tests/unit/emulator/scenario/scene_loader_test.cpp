#include "emulator/scenario/scene_loader.h"

#include <gmock/gmock.h>

#include <limits>

#include "render/vocabulary/units.h"
#include "tests/support/files.h"

namespace hilcam {
namespace {

struct SceneLoader : FilesTest {
    Scene load(const std::string& objects) {
        write("plate.obj",
              "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nusemtl skin\no body\nf 1 2 3\no wing\nf 1 2 4\n");
        const auto file = write(
            "scenario.yaml",
            "time_utc: 2026-01-01T00:00:00Z\ncamera: {width_px: 8, height_px: 8, pitch_um: 10, "
            "focal_length_mm: 10, f_number: 8,\n"
            "  transmission: 1, quantum_efficiency: 0.5, full_well_e: 20000, gain_dn_e: 0.2, bits: 12,\n"
            "  exposure_ms: 1}\n"
            "earth: {visible: false}\nspectrum_edges_um: [0.5, 0.7]\nobjects:\n" +
                objects);
        const ScenarioConfig scenario = load_scenario(file, {});
        return load_scene(scenario, SpectralGrid(scenario.spectrum_edges_um), {});
    }
};

// Names and poses do not make a mesh; size, looks and what turns do.
TEST_F(SceneLoader, ObjectsOfOneMakeAreLoadedOnce) {
    const std::string mesh = "mesh: plate.obj", wing = ", joints: [{node: wing}]",
                      paint = ", materials: {surfaces: [{name: skin, material: {reflectance: 0.9}}]}";
    const Scene scene = load("  - {name: a, " + mesh + wing + "}\n" +  //
                             "  - {name: b, " + mesh + "}\n" +         //
                             "  - {name: c, " + mesh +
                             ", joints: [{node: wing, angle_deg: 90}], pose: {position_m: [0, 0, 9]}}\n" +
                             "  - {name: d, " + mesh + wing + ", scale: 2}\n" + "  - {name: e, " + mesh +
                             wing + paint + "}\n" + "  - {name: f, " + mesh + wing + paint + "}\n");
    struct Expected {
        const char* name;
        std::optional<std::size_t> like;
    };
    const Expected expected[] = {{"a", {}},      {"b", {}},      {"c", 0},       {"d", {}},
                                 {"e", {}},      {"f", 4},       {"a/wing", {}}, {"c/wing", 6},
                                 {"d/wing", {}}, {"e/wing", {}}, {"f/wing", 9}};
    ASSERT_EQ(scene.objects.size(), std::size(expected));
    for (std::size_t i = 0; i < std::size(expected); ++i) {
        const SceneObject& object = scene.objects[i];
        EXPECT_EQ(object.name, expected[i].name);
        EXPECT_EQ(object.like, expected[i].like) << object.name;
        EXPECT_EQ(object.mesh.triangles.empty(), object.like.has_value()) << object.name;
    }
    EXPECT_EQ(scene.objects[1].mesh.triangles.size(), 2u);  // the wing does not turn
}

// The air over an Earth of one albedo is lit by that albedo; a key of its own counts more.
TEST_F(SceneLoader, TheAirIsLitByTheEarthBelow) {
    const auto limb = [&](const std::string& earth, const std::string& air) {
        const auto file = write(
            "air.yaml",
            "time_utc: 2026-01-01T00:00:00Z\ncamera: {width_px: 8, height_px: 8, pitch_um: 10, "
            "focal_length_mm: 10, f_number: 8,\n"
            "  transmission: 1, quantum_efficiency: 0.5, full_well_e: 20000, gain_dn_e: 0.2, bits: 12,\n"
            "  exposure_ms: 1}\nspectrum_edges_um: [0.5, 0.7]\nearth: {" +
                earth + "}\natmosphere: {model: precomputed" + air + "}\n");
        ScenarioConfig scenario = load_scenario(file, {});
        scenario.is_used_once = true;
        const Scene scene = load_scene(scenario, SpectralGrid(scenario.spectrum_edges_um), {});
        return scene.air
            ->look({kEarthEquatorialRadius_m + 30e3, -3e6, 0}, {0, 1, 0},
                   std::numeric_limits<double>::infinity(), {1, 0, 0})
            .radiance_sr[0];
    };
    const float black = limb("albedo: 0", ""), bright = limb("albedo: 0.7", "");
    // Ground of albedo 1 would add some 1.7 times what black ground has (docs/atmosphere.md).
    EXPECT_GT(bright, 1.8f * black);
    EXPECT_LT(bright, 2.8f * black);
    EXPECT_FLOAT_EQ(limb("albedo: 0.7", ", ground_albedo: 0"), black);
}

TEST_F(SceneLoader, AFrameLargerThanTheMachineIsRefused) {
    ImageGeometry geometry;
    geometry.width_px = geometry.height_px = 5'000'000;
    EXPECT_THAT(
        error_of([&] {
            load_renderer({}, SpectralGrid({0.5, 0.7}), geometry);
        }),
        testing::HasSubstr("a frame of 5000000 x 5000000 pixels (guard_px and oversampling included) in 1 "
                           "spectral bins takes 100000.0 GB; accepted: less than"));
}

}  // namespace
}  // namespace hilcam
