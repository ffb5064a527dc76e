#include "render/frame/object_impostor.h"

#include <gtest/gtest.h>

#include "tests/support/stage.h"

namespace hilcam {
namespace {

// A black plate of 2 m, twenty pixels wide, with a white strip along the rows that is an eighteenth of a pixel high: the eight rows of
// samples in a pixel meet it or pass it by.
SceneObject dark_plate_with_strip(const Stage& s) {
    const auto at = [](float y) { return Vec3f{1, y, 0}; };
    constexpr float kHalf_m = 0.0028f;
    const auto rectangle = [&](float low, float high, double albedo) {
        return object_of({{-1, low, 0}, at(low), at(high), {-1, high, 0}}, {{0, 1, 2}, {0, 2, 3}},
                         lambert(albedo), s.grid);
    };
    return joined(joined(rectangle(-1, -kHalf_m, 0), rectangle(-kHalf_m, kHalf_m, 1)),
                  rectangle(kHalf_m, 1, 0));
}

void use_buffer(Stage& s) {
    s.quality.visibility = "buffer", s.quality.buffer_samples = 64;
    s.quality.samples_per_axis = 1, s.quality.max_depth = 1;
}

TEST(ObjectImpostor, HasTheLightOfWhatIsThinnerThanThePixelsSamples) {
    constexpr double kDistance_m = 30;
    Stage s;
    s.camera(64, 64 / 2 * 0.1 / kDistance_m);
    use_buffer(s);
    s.add(dark_plate_with_strip(s), {0, 0, kDistance_m});
    const double truth = static_cast<double>(kSun_w_m2_um) / kPi * (2 * 0.0056) / (kDistance_m * kDistance_m);
    for (const double row : {0.0, 0.02, 0.05, 0.09}) {
        s.world.objects[0].position_world_m.y = 0.1 * row;
        s.render();
        EXPECT_NEAR(s.light().irradiance / truth, 1, 0.05) << row;
        EXPECT_NEAR(s.light().centroid_px.y, 32 + row, 0.02) << row;
    }
}

// It is one of many in the scene: the others are behind the camera, beside its sunlight.
TEST(ObjectImpostor, IsMadeInScenesOfManyObjects) {
    constexpr double kDistance_m = 30;
    Stage s;
    s.camera(64, 64 / 2 * 0.1 / kDistance_m);
    use_buffer(s);
    s.add(dark_plate_with_strip(s), {0, 0, kDistance_m});
    for (int i = 0; i < 20; ++i) s.add(plate(lambert(0.5), s.grid), {10 + 3.0 * i, 0, -kDistance_m});
    const double truth = static_cast<double>(kSun_w_m2_um) / kPi * (2 * 0.0056) / (kDistance_m * kDistance_m);
    for (const double row : {0.0, 0.02, 0.05, 0.09}) {
        s.world.objects[0].position_world_m.y = 0.1 * row;
        s.render();
        EXPECT_NEAR(s.light().irradiance / truth, 1, 0.05) << row;
    }
}

// What it hides is hidden, as where the camera's pixels find its light.
TEST(ObjectImpostor, HidesWhatIsBehind) {
    Stage s;
    s.camera(64, 0.05);
    s.sun({0.3, 0, -1});
    s.earth(0.3);
    s.world.bodies[BodyId::kEarth].world_m = {0, 0, 100e6};
    use_buffer(s);
    s.add(plate(lambert(0.8), s.grid), {0.3, 0.1, 60});
    s.render();
    EXPECT_FALSE(s.points.empty());
    const double apart = s.light().irradiance;
    const float behind = s.radiance.row(33)[35];
    s.quality.rays_across = 0;
    s.render();
    EXPECT_TRUE(s.points.empty());
    EXPECT_NEAR(apart / s.light().irradiance, 1, 2e-3);
    EXPECT_EQ(behind, 0);
    EXPECT_GT(s.radiance.row(33)[35], 0);
}

// It is there once, and as large, at the size at which a mesh is no longer pictured, and at that at which it is no more than points.
TEST(ObjectImpostor, IsAsBrightAtAllSizes) {
    Stage s;
    s.camera(256, 0.1);
    use_buffer(s);
    s.add(plate(lambert(0.5), s.grid), {0, 0, 1});
    const double radius_m = std::sqrt(2.0);
    for (const double size_px : {0.7, 7.9, 8.1, 20.0, 63.0, 65.0}) {
        const double distance_m = 2 * radius_m / size_px * s.geometry.focal_length_px;
        s.world.objects[0].position_world_m.z = distance_m;
        s.render();
        EXPECT_EQ(s.points.empty(), size_px > kPictured_px) << size_px;
        const double truth = 0.5 * static_cast<double>(kSun_w_m2_um) / kPi * 4 / (distance_m * distance_m);
        EXPECT_NEAR(s.light().irradiance / truth, 1, 5e-3) << size_px;
        EXPECT_NEAR(s.light().centroid_px.x, 128, 0.01) << size_px;
    }
}

}  // namespace
}  // namespace hilcam
