// The light of whole planets: as points by the almanac's laws, as disks the same.

#include "render/sky/disk_light.h"

#include <gtest/gtest.h>

#include <cmath>

#include "render/sky/saturn_rings.h"
#include "render/vocabulary/units.h"
#include "tests/support/stage.h"

namespace hilcam {
namespace {

// A direction in a body's axes.
Vec3d direction(double longitude_deg, double latitude_deg) {
    const double lon = longitude_deg * kDegree_rad, lat = latitude_deg * kDegree_rad;
    return {std::cos(lat) * std::cos(lon), std::cos(lat) * std::sin(lon), std::sin(lat)};
}

// A body of which nothing but this camera and Sun is known: the first along +z at a distance, in its usual look.
class TestPlanet {
  public:
    TestPlanet(BodyId id, double distance_m, double view_px, const BodyConfig& config)
        : id_(id), distance_m_(distance_m) {
        stage.grid = SpectralGrid({0.545, 0.555, 0.56});  // the first is where V is
        stage.camera(96, 48 / view_px);
        stage.quality.samples_per_axis = 4;
        stage.scene.body(id).visible = true;
        stage.scene.body(id).look = BodyLook(id, config, stage.grid);
        stage.scene.body(id).rings = config.rings;
        stage.build();
    }
    // Returns V at 1 au from Sun and camera, by the light of the picture and its points.
    double magnitude_v_1au(const DiskView& view) {
        BodyState& body = stage.world.bodies[id_];
        body.world_m = {0, 0, distance_m_};
        // Its axes in the world: the camera stands at `to_viewer`, that is along -z; up to a turn about it.
        const Vec3d z = -1 * view.to_viewer;
        const Vec3d x = normalized(cross(std::abs(z.z) < 0.9 ? Vec3d{0, 0, 1} : Vec3d{1, 0, 0}, z));
        const Vec3d y = cross(z, x);
        const Mat3d world_from_fixed{x, y, z};  // rows: the world's axes in the body's
        body.fixed_from_world = transposed(world_from_fixed);
        const Vec3d sun_dir = world_from_fixed * view.to_sun;
        stage.world.bodies.sun_world_m = body.world_m + kAstronomicalUnit_m * sun_dir;
        stage.render_again();
        const double ratio = stage.light().irradiance / static_cast<double>(kSun_w_m2_um);
        const double au2 = std::pow(distance_m_ / kAstronomicalUnit_m, 2);
        return -2.5 * std::log10(ratio * au2) - 26.76;
    }

    Stage stage;

