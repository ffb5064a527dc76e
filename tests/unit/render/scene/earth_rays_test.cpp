#include <gtest/gtest.h>

#include <random>

#include "render/earth/earth_rays.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

// The vector form says what the scalar one says, from low orbit to the Moon, limb included.
TEST(EarthRays, AgreeWithTheSingleRay) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform(-1, 1);
    int met = 0, missed = 0;
    for (const double height_m : {300e3, 36e6, 384e6}) {
        const Vec3d camera = (kEarthEquatorialRadius_m + height_m) * normalized(Vec3d{1, 0.5, 0.4});
        const Vec3d sun = normalized(Vec3d{0.3, -1, 0.2});
        const double size =
            1.2 * kEarthEquatorialRadius_m / length(camera) / 16;  // a little more than the disk
        const Vec3d corner = normalized(-camera), right = size * normalized(cross(corner, Vec3d{0, 0, 1}));
        const Vec3d down = cross(corner, right);
        const EarthRays rays(kFigures[index_of(BodyId::kEarth)], camera, sun, corner, right, down);
        for (int block = 0; block < 100; ++block) {
            EarthRays::Floats x, y, cosine;
            for (std::size_t i = 0; i < EarthRays::kCount; ++i)
                x[i] = static_cast<float>(16 * uniform(random)),
                y[i] = static_cast<float>(16 * uniform(random));
            rays.sun_cosines(x, y, cosine);
            for (std::size_t i = 0; i < EarthRays::kCount; ++i) {
                const Vec3d dir =
                    corner + static_cast<double>(x[i]) * right + static_cast<double>(y[i]) * down;
                const double distance = intersect_earth(camera, dir);
                ASSERT_EQ(distance < 0, cosine[i] == EarthRays::kMiss);
                ++(distance < 0 ? missed : met);
                if (distance < 0) continue;
                ASSERT_NEAR(dot(earth_normal(camera + distance * dir), sun), cosine[i], 1e-6);
            }
        }
    }
    EXPECT_GT(met, 1000);
    EXPECT_GT(missed, 500);
}

}  // namespace
}  // namespace hilcam
