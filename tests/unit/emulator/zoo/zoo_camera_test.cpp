#include "emulator/zoo/zoo_camera.h"

#include <gtest/gtest.h>

#include "emulator/tradeoff/tradeoff_knobs.h"
#include "emulator/zoo/surface_blocks.h"
#include "emulator/zoo/zoo_reference.h"

namespace hilcam {
namespace {

ScenarioConfig small_scene(std::vector<std::string> more = {}) {
    const ScenarioSource source{
        std::filesystem::path(HILCAM_SOURCE_DIR) / "tests/protocol/minimal_scenario.yaml",
        {"camera.width_px=48", "camera.height_px=40", "camera.focal_length_mm=0.7",
         "objects.0.generate.triangles=5000"}};
    return source.load(more);
}

TEST(ZooShots, ATargetThatStandsStillIsTurnedAndTheLightHasItsPhase) {
    const ScenarioConfig scenario = small_scene();
    ZooCamera camera(scenario);
    const std::vector<ZooShot> shots = zoo_shots(scenario, camera.camera(), false);
    ASSERT_EQ(shots.size(), 6u);
    for (const ZooShot& shot : shots) {
        ASSERT_TRUE(shot.stand) << shot.name;
        camera.take(shot);
        const WorldSnapshot& world = camera.camera().world();
        EXPECT_EQ(world.camera.position_world_m, shot.stand->camera.position_world_m);
        const Mat3d turned = to_matrix(world.objects[0].world_from_body),
                    wanted = to_matrix(shot.stand->world_from_target);
        EXPECT_NEAR(dot(turned.x, wanted.x) + dot(turned.y, wanted.y) + dot(turned.z, wanted.z), 3, 1e-9);
    }
    EXPECT_DOUBLE_EQ(scenario_of_shot(scenario, shots[0]).camera.exposure_s, scenario.camera.exposure_s);
    EXPECT_GT(scenario_of_shot(scenario, shots[1]).camera.exposure_s, 5 * scenario.camera.exposure_s);
}

TEST(ZooShots, WhatToSetShowsTheSameView) {
    const ScenarioConfig scenario = small_scene();
    ZooCamera camera(scenario);
    const ZooShot shot = zoo_shots(scenario, camera.camera(), false)[1];
    camera.take(shot);
    const ScenarioConfig set = small_scene(overrides_of_shot(scenario, shot));
    EXPECT_NEAR(set.camera.exposure_s, camera.shown().camera.exposure_s, 1e-15);
    const StillCamera again(set);
    const WorldSnapshot &a = again.world(), &b = camera.camera().world();
    EXPECT_NEAR(length(a.camera.position_world_m - b.camera.position_world_m), 0, 1e-9);
    for (const Vec3d axis : {Vec3d{1, 0, 0}, Vec3d{0, 1, 0}}) {
        EXPECT_NEAR(
            length(to_matrix(a.camera.world_from_body) * axis - to_matrix(b.camera.world_from_body) * axis),
            0, 1e-9);
        EXPECT_NEAR(length(to_matrix(a.objects[0].world_from_body) * axis -
                           to_matrix(b.objects[0].world_from_body) * axis),
                    0, 1e-9);
    }
}

TEST(ZooShots, WhatHasLampsKeepsItsPosesAndIsFlownAround) {
    const ScenarioConfig scenario =
        small_scene({"lamps=[{name: flood, position_m: [0.1, 0, 0], intensity_w_sr: 100, spectrum: [[0.4, "
                     "1], [0.95, 1]]}]"});
    ZooCamera camera(scenario);
    const std::vector<ZooShot> shots = zoo_shots(scenario, camera.camera(), false);
    ASSERT_EQ(shots.size(), 2u);
    const Vec3d target_m = camera.camera().world().objects[0].position_world_m;
    const double away_m = length(camera.camera().world().camera.position_world_m - target_m);
    for (const ZooShot& shot : shots) {
        EXPECT_FALSE(shot.stand);
        camera.take(shot);
        EXPECT_NEAR(length(camera.camera().world().camera.position_world_m - target_m), away_m, 1e-6);
    }
}

TEST(ZooShots, TheSurfaceIsWhereThePictureIsBright) {
    const ScenarioConfig scenario = small_scene();
    ZooCamera camera(scenario);
    camera.take(zoo_shots(scenario, camera.camera(), false)[0]);
    camera.camera().render({1, 1});
    const ElectronImage& electrons = camera.camera().expose();
    const auto surface = seen_surface(camera.camera());
    ASSERT_TRUE(surface);
    ASSERT_EQ(surface->smooth.size(), electrons.pixels());
    double smooth_e = 0, dark_e = 0;
    std::size_t smooth = 0, dark = 0;
    for (std::size_t i = 0; i < electrons.pixels(); ++i) {
        const auto e = static_cast<double>(electrons.data()[i]);
        if (surface->smooth[i] != 0) smooth_e += e, ++smooth;
        if (surface->near_object[i] == 0) dark_e += e, ++dark;
    }
    ASSERT_GT(smooth, 20u);
    ASSERT_GT(dark, 20u);
    EXPECT_GT(smooth_e / static_cast<double>(smooth), 20 * dark_e / static_cast<double>(dark));
}

// A lens that is shifted by a column of the radiance image sends its rays where those of the column before went. With direct
// light nothing is left to chance, so both pictures are the same but for rounding.
TEST(ZooReferenceRender, APictureThatIsMovedIsThatOfAShiftedLens) {
    const std::vector<std::string> quality = {"quality.visibility=rays", "quality.path_model=direct",
                                              "quality.oversampling=4",  "quality.samples_per_axis=1",
                                              "quality.guard_px=8",      "camera_pose.position_m=[14, 10, 4]",
                                              "quality.lod_error_px=0"};
    const ScenarioConfig scenario = small_scene(quality);
    ASSERT_EQ(pan_px_of(scenario), 0.25);
    ScenarioConfig shifted = scenario;
    shifted.camera.principal_point_px = {24.25, 20};
    StillCamera here(scenario), there(shifted);
    here.render({1, 1}), there.render({1, 1});
    const ElectronImage still = clone(here.expose());
    const ElectronImage& moved = here.expose_moved(1);
    const ElectronImage& expected = there.expose();
    double change_e = 0, off_e = 0, light_e = 0;
    for (std::size_t i = 0; i < still.pixels(); ++i) {
        const auto expected_e = static_cast<double>(expected.data()[i]);
        light_e += expected_e;
        change_e += std::abs(expected_e - static_cast<double>(still.data()[i]));
        off_e += std::abs(expected_e - static_cast<double>(moved.data()[i]));
    }
    EXPECT_GT(change_e, 0.01 * light_e);
    EXPECT_LT(off_e, 0.02 * change_e);
}

}  // namespace
}  // namespace hilcam
