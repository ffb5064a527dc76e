// Pictures of bodies: where on a flattened one their rows are.

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/stage.h"

namespace hilcam {
namespace {

// Mars under a map that is white north of a latitude of 45 deg and black south of it, lit and seen along the equator.
struct MarsAhead {
    Stage s;
    Background background;

    explicit MarsAhead(double latitude_factor)
        : s(stage(latitude_factor)),
          background(s.scene.bodies, nullptr, nullptr, s.scene.sun_irradiance_1au_w_m2_um, true, s.grid) {
        background.place(s.world, {}, 1e-7);
    }
    // The light of a place at a geodetic latitude [deg], longitude 180.
    double light(double latitude_deg) const {
        const Figure& figure = kFigures[index_of(BodyId::kMars)];
        const double a2 = figure.equatorial_radius_m * figure.equatorial_radius_m,
                     b2 = figure.polar_radius_m * figure.polar_radius_m;
        const double c = std::cos(latitude_deg * kDegree_rad), n = std::sin(latitude_deg * kDegree_rad);
        const double scale = 1 / std::sqrt(a2 * c * c + b2 * n * n);
        const Vec3d place{kDistance_m - a2 * scale * c, 0, b2 * scale * n};
        Spectrum weight, light;
        weight.bin.fill(1);
        background.add_bodies({}, normalized(place), weight, light, 1e-7);
        return static_cast<double>(light[0]);
    }

  private:
    static constexpr double kDistance_m = 1e9;
    static Stage stage(double latitude_factor) {
        Stage s;
        BodyConfig config = default_body(BodyId::kMars);
        config.measured_magnitude = false;
        config.albedo = Curve::constant(0.5);
        SceneBody& mars = s.scene.body(BodyId::kMars);
        mars = {true, BodyLook(BodyId::kMars, config, s.grid), {}};
        Texture picture{"step", 720, 360, {}};
        picture.texels.resize(std::size_t{720} * 360);
        for (std::size_t i = 0; i < picture.texels.size(); ++i)
            picture.texels[i].fill(i / 720 < 90 ? std::uint8_t{255} : std::uint8_t{0});
        mars.map = MipTexture(std::move(picture));
        mars.map_reference = 1;
        mars.map_latitude_factor = latitude_factor;
        s.world.bodies[BodyId::kMars].world_m = {kDistance_m, 0, 0};
        s.world.bodies[BodyId::kMars].fixed_from_world = Mat3d{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
        s.sun({-1, 0, 0});
        return s;
    }
};

// tan(planetographic) = tan(planetocentric) (a/b)^2: 45 deg is 45.338 on Mars, and rows are half a degree.
TEST(BodyMap, RowsAreOfTheKindOfLatitudesThatTheyAreSaidToBe) {
    const Figure& figure = kFigures[index_of(BodyId::kMars)];
    const double ratio = figure.polar_radius_m / figure.equatorial_radius_m;
    const double step_deg = std::atan(1 / (ratio * ratio)) / kDegree_rad;
    EXPECT_NEAR(step_deg, 45.338, 0.01);
    const MarsAhead graphic(1), centric(ratio * ratio);
    const double white = graphic.light(46);
    EXPECT_GT(white, 0);
    EXPECT_NEAR(graphic.light(45) / white, 0.5, 0.05);
    EXPECT_NEAR(centric.light(step_deg) / white, 0.5, 0.05);
    EXPECT_LT(centric.light(45) / white, 0.05);
    EXPECT_NEAR(graphic.light(step_deg) / white, 1, 0.05);
}

}  // namespace
}  // namespace hilcam
