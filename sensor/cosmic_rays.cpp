#include "sensor/cosmic_rays.h"

#include <algorithm>
#include <cmath>

#include "render/vocabulary/units.h"
#include "sensor/noise.h"

namespace hilcam {

Fields fields(CosmicRayConfig& c) {
    return {
        number("rate_cm2_s", c.rate_cm2_s, 1, {0, 1e6}, "rate of particles through the detector"),
        number("depth_um", c.depth_um, 1, {0.1, 1000}, "depth of silicon that collects charge"),
        number("electrons_per_um", c.electrons_per_um, 1, {1, 1e5},
               "electrons released per micrometre of track"),
        number("spread_fraction", c.spread_fraction, 1, {0, 2},
               "standard deviation of electrons_per_um from track to track, over its mean"),
    };
}

namespace {

struct Track {
    double x_px, y_px;    // where it enters
    double dx_px, dy_px;  // from entry to exit
    double electrons;
};

// The flux of an isotropic field through a plane is proportional to cos(theta) sin(theta), so cos^2 is
// uniform.
Track draw_track(const CosmicRayConfig& c, double pitch_m, RandomKey key, std::uint32_t number,
                 const ElectronImage& image) {
    const auto place = random_words(key, RandomPurpose::kCosmicRay, number, 1);
    const auto kind = random_words(key, RandomPurpose::kCosmicRay, number, 2);
    const auto uniform = [](std::uint32_t word) { return static_cast<double>(uniform01(word)); };
    const double cosine = std::sqrt(uniform(place[2]));
    const double azimuth = 2 * kPi * uniform(place[3]);
    const double sideways_px = c.depth_um * 1e-6 / pitch_m * std::sqrt(1 - cosine * cosine) / cosine;
    // ln(x) has the variance ln(1 + spread^2) if x has the mean 1: Aitchison & Brown, The Lognormal
    // Distribution, 1957, 2.3.
    const double log_variance = std::log1p(c.spread_fraction * c.spread_fraction);
    const double deviate = static_cast<double>(normal_quantile(uniform01(kind[0])));
    const double over_mean = std::exp(std::sqrt(log_variance) * deviate - 0.5 * log_variance);
    return {uniform(place[0]) * image.width(), uniform(place[1]) * image.height(),
            sideways_px * std::cos(azimuth), sideways_px * std::sin(azimuth),
            c.electrons_per_um * c.depth_um / cosine * over_mean};
}

// Adds charge along a straight line, in equal parts at most a quarter of a pixel apart. Charge outside the
// image is lost, and a grazing track is only followed to the edge.
void add_track(const Track& t, ElectronImage& image) {
    const double length_px = std::hypot(t.dx_px, t.dy_px);
    const double parts = std::ceil(std::max(1.0, 4 * length_px));
    const auto share = static_cast<float>(t.electrons / parts);
    for (double i = 0.5; i < parts; i += 1) {
        const double x = t.x_px + t.dx_px * i / parts, y = t.y_px + t.dy_px * i / parts;
        if (x < 0 || y < 0 || x >= image.width() || y >= image.height()) return;
        image.row(static_cast<int>(y))[static_cast<std::size_t>(x)] += share;
    }
}

}  // namespace

void add_tracks(const CosmicRayConfig& c, double pitch_m, double exposure_s, RandomKey key,
                ElectronImage& charge_e) {
    const double area_cm2 = static_cast<double>(charge_e.pixels()) * pitch_m * pitch_m * 1e4;
    const auto words = random_words(key, RandomPurpose::kCosmicRay, 0, 0);
    const std::uint32_t tracks = std::min(
        kMaxTracks,
        poisson_count(c.rate_cm2_s * area_cm2 * exposure_s, static_cast<double>(uniform01(words[0]))));
    for (std::uint32_t i = 0; i < tracks; ++i) add_track(draw_track(c, pitch_m, key, i, charge_e), charge_e);
}

}  // namespace hilcam
