// How fast the camera turns: up to 30 degrees a second.

#include "render/shading/ray_generators.h"
#include "render/vocabulary/pose.h"
#include "tests/extremes/groups.h"
#include "tests/extremes/light_truth.h"

namespace hilcam::extremes {
namespace {

constexpr double kFocal_px = 1000, kRateExposure_s = 0.1;
const std::array<double, 5> kRates_deg_s = {0, 0.001, 0.1, 3, 30};

// A Gaussian spot of 1.5 px, cos^3 so that a point has the same light everywhere in the field.
CameraModel spot_camera(int width, int height) {
    CameraModel c = gaussian_camera(1.5);
    c.width_px = width, c.height_px = height;
    c.focal_length_m = kFocal_px * c.pitch_m;
    c.cos_power = 3;
    return c;
}
constexpr double kSpotVariance_px2 = 1.5 * 1.5 + 1.0 / 12;  // charge diffusion and the pixel

struct Spread {
    double sum = 0, mean = 0, variance = 0;
};
// Along x, of the pixels within `reach` of the middle.
Spread spread_of(const ElectronImage& image, int y0, int y1, double middle_px, double reach_px) {
    Spread out;
    double first = 0, second = 0;
    for (int y = y0; y < y1; ++y)
        for (int x = 0; x < image.width(); ++x) {
            const double from_middle = x + 0.5 - middle_px, q = at(image, x, y);
            if (std::abs(from_middle) > reach_px) continue;
            out.sum += q, first += q * from_middle, second += q * from_middle * from_middle;
        }
    out.mean = first / out.sum;
    out.variance = second / out.sum - out.mean * out.mean;
    return out;
}

}  // namespace

Group propagated_rates() {
    Group group{"PropagatedRates",
                "Rates: attitude after an hour of turning",
                "rate [deg/s]",
                {"angle [rad]"},
                "rate times time, in extended precision.",
                "8 roundings to double precision of the whole angle.",
                {}};
    for (const double rate_deg_s : {0.0, 1e-12, 1e-6, 0.1, 1.0, 30.0, 360.0}) {
        const double rate = rate_deg_s * kDegree_rad;
        group.cases.push_back(
            {text(rate_deg_s), {8 * kDoubleGrain * (1 + rate * 3600)}, [rate] {
                 Motion motion;
                 motion.rate_body_rad_s = {0, rate, 0};
                 const Quat q = propagate(motion, {3600'000'000'000}).world_from_body;
                 const long double half = static_cast<long double>(rate) * 1800;
                 const auto c = static_cast<double>(std::cos(half)), s = static_cast<double>(std::sin(half));
                 // 2 atan2 of the difference's quaternion.
                 const double turned = 2 * std::abs(std::atan2(q.y * c - q.w * s, q.w * c + q.y * s));
                 return std::vector<Found>{{rate * 3600, turned + std::abs(q.x) + std::abs(q.z)}};
             }});
    }
    return group;
}

// A star at the middle of the field, seen for 0.1 s through 1000 px of focal length.
Group star_trails() {
    Group group{
        "StarTrails",
        "Rates: a star's trail in 0.1 s",
        "rate [deg/s]",
        {"electrons", "centroid [px]", "variance along the trail [px^2]"},
        "E A T eta t int lambda / (h c); the middle; f^2 (tan(a/2) / (a/2) - 1), a the angle turned, and the "
        "spot's own 1.5^2 + 1/12.",
        "16 roundings to single precision; 0.05 e- that each of the trail's points may leave out, within 9 "
        "px, "
        "and the roundings with a lever of 40 px; the same with the levers squared, and half a pixel between "
        "the points, 1/48 px^2.",
        {}};
    for (const double rate_deg_s : kRates_deg_s) {
        const CameraModel c = spot_camera(160, 64);
        constexpr double kElectrons = 1e5;
        const double irradiance = kElectrons / (electrons_per_irradiance(c, 0.5, 0.6) * kRateExposure_s);
        const double rounded = 16 * kFloatGrain;
        // Points of the trail, two a pixel; each leaves out 0.05 e- at most, beyond 4.5 and within 9 px of
        // it, and gives them to its other pixels.
        const double parts =
            std::max(1.0, std::ceil(2 * kFocal_px * rate_deg_s * kDegree_rad * kRateExposure_s));
        const double lost = parts * 0.05 / kElectrons;
        group.cases.push_back(
            {text(rate_deg_s),
             {rounded, 9 * lost + 40 * rounded, 1.0 / 48 + 9 * 9 * lost + 40 * 40 * rounded},
             [c, irradiance, rate_deg_s] {
                 Bench bench(c);
                 bench.fill(0);
                 const double turned = rate_deg_s * kDegree_rad * kRateExposure_s;
                 Exposure exposure{.exposure_s = kRateExposure_s};
                 exposure.camera_rate_rad_s = {0, rate_deg_s * kDegree_rad, 0};
                 const PointSource star = point_at(80, 32, irradiance);
                 const Spread s = spread_of(bench.expose(exposure, std::span(&star, 1)), 0, 64, 80, 200);
                 const double half = 0.5 * turned;
                 const double trail = half > 1e-6 ? kFocal_px * kFocal_px * (std::tan(half) / half - 1) : 0;
                 return std::vector<Found>{
                     {kElectrons, relative(s.sum, kElectrons)},
                     {80, std::abs(s.mean)},
                     {kSpotVariance_px2 + trail, std::abs(s.variance - kSpotVariance_px2 - trail)}};
             }});
    }
    return group;
}

// One bright column of a picture that moves as a whole, by MTF.
Group smeared_pictures() {
    Group group{"SmearedPictures",
                "Rates: a bright column smeared in 0.1 s",
                "rate [deg/s]",
                {"electrons of a row", "centroid [px]", "variance along the smear [px^2]"},
                "the column's own electrons; the middle; length^2 / 12 and the spot's own 1.5^2 + 1/12.",
                "an FFT pair's grain of the peak in every pixel within reach, by its lever, by its lever "
                "squared; and the "
                "1.5e-5 that the spot's transfer function still passes at the picture's Nyquist frequency.",
                {}};
    for (const double rate_deg_s : kRates_deg_s) {
        // A picture at rest is convolved by a compact kernel instead: see
        // tests/unit/sensor/convolve_test.cpp.
        if (rate_deg_s == 0) continue;
        const CameraModel c = spot_camera(160, 16);
        const double smear_px = kFocal_px * rate_deg_s * kDegree_rad * kRateExposure_s;
        const double reach_px = 0.5 * smear_px + 12,
                     radiance = 1e4 / electrons_per_radiance(c, 0.5, 0.6) / kRateExposure_s;
        // The peak's share of the row's light is at most that of the still spot, 1 / (sqrt(2 pi) 1.5).
        const double grain = fft_pair_grain(176 * 32) * 0.27;
        const double lever = reach_px * reach_px, lever2 = 2.0 / 3 * std::pow(reach_px, 3);
        // What falls outside the reach of eight standard deviations is below 1e-14; the spot's transfer
        // function at the picture's Nyquist frequency is 1.5e-5.
        constexpr double kAlias = 1.5e-5;
        group.cases.push_back({text(rate_deg_s),
                               {2 * reach_px * grain + kAlias, lever * grain + kAlias,
                                lever2 * grain + kAlias * reach_px * reach_px},
                               [c, smear_px, reach_px, radiance, rate_deg_s] {
                                   Bench bench(c);
                                   bench.fill(0);
                                   for (int y = 0; y < bench.radiance.height(); ++y)
                                       bench.radiance.row(y)[static_cast<std::size_t>(8 + 80)] =
                                           static_cast<float>(radiance);
                                   Exposure exposure{.exposure_s = kRateExposure_s};
                                   exposure.image_rate_px_s = {kFocal_px * rate_deg_s * kDegree_rad, 0};
                                   const Spread s = spread_of(bench.expose(exposure), 8, 9, 80.5, reach_px);
                                   const double variance = kSpotVariance_px2 + smear_px * smear_px / 12;
                                   return std::vector<Found>{{1e4, relative(s.sum, 1e4)},
                                                             {80.5, std::abs(s.mean)},
                                                             {variance, std::abs(s.variance - variance)}};
                               }});
    }
    return group;
}

// Which row of a rolling shutter sees a star, and where in it.
Group rolling_rows() {
    Group group{
        "RollingRows",
        "Rates: a star under a rolling shutter",
        "rate about x; about y [deg/s]",
        {"row [px]", "column [px]"},
        "the row y at whose instant (y - 240) 50 us the star is at y: bisection in double precision on the "
        "pinhole's equation.",
        "1e-4 px, to which the program looks for the row.",
        {}};
    static const ImageGeometry geometry{640, 480, 0, kFocal_px, {}};
    constexpr double kLine_s = 50e-6;
    for (const auto& [x_deg_s, y_deg_s] :
         {std::pair{0.0, 0.0}, {0.0, 0.1}, {0.1, 0.0}, {0.0, 30.0}, {30.0, 0.0}, {-30.0, 0.0}, {-30.0, 30.0}})
        group.cases.push_back(
            {text(x_deg_s) + "; " + text(y_deg_s), {1e-4, 1e-4}, [x = x_deg_s, y = y_deg_s] {
                 const Vec3d rate{x * kDegree_rad, y * kDegree_rad, 0};
                 const Vec3d star = normalized(Vec3d{0.1, 0.15, 1});
                 const auto seen_at = [&](double row) {
                     const double turn_s = (row - 240) * kLine_s;
                     return geometry.project_px(transposed(to_matrix(from_rotation_vector(turn_s * rate))) *
                                                star);
                 };
                 double low = 0, high = 480;
                 for (int step = 0; step < 80; ++step) {
                     const double middle = 0.5 * (low + high);
                     (seen_at(middle).y > middle ? low : high) = middle;
                 }
                 const auto rays = make_rolling_rays(kLine_s);
                 Motion camera;
                 camera.rate_body_rad_s = rate;
                 rays->place(geometry, camera);
                 Sighting seen;
                 const bool found = rays->find(star, std::numeric_limits<double>::infinity(), seen);
                 return std::vector<Found>{
                     {low, found ? std::abs(seen.position_px.y - low) : NAN},
                     {seen_at(low).x, found ? std::abs(seen.position_px.x - seen_at(low).x) : NAN}};
             }});
    return group;
}

}  // namespace hilcam::extremes
