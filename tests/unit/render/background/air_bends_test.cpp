// Tests what a camera in orbit sees through the bending air: the ground's edge, stars, the Sun. The reference
// is Pulkovo's refraction tables (15 deg C, 1013.25 hPa, 0.59 um), twice as large for light that passes the
// air.

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "render/sky/air_refraction.h"
#include "render/sky/standard_air.h"
#include "tests/support/stage.h"

namespace hilcam {
namespace {

// Air that bends light and does nothing else.
class ClearAir final : public Atmosphere {
  public:
    double top_m() const override { return 1e5; }
    Sight look(Vec3d, Vec3d, double, Vec3d) const override { return {all(1), {}}; }
    Spectrum sun_transmittance(Vec3d, Vec3d) const override { return all(1); }
    Spectrum sky_irradiance(Vec3d, Vec3d) const override { return {}; }
    std::string describe() const override { return "clear"; }
    const AirRefraction* refraction() const override { return &refraction_; }

  private:
    AirRefraction refraction_{air_refractivity(0.59), standard_air_density, kEarthEquatorialRadius_m, 1e5};
    static Spectrum all(float value) {
        Spectrum out;
        out.bin.fill(value);
        return out;
    }
};

constexpr double kOneSecond_rad = kPi / (180 * 3600), kHorizon_rad = 1977.97 * kOneSecond_rad;
constexpr double kSolarRadius_rad = 959.63 * kOneSecond_rad;
// The ground ends at n R, with n - 1 = 2.771e-4 by Edlen's formula of 1966.
constexpr double kEdge_m = kEarthEquatorialRadius_m * (1 + 2.771e-4);

// Returns the refraction at an apparent height, by a fit to the tables that is within 0.3".
double pulkovo_rad(double height_rad) {
    const double h = 180 / kPi * height_rad;
    return kPi / 180 / 62.8093 / std::tan(kPi / 180 * (h + 4.2206 / (h + 15.1115 / (h + 5.9431))));
}

// A camera above the equator that looks at the edge of the ground; down is down in the image.
struct Orbit {
    double radius_m, edge_rad;  // edge: from straight down
    Stage stage;

    Orbit(double height_m, int size_px, double half_width)
        : radius_m(kEarthEquatorialRadius_m + height_m), edge_rad(std::asin(kEdge_m / radius_m)) {
        stage.camera(size_px, half_width);
        stage.quality.samples_per_axis = 4;
        stage.earth(0.5);
        BodyState& earth = stage.world.bodies[BodyId::kEarth];
        earth.world_m = radius_m * from_down(0);
        earth.fixed_from_world = {{0, 1, 0}, {0, 0, 1}, {1, 0, 0}};
        stage.sun(from_down(2.8));
    }
    // Returns the direction at an angle from straight down.
    Vec3d from_down(double angle_rad) const {
        return {0, std::sin(edge_rad - angle_rad), std::cos(edge_rad - angle_rad)};
    }
    void render() {
        Scene scene = copy_of(stage.scene);
        scene.air = std::make_unique<ClearAir>();
        stage.renderer = std::make_unique<Renderer>(std::move(scene), stage.grid, stage.geometry,
                                                    stage.quality, stage.models);
        stage.render_again();
    }
    // The last and the first lit row of a column, in radians above the edge of the ground.
    struct Rows {
        double low_rad, high_rad;
    };
    Rows lit(int column) const {
        const RadianceImage& image = stage.radiance;
        int first = image.height(), last = -1;
        for (int y = 0; y < image.height(); ++y)
            if (image.row(y)[static_cast<std::size_t>(column)] > 0) first = std::min(first, y), last = y;
        return {row_rad(last + 1), row_rad(first)};
    }
    double row_rad(double row) const {
        return std::atan((0.5 * stage.radiance.height() - row) / stage.geometry.focal_length_px);
    }
};

// The geometric edge is 1.8 km lower: 0.77 mrad from 400 km.
TEST(AirBends, TheGroundEndsAtTheRadiusTimesTheIndex) {
    Orbit orbit(400e3, 64, 0.004);
    orbit.render();
    const double pixel_rad = 0.008 / 64;
    EXPECT_NEAR(orbit.lit(32).high_rad, 0, 0.6 * pixel_rad);
}

// A star that is twice the horizon's refraction below the ground's edge appears just above it; lower ones are
// hidden.
TEST(AirBends, StarsSetTwiceTheHorizonsRefractionLater) {
    Orbit orbit(400e3, 64, 0.02);
    const auto star_below = [&](double below_rad) {
        Star star;
        star.world_dir = orbit.from_down(orbit.edge_rad - below_rad);
        star.irradiance_w_m2_um.bin.fill(1);
        star.row = static_cast<std::uint32_t>(orbit.stage.scene.stars.size());
        orbit.stage.scene.stars.push_back(star);
    };
    star_below(2 * kHorizon_rad - 12 * kOneSecond_rad);
    star_below(2 * kHorizon_rad + 12 * kOneSecond_rad);
    orbit.stage.world.bodies.origin_from_barycenter = {};
    orbit.render();
    ASSERT_EQ(orbit.stage.points.size(), 1u);
    const double height_rad = orbit.row_rad(static_cast<double>(orbit.stage.points[0].position_px.y));
    EXPECT_NEAR(height_rad / kOneSecond_rad, 0, 4);
    // The light is spread by about 1 + D d(turn) / d(impact): 5.8 where it grazes the ground, from 400 km.
    EXPECT_NEAR(orbit.stage.points[0].irradiance_w_m2_um[0], 1 / 5.8f, 0.01f);
}

// The setting Sun seen from the ground: 32' wide, and as high as the tables say.
TEST(AirBends, TheSettingSunIsFlattenedAsInTheTables) {
    Orbit orbit(1, 257, 0.01);
    orbit.stage.earth(0);
    orbit.edge_rad = 0.5 * kPi;
    BodyState& earth = orbit.stage.world.bodies[BodyId::kEarth];
    earth.world_m = orbit.radius_m * orbit.from_down(0);
    // Its lower edge is 2' above the horizontal.
    const double low_rad = 120 * kOneSecond_rad;
    double high_rad = low_rad;
    for (int i = 0; i < 40; ++i)
        high_rad = low_rad + 2 * kSolarRadius_rad - pulkovo_rad(low_rad) + pulkovo_rad(high_rad);
    orbit.stage.sun(orbit.from_down(0.5 * kPi + low_rad - pulkovo_rad(low_rad) + kSolarRadius_rad));
    orbit.render();
    const Orbit::Rows sun = orbit.lit(128);
    const double pixel_rad = 0.02 / 257;
    EXPECT_NEAR(sun.low_rad, low_rad, pixel_rad);
    EXPECT_NEAR(sun.high_rad, high_rad, pixel_rad);
    EXPECT_NEAR((high_rad - low_rad) / (2 * kSolarRadius_rad), 0.84, 0.02);  // by the tables
}

}  // namespace
}  // namespace hilcam
