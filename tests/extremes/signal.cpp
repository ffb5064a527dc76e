// How long, how bright, how faint.

#include <limits>

#include "sensor/noise.h"
#include "tests/extremes/groups.h"
#include "tests/extremes/light_truth.h"
#include "tests/support/statistics.h"

namespace hilcam::extremes {
namespace {

constexpr double kCut_e = 1e9;  // what the program cuts charge off at (focal_plane.h)

constexpr double kNothing_e = 1e-30;  // processors may take denormal numbers for 0

// An even picture everywhere: no fall-off over the field.
CameraModel even_camera() {
    CameraModel c = camera_64();
    c.cos_power = 0;
    return c;
}
double grain() { return fft_pair_grain(80 * 80) + 8 * kFloatGrain; }

double even_charge_e(const CameraModel& camera, float radiance, double exposure_s) {
    const double light_e =
        electrons_per_radiance(camera, 0.5, 0.6) * static_cast<double>(radiance) * exposure_s;
    return std::min(kCut_e, light_e);
}
// The worst pixel of an even picture.
Found exposed(Bench& bench, float radiance, double exposure_s, double truth_e) {
    bench.fill(radiance);
    Worst worst;
    for (const float q : bench.expose({.exposure_s = exposure_s}).all())
        worst.add(std::abs(q - truth_e) / std::max(truth_e, kNothing_e));
    return {truth_e, worst.value()};
}

}  // namespace

Group exposures() {
    Group group{"Exposures",
                "Exposure: an even picture of 1 W m^-2 sr^-1 um^-1",
                "exposure [s]",
                {"mean charge [e-]"},
                "L A (pitch/f)^2 T eta t int lambda / (h c) dlambda; cut off at 1e9 e-. The error is that of "
                "the worst "
                "pixel.",
                "an FFT pair's grain (a rounding a level and transform), and 8 roundings of its factors. "
                "What is found is the "
                "diffraction integral's: it is 1 - 1.6e-6 at zero frequency.",
                {}};
    for (const double exposure_s : {1e-9, 1e-6, 1e-3, 1.0, 10.0, 1e3, 1e4, 1e6})
        group.cases.push_back({text(exposure_s), {grain()}, [exposure_s] {
                                   Bench bench(even_camera());
                                   const double truth_e = even_charge_e(bench.camera, 1, exposure_s);
                                   return std::vector<Found>{exposed(bench, 1, exposure_s, truth_e)};
                               }});
    return group;
}

// Whatever comes, a frame of numbers goes.
Group radiances() {
    Group group{
        "Radiances",
        "Signal: an even picture for a second",
        "radiance [W m^-2 sr^-1 um^-1]",
        {"mean charge [e-]", "frame of 12 bits, full well 1000 e-, offset 17 [DN]"},
        "as above; next to nothing is the offset, and where all pixels are full, 1017 DN. What is no number "
        "counts as full.",
        "as above, or of 1e-30 e-; 0 DN.",
        {}};
    constexpr float kLargest = std::numeric_limits<float>::max(),
                    kInfinity = std::numeric_limits<float>::infinity(),
                    kStep = std::numeric_limits<float>::denorm_min();
    for (const float radiance : {0.0f, kStep, 1e-30f, 1e-15f, 1.0f, 1e3f, 1e9f, 1e20f, kLargest, kInfinity,
                                 std::numeric_limits<float>::quiet_NaN()}) {
        const bool is_number = radiance < kInfinity;
        CameraModel c = even_camera();
        c.full_well_e = 1000, c.offset_dn = 17;
        const double charge_e = is_number ? even_charge_e(c, radiance, 1) : kCut_e;
        const double truth_dn = charge_e < 1e-9 ? 17 : 1017;
        group.cases.push_back(
            {text(static_cast<double>(radiance)), {grain(), 0}, [c, radiance, charge_e, truth_dn] {
                 Bench bench(c);
                 const Found charge = exposed(bench, radiance, 1, charge_e);
                 bench.chain.digitise(bench.electrons, {.exposure_s = 1}, {1, 1}, bench.frame);
                 Worst off;
                 for (const std::uint16_t dn : bench.frame.all()) off.add(std::abs(dn - truth_dn));
                 return std::vector<Found>{charge, {truth_dn, off.value()}};
             }});
    }
    return group;
}

// Full pixels have no shot noise left: their numbers are known exactly.
Group gains() {
    Group group{"Gains",
                "Signal: full pixels of 1000 e- at a gain",
                "gain [dB]; bits",
                {"frame [DN]"},
                "1000 e- times 10^(dB / 20), rounded and cut off at the converter's last step.",
                "0: no step is off.",
                {}};
    struct Row {
        double gain_db;
        std::int64_t bits;
    };
    for (const Row row : {Row{-60, 12},
                          {-20, 12},
                          {0, 12},
                          {12, 12},
                          {24, 12},
                          {60, 12},
                          {0, 8},
                          {0, 10},
                          {0, 14},
                          {24, 14},
                          {0, 16},
                          {36, 16},
                          {60, 16}})
        group.cases.push_back({text(row.gain_db) + "; " + std::to_string(row.bits), {0}, [row] {
                                   CameraModel c = even_camera();
                                   c.full_well_e = 1000, c.bits = row.bits;
                                   Bench bench(c);
                                   const Exposure exposure{.gain_db = row.gain_db};
                                   const double most = static_cast<double>((1 << row.bits) - 1);
                                   const double truth =
                                       std::min(most, std::round(1000 * std::pow(10, row.gain_db / 20)));
                                   Worst off;
                                   for (const std::uint16_t dn : bench.digitise_flat(1e6f, 1, exposure).all())
                                       off.add(std::abs(dn - truth));
                                   return std::vector<Found>{{truth, off.value()}};
                               }});
    return group;
}

Group shot_noise() {
    constexpr std::size_t kCount = 1'000'000;
    Group group{"ShotNoise",
                "Signal: a million pixels of one mean charge",
                "mean [e-]",
                {"their mean [e-]", "their variance [e-^2]"},
                "Poisson: both are the mean.",
                "4.5 standard errors, sqrt(m / n) and sqrt((2 m^2 + m) / n); uniform numbers in steps of "
                "2^-23; above "
                "32 e- what noise.h states (1e-3 e-, 0.3 %), and single precision's own steps.",
                {}};
    for (const double mean : {0.0, 1e-8, 1e-4, 0.01, 1.0, 31.999, 32.0, 1e3, 1e5, 1e7, 1e9}) {
        const double n = kCount, step = 2 * kFloatGrain * mean;
        const double cells =
            mean < 32 ? (mean > 0 ? 0x1p-22 * (1 + mean) * (1 + mean) : 0) : 1e-3 + 0.5 * step;
        const double mean_limit = kSigmas * std::sqrt(mean / n) + cells;
        const double variance_limit = kSigmas * std::sqrt((2 * mean * mean + mean) / n) +
                                      (mean < 32 ? cells * (1 + 2 * mean) : 0.003 * mean + step * step / 12);
        group.cases.push_back({text(mean), {mean_limit, variance_limit}, [mean] {
                                   const std::vector<float> in(kCount, static_cast<float>(mean));
                                   std::vector<float> charge(kCount), deviates;
                                   draw_pixels(in, {3, 4}, 0, charge, deviates);
                                   const Moments m = moments_of(charge);
                                   return std::vector<Found>{{mean, std::abs(m.mean - mean)},
                                                             {mean, std::abs(m.variance - mean)}};
                               }});
    }
    return group;
}

}  // namespace hilcam::extremes
