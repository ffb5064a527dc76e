#include "render/frame/unresolved_object.h"

#include <gtest/gtest.h>

#include "tests/support/stage.h"

namespace hilcam {
namespace {

// A bar of 2 by 0.2 m, 300 m away. The probe's picture is a square of 2.05 m, by whose rows the bar leans by 17
// degrees: its box there is 1.97 by 0.78 m, 0.36 of the square.
TEST(UnresolvedObject, SendsRaysWhereTheObjectIs) {
    constexpr double kDistance_m = 300, kArea_m2 = 0.4, kAlbedo = 0.5;
    Stage s;
    SceneObject bar = plate(lambert(kAlbedo), s.grid);
    for (Vec3f& v : bar.mesh.vertices_m) v.y *= 0.1f;
    s.add(std::move(bar), {0, 0, kDistance_m});
    s.quality.max_depth = 1;
    s.render();
    const auto square = static_cast<double>(s.quality.point_samples * s.quality.point_samples);
    EXPECT_GT(static_cast<double>(s.stats.primary_rays), 0.36 * square);
    EXPECT_LT(static_cast<double>(s.stats.primary_rays), 0.45 * square);  // whole blocks of 4 x 4
    const double irradiance =
        kAlbedo / kPi * static_cast<double>(kSun_w_m2_um) * kArea_m2 / (kDistance_m * kDistance_m);
    EXPECT_NEAR(s.light().irradiance / irradiance, 1, 0.02);
}

}  // namespace
}  // namespace hilcam