  private:
    BodyId id_;
    double distance_m_;
};

// Focal lengths in pixels: a disk that is so many pixels across at a distance.
double pixels_for(double size_px, double radius_m, double distance_m) {
    return size_px * distance_m / (2 * radius_m);
}

TEST(DiskLight, AnEllipsoidsIntegralIsThatOfItsPixels) {
    const Figure figure{1, 0.9};
    for (const SurfaceLaw law : {SurfaceLaw::kLambert, SurfaceLaw::kLommelSeeliger})
        for (const DiskView view :
             {DiskView{direction(0, 0), direction(0, 0)}, DiskView{direction(0, 25), direction(40, -10)},
              DiskView{direction(0, 80), direction(100, 30)}}) {
            const Vec3d right = normalized(cross(Vec3d{0, 0, 1}, view.to_viewer)),
                        up = cross(view.to_viewer, right);
            constexpr int kAcross = 1200;
            double sum = 0;
            for (int j = 0; j < kAcross; ++j)
                for (int i = 0; i < kAcross; ++i) {
                    const Vec3d origin = 5 * view.to_viewer + (2 * (i + 0.5) / kAcross - 1) * right +
                                         (2 * (j + 0.5) / kAcross - 1) * up;
                    const double t = intersect_ellipsoid(figure, origin, -1 * view.to_viewer);
                    if (t < 0) continue;
                    const Vec3d p = origin - t * view.to_viewer;
                    const Vec3d n = normalized(Vec3d{p.x, p.y, p.z / 0.81});
                    const double mu0 = dot(n, view.to_sun), mu = dot(n, view.to_viewer);
                    if (mu0 <= 0) continue;
                    sum += law == SurfaceLaw::kLambert ? mu0 / kPi : mu0 / (4 * kPi * (mu0 + mu));
                }
            sum *= 4.0 / (kAcross * kAcross);
            EXPECT_NEAR(lit_disk_m2(figure, law, view) / sum, 1, 3e-3) << view.to_viewer.z;
        }
}

TEST(DiskLight, ASpheresIntegralIsItsLaw) {
    const Figure sphere{2, 2};
    for (const SurfaceLaw law : {SurfaceLaw::kLambert, SurfaceLaw::kLommelSeeliger})
        for (const double phase_deg : {0.0, 30.0, 90.0, 150.0}) {
            const DiskView view{direction(10, 20), direction(10, 20 + phase_deg)};
            EXPECT_NEAR(lit_disk_m2(sphere, law, view) / (4 * sphere_brightness(law, view.phase_rad())), 1,
                        2e-3);
            EXPECT_EQ(shape_factor(sphere, law, view), 1);
        }
}

// Mallama & Hilton 2018, eq. 10, by hand: 15 June 2017 (B 26.5 deg, phase 0.1) and an open ring at 5 deg of phase.
TEST(DiskLight, SaturnsLawIsThatOfThePaper) {
    EXPECT_NEAR(saturn_magnitude_v_1au(0.1 * kDegree_rad, std::sin(26.5 * kDegree_rad)), -9.8604, 1e-3);
    EXPECT_NEAR(saturn_magnitude_v_1au(5 * kDegree_rad, std::sin(20 * kDegree_rad)), -9.4082, 1e-3);
    EXPECT_NEAR(saturn_magnitude_v_1au(0, 0), -8.914, 1e-9);
}

// Point, cells of a small one, and disk; rings drawn or not.
TEST(DiskLight, SaturnHasTheAlmanacsLightAsAPointAndAsADisk) {
    constexpr double kDistance_m = 1e11;
    for (const bool rings : {true, false}) {
        BodyConfig config = default_body(BodyId::kSaturn);
        EXPECT_TRUE(config.rings);
        config.rings = rings;
        for (const double size_px : {0.4, 3.0, 7.0, 30.0}) {
            if (!rings && size_px > 1) continue;  // the globe alone, below
            TestPlanet saturn(
                BodyId::kSaturn, kDistance_m,
                pixels_for(size_px, kFigures[index_of(BodyId::kSaturn)].equatorial_radius_m, kDistance_m),
                config);
            for (const auto& [tilt_deg, sun_tilt_deg, longitude_deg] : {std::array{26.6, 26.6, 0.05},
                                                                        {26.6, 25.5, 3.0},
                                                                        {-21.0, -20.0, 5.9},
                                                                        {3.0, 4.0, 2.0},
                                                                        {-0.5, 1.0, 3.0}}) {
                const DiskView view{direction(0, tilt_deg), direction(longitude_deg, sun_tilt_deg)};
                const double sine = std::sqrt(std::max(0.0, view.to_viewer.z * view.to_sun.z));
                const double law = saturn_magnitude_v_1au(view.phase_rad(), sine);
                EXPECT_NEAR(saturn.magnitude_v_1au(view), law, size_px < 1 ? 0.002 : 0.03)
                    << size_px << " px, tilt " << tilt_deg << (rings ? "" : ", rings not drawn");
            }
        }
    }
}

TEST(DiskLight, PlanetsHaveTheirMagnitudesAsPointsAndAsDisks) {
    for (const BodyId id : {BodyId::kMercury, BodyId::kVenus, BodyId::kMars, BodyId::kJupiter,
                            BodyId::kSaturn, BodyId::kNeptune}) {
        BodyConfig config = default_body(id);
        config.rings = false;
        for (const double size_px : {0.3, 2.0, 40.0}) {
            if (id == BodyId::kSaturn && size_px < 1) continue;  // a point of Saturn has its rings' light
            constexpr double kDistance_m = 1e11;
            TestPlanet planet(id, kDistance_m,
                              pixels_for(size_px, kFigures[index_of(id)].equatorial_radius_m, kDistance_m),
                              config);
            for (const double phase_deg : {0.5, 9.0, 60.0}) {
                const DiskView view{direction(0, 2), direction(phase_deg, 2)};
                EXPECT_NEAR(planet.magnitude_v_1au(view), magnitude_v_1au(id, view.phase_rad()), 0.01)
                    << kBodyNames[index_of(id)] << ' ' << size_px << " px, " << phase_deg;
            }
        }
    }
}

// Mallama & Hilton 2018, eq. 14: -7.110 - 8.4e-4 times the mean planetographic latitude.
TEST(DiskLight, UranusIsBrighterFromItsPoles) {
    for (const double size_px : {0.3, 30.0}) {
        TestPlanet uranus(BodyId::kUranus, 1e11,
                          pixels_for(size_px, kFigures[index_of(BodyId::kUranus)].equatorial_radius_m, 1e11),
                          default_body(BodyId::kUranus));
        for (const double latitude_deg : {0.0, 50.0, -82.0}) {
            const DiskView view{direction(0, latitude_deg), direction(1, latitude_deg)};
            const double flattened = std::pow(24973.0 / 25559, 2);
            const double graphic_deg =
                std::atan(std::tan(std::abs(latitude_deg) * kDegree_rad) / flattened) / kDegree_rad;
            EXPECT_NEAR(uranus.magnitude_v_1au(view), -7.110 - 8.4e-4 * graphic_deg, 0.01) << latitude_deg;
        }
    }
}

// ROLO at 30 deg of phase (tests/moon/rolo_test.py): reflectance at 442, 687 and 873 nm over that at 549 nm.
TEST(DiskLight, TheUsualMoonHasRolosColour) {
    const SpectralGrid grid({0.436, 0.448, 0.540, 0.558, 0.683, 0.691, 0.868, 0.878});
    const BodyLook moon(BodyId::kMoon, default_body(BodyId::kMoon), grid);
    const Spectrum light = moon.disk_albedo(30 * kDegree_rad);
    EXPECT_NEAR(light[0] / light[2], 0.791, 0.01);
    EXPECT_NEAR(light[4] / light[2], 1.262, 0.01);
    EXPECT_NEAR(light[6] / light[2], 1.474, 0.01);
}

}  // namespace
}  // namespace hilcam
