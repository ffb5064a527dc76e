// The precomputed atmosphere against formulas and against a Monte Carlo of the same air.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "render/sky/atmosphere_config.h"
#include "render/sky/atmosphere_models.h"
#include "render/sky/atmosphere_physics.h"
#include "render/vocabulary/units.h"

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

// --- Monte Carlo

double intersect_distance(Vec3d o, Vec3d d) {
    const double b = dot(o, d), q = b * b - dot(o, o) + kGround_m * kGround_m;
    return q < 0 ? -1 : -b - std::sqrt(q);
}

Vec3d any_perpendicular(Vec3d d) {
    return normalized(std::abs(d.x) < 0.7 ? cross(d, Vec3d{1, 0, 0}) : cross(d, Vec3d{0, 1, 0}));
}
Vec3d turned(Vec3d d, double cosine, double phi) {
    const Vec3d a = any_perpendicular(d), b = cross(d, a);
    const double s = std::sqrt(std::max(0.0, 1 - cosine * cosine));
    return normalized(cosine * d + s * std::cos(phi) * a + s * std::sin(phi) * b);
}

// Backward paths with a null-collision free path (Woodcock 1965) and the Sun by next event; one bin.
class MonteCarlo {
  public:
    MonteCarlo(const AtmosphereConfig& config, int bin) : air_(config, kGrid), config_(config), bin_(bin) {
        for (double h = 0; h < AirPhysics::kTop_m; h += 100)
            most_ = std::max<double>(most_, air_.at(h).extinction[bin]);
        most_ *= 1.01;
    }
    double radiance(Vec3d origin, Vec3d dir, Vec3d sun, int paths) {
        double sum = 0;
        for (int i = 0; i < paths; ++i) sum += path(origin, dir, sun);
        return sum / paths;
    }

  private:
    AirPhysics air_;
    AtmosphereConfig config_;
    int bin_;
    double most_ = 0;
    std::mt19937_64 engine_{4};
    std::uniform_real_distribution<double> uniform_{0, 1};

    static double to_sphere(Vec3d o, Vec3d d, double radius, bool nearer) {
        const double b = dot(o, d), c = dot(o, o) - radius * radius, q = b * b - c;
        if (q < 0) return -1;
        return nearer ? -b - std::sqrt(q) : -b + std::sqrt(q);
    }
    double to_sun(Vec3d p, Vec3d sun) const {
        const double ground = to_sphere(p, sun, kGround_m * (1 - 1e-12), true);
        if (ground > 0) return 0;
        const double end = to_sphere(p, sun, kGround_m + AirPhysics::kTop_m, false);
        double depth = 0;
        constexpr int kSteps = 60;
        for (int i = 0; i < kSteps; ++i) {
            // Crowded where the ray is lowest.
            const double a = std::pow(static_cast<double>(i) / kSteps, 3),
                         b = std::pow(static_cast<double>(i + 1) / kSteps, 3);
            depth +=
                end * (b - a) * air_.at(length(p + end * 0.5 * (a + b) * sun) - kGround_m).extinction[bin_];
        }
        return std::exp(-depth);
    }
    double path(Vec3d p, Vec3d d, Vec3d sun) {
        double weight = 1, light = 0;
        const double top = kGround_m + AirPhysics::kTop_m;
        if (length(p) > top) {
            const double entry = to_sphere(p, d, top, true);
            if (entry < 0) return 0;
            p = p + (entry + 1e-3) * d;
        }
        for (int order = 0; order < 60; ++order) {
            const double ground = to_sphere(p, d, kGround_m, true), out = to_sphere(p, d, top, false);
            double at = 0;
            bool scattered = false;
            while (true) {
                at -= std::log(1 - uniform_(engine_)) / most_;
                if (at > (ground > 0 ? ground : out)) break;
                const double here = air_.at(length(p + at * d) - kGround_m).extinction[bin_];
                if (uniform_(engine_) * most_ < here) {
                    scattered = true;
                    break;
                }
            }
            if (scattered) {
                p = p + at * d;
                const AirAt here = air_.at(length(p) - kGround_m);
                const double rayleigh = here.rayleigh[bin_], aerosol = here.aerosol[bin_];
                weight *= (rayleigh + aerosol) / here.extinction[bin_];
                const auto c = static_cast<float>(dot(d, sun));
                const double phase = (rayleigh * air_.rayleigh_phase(c) + aerosol * air_.aerosol_phase(c)) /
                                     (rayleigh + aerosol);
                light += weight * phase * to_sun(p, sun);
                // A uniform direction, weighed by its phase function.
                const double cosine = 2 * uniform_(engine_) - 1;
                const auto cf = static_cast<float>(cosine);
                weight *= 4 * kPi * (rayleigh * air_.rayleigh_phase(cf) + aerosol * air_.aerosol_phase(cf)) /
                          (rayleigh + aerosol);
                d = turned(d, cosine, 2 * kPi * uniform_(engine_));
            } else if (ground > 0) {
                p = p + ground * d;
                const Vec3d n = normalized(p);
                p = (kGround_m + 0.01) * n;
                weight *= config_.ground_albedo;
                const double mu = dot(n, sun);
                if (mu > 0) light += weight * mu / kPi * to_sun(p, sun);
                d = turned(n, std::sqrt(uniform_(engine_)), 2 * kPi * uniform_(engine_));
            } else {
                break;
            }
            if (weight < 0.02) {
                if (uniform_(engine_) > weight / 0.02) break;
                weight = 0.02;
            }
        }
        return light;
    }
};

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
            MonteCarlo reference(config, bin);
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

}  // namespace
}  // namespace hilcam
