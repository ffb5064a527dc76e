#include "render/visibility/screen_mask.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

namespace hilcam {
namespace {

TEST(ScreenMask, MarksEveryPointOfItsBoxesAndLeavesTheSkyBetweenThem) {
    std::mt19937 engine(7);
    std::uniform_real_distribution<double> uniform(-1, 1);
    const ImageGeometry geometry{64, 48, 8, 50, {}};
    ScreenMask mask(geometry);
    // Two boxes at the ends of a long thing.
    const std::array<std::array<Vec3f, 2>, 2> boxes = {
        {{Vec3f{-9, -1, -1}, Vec3f{-7, 1, 1}}, {Vec3f{7, -1, -1}, Vec3f{9, 1, 1}}}};
    for (int trial = 0; trial < 300; ++trial) {
        const auto vec = [&](double size) {
            return Vec3d{size * uniform(engine), size * uniform(engine), size * uniform(engine)};
        };
        const Pose camera{vec(10), from_rotation_vector(vec(3))};
        const Pose object{vec(30), from_rotation_vector(vec(3))};
        mask.clear();
        mask.add(camera, object, boxes);
        for (int i = 0; i < 50; ++i) {
            const Vec3d p{(i % 2 ? 8 : -8) + uniform(engine), uniform(engine), uniform(engine)};
            const Vec3d in_camera =
                transposed(to_matrix(camera.world_from_body)) *
                (object.position_world_m + to_matrix(object.world_from_body) * p - camera.position_world_m);
            if (in_camera.z <= 0) continue;
            const Vec2d px = geometry.project_px(in_camera);
            if (px.x < -8 || px.y < -8 || px.x >= 72 || px.y >= 56) continue;
            const int x = static_cast<int>(std::floor(px.x)) + 8, y = static_cast<int>(std::floor(px.y)) + 8;
            EXPECT_TRUE(mask.at(x, y));
            EXPECT_TRUE(mask.any({x, y, x + 1, y + 1}));
        }
    }
    mask.clear();
    mask.add({{0, 0, 0}, {}}, {{0, 0, 20}, {}}, boxes);
    EXPECT_TRUE(mask.at(8 + 32 - 20, 8 + 24));
    EXPECT_TRUE(mask.at(8 + 32 + 20, 8 + 24));
    EXPECT_FALSE(mask.at(8 + 32, 8 + 24));
    mask.clear();
    mask.add({{0, 0, 0}, {}}, {{0, 0, -20}, {}}, boxes);  // behind the camera
    EXPECT_FALSE(mask.any({0, 0, 80, 64}));
}

}  // namespace
}  // namespace hilcam
