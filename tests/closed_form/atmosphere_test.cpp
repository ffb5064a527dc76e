// The precomputed atmosphere against formulas and against light in an atmosphere that is not the program's own (reference_air.h).

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <limits>
#include <utility>

#include "render/sky/air_by_place.h"
#include "render/sky/atmosphere_config.h"
#include "render/sky/atmosphere_models.h"
#include "render/sky/atmosphere_physics.h"
#include "render/sky/standard_air.h"
#include "render/vocabulary/units.h"
#include "tests/support/reference_air.h"

namespace hilcam {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kGround_m = kEarthEquatorialRadius_m;
const SpectralGrid kGrid({0.449, 0.451, 0.649,
                          0.651});  // two narrow bins about 0.45 and 0.65 um, one wide between

AtmosphereConfig clear_air() {
    AtmosphereConfig config;
    config.model = "precomputed";
    return config;
}

// Straight down through pure Rayleigh air: exp(-tau). tau at 0.55 um: 0.0973 by Hansen & Travis (Space Sci.
// Rev. 16, 1974, eq. 2.30), 0.008569 l^-4 (1 + 0.0113 l^-2 + 0.00013 l^-4), a fit of its own to the same
// physics.
TEST(Atmosphere, RayleighOpticalDepthIsThatOfTheTextbooks) {
    for (const double um : {0.40, 0.55, 0.80}) {
        const double l2 = 1 / (um * um);
        const double hansen = 0.008569 * l2 * l2 * (1 + 0.0113 * l2 + 0.00013 * l2 * l2);
        EXPECT_NEAR(rayleigh_optical_depth(um) / hansen, 1, 0.01) << um;
        AtmosphereConfig config = clear_air();
        config.aerosol_optical_depth = 0, config.ozone_du = 0;
        const SpectralGrid grid({um - 0.001, um + 0.001});
        const auto air = make_precomputed_atmosphere({config, grid});
        const auto sight = air->look({kGround_m + 200e3, 0, 0}, {-1, 0, 0}, 200e3, {1, 0, 0});
        EXPECT_NEAR(-std::log(sight.transmittance[0]) / rayleigh_optical_depth(um), 1, 0.005) << um;
        EXPECT_NEAR(air->sun_transmittance({kGround_m, 0, 0}, {1, 0, 0})[0], sight.transmittance[0], 2e-3);
    }
}

// Density over that at sea level as the standard's table I prints it [kg/m^3 over 1.2250], four digits; above 86 km its steps are as wide as
// the program's.
TEST(Atmosphere, AirIsAsDenseAsTheStandardPrintsIt) {
    for (const auto& [km, kg_m3] : {std::pair{0.0, 1.2250},
                                    {5.0, 7.3643e-1},
                                    {11.0, 3.6480e-1},
                                    {15.0, 1.9476e-1},
                                    {20.0, 8.8910e-2},
                                    {25.0, 4.0084e-2},
                                    {30.0, 1.8410e-2},
                                    {35.0, 8.4634e-3},
                                    {40.0, 3.9957e-3},
                                    {47.0, 1.4968e-3},
                                    {50.0, 1.0269e-3},
                                    {60.0, 3.0968e-4},
                                    {70.0, 8.2829e-5},
                                    {80.0, 1.8458e-5},
                                    {86.0, 6.958e-6},
                                    {90.0, 3.416e-6},
                                    {100.0, 5.604e-7}})
        EXPECT_NEAR(standard_air_density(km * 1e3) * 1.2250 / kg_m3, 1, 5e-4) << km << " km";
    AtmosphereConfig config = clear_air();
    config.aerosol_optical_depth = 0, config.ozone_du = 0;
    const AirPhysics air(config, kGrid);
    for (const double km : {20.0, 33.3, 47.5, 60.0})
        EXPECT_NEAR(air.at(km * 1e3).rayleigh[0] / air.at(0).rayleigh[0] / standard_air_density(km * 1e3), 1,
                    2e-4)
            << km << " km";
}

// The ozone of the standard's mid-latitude model [m^-3], and its column scaled to what is asked for.
TEST(Atmosphere, OzoneLiesWhereTheStandardHasIt) {
    EXPECT_NEAR(standard_ozone_m3(10e3), 1.13e18, 1e15);
    EXPECT_NEAR(standard_ozone_m3(22e3), 4.86e18, 1e15);
    EXPECT_NEAR(standard_ozone_m3(50e3), 6.64e16, 1e13);
    EXPECT_EQ(standard_ozone_m3(90e3), 0);
    AtmosphereConfig config = clear_air();
    config.aerosol_optical_depth = 0, config.ozone_du = 300, config.pressure_pa = 0;
    const SpectralGrid chappuis({0.5999, 0.6001});
    const AirPhysics air(config, chappuis);
    double depth = 0;
    for (double h = 50; h < AirPhysics::kTop_m; h += 100) depth += 100.0 * air.at(h).extinction[0];
    // 5.02e-25 m^2 at 0.6 um (Serdyuchenko et al. 2014, 233 K).
    EXPECT_NEAR(depth, 5.02e-25 * 300 * 2.687e20, 2e-4);
}

TEST(Atmosphere, NothingIsMetAboveItOrBesideIt) {
    const AtmosphereConfig config = clear_air();
    const auto air = make_precomputed_atmosphere({config, kGrid});
    const Vec3d above{kGround_m + 500e3, 0, 0};
    for (const Vec3d dir : {Vec3d{1, 0, 0}, Vec3d{0, 1, 0}}) {
        const auto sight = air->look(above, dir, kInfinity, {0, 0, 1});
        EXPECT_EQ(sight.transmittance[0], 1);
        EXPECT_EQ(sight.radiance_sr[0], 0);
    }
    EXPECT_EQ(air->sun_transmittance(above, {0, 1, 0})[0], 1);
    // The Sun below the horizon lights nothing directly.
    EXPECT_EQ(air->sun_transmittance({kGround_m, 0, 0}, normalized(Vec3d{-0.02, 1, 0}))[0], 0);
}

double intersect_distance(Vec3d o, Vec3d d) {
    const double b = dot(o, d), q = b * b - dot(o, o) + kGround_m * kGround_m;
    return q < 0 ? -1 : -b - std::sqrt(q);
}

// Haze of the default description at 0.45 and 0.65 um, with ozone's cross sections there (Serdyuchenko et al. 2014, 233 K).
ReferenceAir hazy_air(const AtmosphereConfig& c, double um) {
    const ReferenceAir::Haze haze{c.aerosol_optical_depth * std::pow(um / 0.55, -c.angstrom_exponent),
                                  c.aerosol_scale_height_m, c.aerosol_asymmetry, c.aerosol_single_albedo};
    return {um, haze, c.ozone_du, um < 0.55 ? 2.3e-26 : 2.24e-25};
}

// What a camera in space sees: the ground through the air, and the limb, in blue and red, with the Sun high
// and low.
TEST(Atmosphere, AgreesWithMonteCarlo) {
    const AtmosphereConfig config = clear_air();
    const auto air = make_precomputed_atmosphere({config, kGrid});
    const Vec3d camera{kGround_m + 500e3, 0, 0};
    for (const int bin : {0, 2})
        for (const double sun_zenith_deg : {30.0, 70.0}) {
            const double z = sun_zenith_deg * kDegree_rad;
            const Vec3d sun{std::cos(z), 0.3 * std::sin(z), std::sqrt(1 - 0.09) * std::sin(z)};
            ReferenceLight reference(hazy_air(config, kGrid.center_um(bin)), config.ground_albedo);
            // Down at 10 and 50 degrees, and limbs 10 and 30 km over the ground.
            for (const double tangent_km : {-1.0, -2.0, 10.0, 30.0}) {
                double nadir = tangent_km == -1 ? 10 * kDegree_rad : 50 * kDegree_rad;
                if (tangent_km > 0) nadir = std::asin((kGround_m + tangent_km * 1e3) / camera.x);
                const Vec3d dir{-std::cos(nadir), std::sin(nadir), 0};
                const double ground = intersect_distance(camera, dir);
                const auto sight = air->look(camera, dir, ground > 0 ? ground : kInfinity, sun);
                double seen = sight.radiance_sr[bin];
                if (ground > 0) {
                    const Vec3d p = camera + ground * dir;
                    const double mu = std::max(0.0, dot(normalized(p), sun));
                    seen += config.ground_albedo / kPi * sight.transmittance[bin] *
                            (mu * air->sun_transmittance(p, sun)[bin] + air->sky_irradiance(p, sun)[bin]);
                }
                const double truth = reference.radiance(camera, dir, sun, 80000);
                // The Monte Carlo scatters by 1 to 2 %; light of high orders is not from all sides alike, 3
                // %.
                EXPECT_NEAR(seen / truth, 1, 0.05) << "bin " << bin << ", Sun " << sun_zenith_deg
                                                   << " deg, tangent " << tangent_km << " km: " << seen;
            }
        }
}

// A limb of nothing but molecules over black ground and over ground of albedo 0.3, scattered by 90 degrees, from 20 to 60 km: the light
// scattered once by a plain sum, the rest by chance, both in the reference air. The table goes into docs/atmosphere.md.
TEST(Atmosphere, TheLimbIsAsBrightAsTheStandardAtmosphereMakesIt) {
    const SpectralGrid grid({0.549, 0.551, 0.799, 0.801});
    for (const double albedo : {0.0, 0.3})
        for (const int bin : {0, 2}) {
            AtmosphereConfig config = clear_air();
            config.aerosol_optical_depth = 0, config.ozone_du = 0;
            config.ground_albedo = albedo;
            const auto air = make_precomputed_atmosphere({config, grid});
            ReferenceLight reference(ReferenceAir(grid.center_um(bin), {}, 0, 0), albedo);
            for (const double sun_zenith_deg : {30.0, 70.0})
                for (const double tangent_km : {20.0, 25.0, 30.0, 35.0, 40.0, 50.0, 60.0}) {
                    const double z = sun_zenith_deg * kDegree_rad;
                    const Vec3d sun{std::cos(z), 0, std::sin(z)}, ahead{0, 1, 0};
                    const Vec3d camera{kGround_m + tangent_km * 1e3, -3e6, 0};
                    const double seen = air->look(camera, ahead, kInfinity, sun).radiance_sr[bin];
                    const double once = reference.once(camera, ahead, sun),
                                 more = reference.more_than_once(camera, ahead, sun, 6000);
                    std::cout << "albedo " << albedo << ", " << grid.center_um(bin) << " um, Sun "
                              << sun_zenith_deg << " deg, " << tangent_km << " km: " << seen
                              << " sr^-1, over light scattered once " << seen / once << ", over all "
                              << seen / (once + more) << "\n";
                    EXPECT_NEAR(seen / (once + more), 1, 0.05)
                        << "albedo " << albedo << ", bin " << bin << ", Sun " << sun_zenith_deg << " deg, "
                        << tangent_km << " km";
                }
        }
}

// Ground that differs from place to place: each look is that of an atmosphere over the albedo below it alone.
TEST(Atmosphere, LightFromTheGroundIsThatOfThePlace) {
    AirGround ground{2, 2, {}};
    for (const float albedo : {0.1f, 0.7f, 0.1f, 0.7f}) ground.albedo.emplace_back().bin.fill(albedo);
    AtmosphereConfig config = clear_air();
    const auto mixed = make_precomputed_atmosphere({config, kGrid});
    auto* by_place = dynamic_cast<AirByPlace*>(mixed.get());
    ASSERT_NE(by_place, nullptr);
    EXPECT_FALSE(by_place->lifts_by_place());
    by_place->put_over(ground);
    EXPECT_TRUE(by_place->lifts_by_place());
    // 90 degrees west and east are the middles of the two halves.
    for (const auto& [albedo, west] : {std::pair{0.1, -1.0}, std::pair{0.7, 1.0}}) {
        config.ground_albedo = albedo;
        const auto even = make_precomputed_atmosphere({config, kGrid});
        const Vec3d up{0, west, 0}, sun = normalized(Vec3d{0.5, west, 0.3});
        const Vec3d camera = (kGround_m + 30e3) * up - Vec3d{0, 0, 3e6};
        for (const int bin : {0, 2}) {
            const auto limb = mixed->look(camera, {0, 0, 1}, kInfinity, sun),
                       same = even->look(camera, {0, 0, 1}, kInfinity, sun);
            EXPECT_NEAR(limb.radiance_sr[bin] / same.radiance_sr[bin], 1, 1e-4);
            EXPECT_EQ(limb.transmittance[bin], same.transmittance[bin]);
            EXPECT_NEAR(mixed->sky_irradiance(kGround_m * up, sun)[bin] /
                            even->sky_irradiance(kGround_m * up, sun)[bin],
                        1, 1e-4);
        }
    }
}

}  // namespace
}  // namespace hilcam
