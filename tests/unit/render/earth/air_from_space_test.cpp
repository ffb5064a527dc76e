// A plain Earth in air that is looked up, against the same worked out: in the noise of a sensor, and where nothing is looked up.

#include "render/earth/air_from_space.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "render/sky/atmosphere_config.h"
#include "render/sky/atmosphere_models.h"
#include "render/sky/bodies.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

constexpr double kEndless_m = std::numeric_limits<double>::infinity();

struct BothAirs {
    SpectralGrid grid{{0.40, 0.49, 0.58, 0.70}};
    std::unique_ptr<Atmosphere> exact = make(), looked_up = looked_up_from_space(make());

    std::unique_ptr<Atmosphere> make() const {
        AtmosphereConfig config;
        config.model = "precomputed";
        return make_precomputed_atmosphere({config, grid});
    }
};

// Radiance of ground of albedo 0.3, and of the air before it, over the Sun's irradiance.
float seen_sr(const Atmosphere& air, Vec3d origin_m, Vec3d dir, Vec3d sun_dir, int bin) {
    const double along = dot(origin_m, dir);
    const double inside =
        along * along - dot(origin_m, origin_m) + kEarthEquatorialRadius_m * kEarthEquatorialRadius_m;
    const double to_ground_m = inside >= 0 ? -along - std::sqrt(inside) : kEndless_m;
    const Atmosphere::Sight sight = air.look(origin_m, dir, to_ground_m, sun_dir);
    if (inside < 0) return sight.radiance_sr[bin];
    const Vec3d ground = origin_m + to_ground_m * dir;
    const auto mu0 = static_cast<float>(std::max(0.0, dot(ground, sun_dir) / length(ground)));
    const Spectrum light = mu0 * air.sun_transmittance(ground, sun_dir) + air.sky_irradiance(ground, sun_dir);
    return sight.radiance_sr[bin] + 0.3f / static_cast<float>(kPi) * light[bin] * sight.transmittance[bin];
}

// From 420 km, from the nadir to the limb and past it, all around, the Sun from the zenith to behind the terminator. Noise is that
// of inspector_1k at half of its full well for the brightest of all, 1.2 % there, less by the root below.
TEST(AirFromSpace, IsWellWithinTheNoiseOfASensor) {
    const BothAirs airs;
    const Vec3d origin{0, 0, kEarthEquatorialRadius_m + 420e3};
    constexpr float kBrightest_sr = 0.12f;
    for (const double height_deg : {80.0, 45.0, 15.0, 3.0, -3.0}) {
        const double h = height_deg * kDegree_rad;
        const Vec3d sun{std::cos(h), 0, std::sin(h)};
        double squares = 0;
        int count = 0;
        for (double nadir_deg = 0; nadir_deg < 73; nadir_deg += 0.7)
            for (double azimuth_deg = 2; azimuth_deg < 180; azimuth_deg += 8, ++count) {
                const double n = nadir_deg * kDegree_rad, a = azimuth_deg * kDegree_rad;
                const Vec3d dir{std::sin(n) * std::cos(a), std::sin(n) * std::sin(a), -std::cos(n)};
                for (int b = 0; b < airs.grid.size(); ++b) {
                    const float exact = seen_sr(*airs.exact, origin, dir, sun, b);
                    const float noise =
                        0.012f * std::sqrt(std::max(exact, 1e-3f * kBrightest_sr) * kBrightest_sr);
                    const double off =
                        std::abs(seen_sr(*airs.looked_up, origin, dir, sun, b) - exact) / noise;
                    squares += off * off / airs.grid.size();
                }
            }
        EXPECT_LT(std::sqrt(squares / count), 0.3) << height_deg;
    }
}

TEST(AirFromSpace, RaysThatBeginOrEndInTheAirAreItsOwn) {
    const BothAirs airs;
    const Vec3d sun = normalized(Vec3d{1, 0.5, 1});
    const auto expect_same = [&](Vec3d origin_m, Vec3d dir, double distance_m) {
        const auto exact = airs.exact->look(origin_m, dir, distance_m, sun),
                   own = airs.looked_up->look(origin_m, dir, distance_m, sun);
        EXPECT_EQ(own.radiance_sr.bin, exact.radiance_sr.bin);
        EXPECT_EQ(own.transmittance.bin, exact.transmittance.bin);
    };
    const Vec3d low{0, 0, kEarthEquatorialRadius_m + 1000}, high{0, 0, kEarthEquatorialRadius_m + 420e3};
    expect_same(low, normalized(Vec3d{1, 0, 0.2}), kEndless_m);
    expect_same(low, {0, 0, -1}, 1000);
    expect_same(high, {0, 0, -1}, 380e3);
    expect_same(high, {0, 0, 1}, kEndless_m);
    expect_same(high, {1, 0, 0}, kEndless_m);
    EXPECT_EQ(airs.looked_up->sky_irradiance(low, sun).bin, airs.exact->sky_irradiance(low, sun).bin);
    EXPECT_EQ(airs.looked_up->sun_transmittance(low, sun).bin, airs.exact->sun_transmittance(low, sun).bin);
}

}  // namespace
}  // namespace hilcam
