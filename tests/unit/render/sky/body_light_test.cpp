#include <gtest/gtest.h>

#include "render/sky/bodies.h"
#include "render/sky/body_light.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

// Point and disk of a body have the same light, whatever the law: the sum of its radiance over the disk
// against disk_albedo. The Moon at 40 degrees: V = -12.73 + 0.026 x 40 + 4e-9 x 40^4 (Krisciunas & Schaefer
// 1991).
TEST(BodyLight, DiskSumsUpToTheMagnitude) {
    const SpectralGrid grid({0.545, 0.555});
    for (const BodyId id : {BodyId::kMoon, BodyId::kMars, BodyId::kJupiter}) {
        const BodyLook look(id, default_body(id), grid);
        for (const double phase : {0.0, 40 * kDegree_rad}) {
            const Vec3d sun{std::sin(phase), 0, std::cos(phase)};
            double sum = 0;
            constexpr int kGrid = 1000;
            for (int i = 0; i < kGrid; ++i)
                for (int j = 0; j < kGrid; ++j) {
                    const double x = 2 * (i + 0.5) / kGrid - 1, y = 2 * (j + 0.5) / kGrid - 1;
                    if (x * x + y * y >= 1) continue;
                    const Vec3d n{x, y, std::sqrt(1 - x * x - y * y)};
                    sum += static_cast<double>(look.reflectance_sr(static_cast<float>(dot(n, sun)),
                                                                   static_cast<float>(n.z),
                                                                   static_cast<float>(sun.z))[0]) *
                           4 / (kGrid * kGrid);
                }
            EXPECT_NEAR(sum / static_cast<double>(look.disk_albedo(phase)[0]), 1, 2e-3)
                << static_cast<int>(id);
            const double ratio = kFigures[index_of(id)].equatorial_radius_m / kAstronomicalUnit_m;
            EXPECT_NEAR(-2.5 * std::log10(sum * ratio * ratio) - 26.76, magnitude_v_1au(id, phase), 0.005);
        }
    }
    EXPECT_NEAR(magnitude_v_1au(BodyId::kMoon, 0) + 5 * std::log10(384400e3 / kAstronomicalUnit_m), -12.73,
                0.01);
}

}  // namespace
}  // namespace hilcam
