// The air as a table against the air itself.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <random>

#include "render/earth/air_columns.h"
#include "render/sky/air_by_place.h"
#include "render/sky/atmosphere_config.h"
#include "render/sky/atmosphere_models.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

// Air over albedo 0.25 everywhere, and over other albedos in the west and the east.
std::unique_ptr<Atmosphere> made_air(const SpectralGrid& grid, bool by_place) {
    AtmosphereConfig config;
    config.model = "precomputed";
    auto air = make_precomputed_atmosphere({config, grid});
    if (by_place) {
        AirGround ground{2, 1, {}};
        for (const float albedo : {0.1f, 0.7f}) ground.albedo.emplace_back().bin.fill(albedo);
        dynamic_cast<AirByPlace&>(*air).put_over(ground);
    }
    return air;
}

// Above 8 degrees of height of viewer and Sun both: means within 0.5 %, the worst of 2000 within 4 %: light bends between the table's steps.
void expect_looks_of_the_air(bool by_place) {
    const SpectralGrid grid({0.40, 0.49, 0.58, 0.70});
    const auto air = made_air(grid, by_place);
    const AirColumns columns(*air, 8000);
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> cosine(0.14, 1), turn(0, kPi);
    double worst = 0, sum = 0;
    constexpr int kLooks = 2000;
    for (int i = 0; i < kLooks; ++i) {
        const double mu = cosine(random), mu0 = cosine(random), phi = turn(random);
        const bool high = i % 2;
        const Vec3d point{0, 0, kEarthEquatorialRadius_m + (high ? 8000 : 1)};
        const Vec3d viewer{std::sqrt(1 - mu * mu), 0, mu},
            sun{std::sqrt(1 - mu0 * mu0) * std::cos(phi), std::sqrt(1 - mu0 * mu0) * std::sin(phi), mu0};
        const auto exact = air->look(point + 3e6 * viewer, -viewer, 3e6, sun);
        const auto looks = columns.look(static_cast<float>(mu), static_cast<float>(mu0),
                                        static_cast<float>(dot(viewer, sun)), columns.lift(point));
        const Atmosphere::Sight& table = high ? looks.high : looks.low;
        for (int b = 0; b < 3; ++b) {
            EXPECT_NEAR(table.transmittance[b] / exact.transmittance[b], 1, 0.01) << mu;
            const double off = std::abs(static_cast<double>(table.radiance_sr[b] / exact.radiance_sr[b]) - 1);
            worst = std::max(worst, off), sum += off;
        }
    }
    EXPECT_LT(sum / (3 * kLooks), 0.005);
    EXPECT_LT(worst, 0.04);
}
TEST(AirColumns, LooksAreThoseOfTheAir) { expect_looks_of_the_air(false); }
TEST(AirColumns, LooksAreThoseOfTheAirOverGroundThatDiffersByPlace) { expect_looks_of_the_air(true); }

// Past the ground, lowest points from 2 to 60 km, the Sun down to 3 degrees below: means within 1 %; nine in ten within 3 %.
void expect_looks_past_the_ground_of_the_air(bool by_place) {
    const SpectralGrid grid({0.40, 0.49, 0.58, 0.70});
    const auto air = made_air(grid, by_place);
    const AirColumns columns(*air, 8000);
    std::mt19937_64 random(8);
    std::uniform_real_distribution<double> height(2e3, 60e3), elevation(-3 * kDegree_rad, 0.5 * kPi),
        turn(0, kPi);
    double sum = 0;
    int off_much = 0;
    constexpr int kLooks = 1500;
    for (int i = 0; i < kLooks; ++i) {
        const double h = height(random), e = elevation(random), phi = turn(random);
        const Vec3d lowest{0, 0, kEarthEquatorialRadius_m + h}, ahead{1, 0, 0};
        const Vec3d sun{std::cos(e) * std::cos(phi), std::cos(e) * std::sin(phi), std::sin(e)};
        const auto exact =
            air->look(lowest - 3e6 * ahead, ahead, std::numeric_limits<double>::infinity(), sun);
        const auto table = columns.look_past(static_cast<float>(h), static_cast<float>(sun.z),
                                             static_cast<float>(sun.x), columns.lift(lowest));
        for (int b = 0; b < 3; ++b) {
            EXPECT_NEAR(table.transmittance[b], exact.transmittance[b], 0.01) << h;
            const double off = std::abs(static_cast<double>(table.radiance_sr[b] / exact.radiance_sr[b]) - 1);
            sum += off, off_much += off > 0.03;
        }
    }
    EXPECT_LT(sum / (3 * kLooks), 0.01);
    EXPECT_LT(off_much, 3 * kLooks / 10);
}
TEST(AirColumns, LooksPastTheGroundAreThoseOfTheAir) { expect_looks_past_the_ground_of_the_air(false); }
TEST(AirColumns, LooksPastTheGroundAreThoseOfTheAirOverGroundThatDiffersByPlace) {
    expect_looks_past_the_ground_of_the_air(true);
}

}  // namespace
}  // namespace hilcam
