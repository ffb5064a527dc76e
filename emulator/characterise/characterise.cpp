#include "emulator/characterise/characterise.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include "emulator/progress/progress.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

constexpr SensorSampling kSampling{16, 1, 1};  // the plate has no detail to resolve
constexpr int kStackFrames = 64;               // L of section 8
// Pixels times pairs for each level: variances are then known to 0.2 %, and K from some twenty levels to 0.07
// %.
constexpr double kLightPixels = 5e5;
// Limit in Gaussian sigmas; a share of 2e-9 is beyond it, none of 262,144 good pixels.
constexpr double kDefectSigmas = 6;
// Wanted relative error of the dark current, which determines the number of frames at the longest exposures.
constexpr double kDarkCurrentError = 0.004;
constexpr int kMinDarkPairs = 4, kMaxDarkPairs = 256;
// Levels from 1/25 to 0.92 of saturation for the curves, then in steps of a hundredth to find where
// saturation begins.
constexpr int kLevels = 23;

std::vector<double> level_fractions() {
    std::vector<double> out;
    for (int i = 1; i <= kLevels; ++i) out.push_back(0.04 * i);
    for (int i = 93; i <= 106; ++i) out.push_back(0.01 * i);
    return out;
}

TemporalStatistics take_pairs(CameraBench& bench, const PixelSelection& selection, int pairs) {
    PairSeries series(selection);
    for (int i = 0; i < pairs; ++i) {
        const DnImage& first = bench.frame();
        series.add(first, bench.frame());
    }
    return series.result();
}

struct Stack {
    FrameStack frames;
    TemporalStatistics temporal;
};

Stack take_stack(CameraBench& bench, const PixelSelection& selection) {
    FrameStack frames(selection);
    PairSeries pairs(selection);
    for (int i = 0; i < kStackFrames / 2; ++i) {
        const DnImage& first = bench.frame();
        const DnImage& second = bench.frame();
        frames.add(first), frames.add(second);
        pairs.add(first, second);
    }
    return {std::move(frames), pairs.result()};
}

std::vector<double> less(std::vector<double> a, const std::vector<double>& b) {
    std::transform(a.begin(), a.end(), b.begin(), a.begin(), std::minus<>());
    return a;
}

// Progress of the measurements, with shares of the whole time as measured with inspector_1k.
class Phases {
  public:
    void begin(const std::string& name, double share) {
        begun_ += share_;
        share_ = share;
        progress_.now("measuring " + name);
        progress_.done(begun_);
    }
    void within(double part) { progress_.done(begun_ + part * share_); }

  private:
    Progress progress_{"measuring", 1};
    double begun_ = 0, share_ = 0;
};

// One camera's measurements, one after the other on the same bench.
class Laboratory {
  public:
    Laboratory(const CameraModel& camera, const DetectorPictures& pictures)
        : pictures_(pictures),
          setup_(lab_setup(camera)),
          selection_(lab_selection(setup_)),
          bench_(setup_.camera, setup_.grid, kSampling, setup_.lamp_w_m2_um, pictures) {
        bench_.show({1, 1, 0});
    }

    Characterisation measure() {
        out_.setup = setup_;
        out_.pixels = selection_.count();
        phases_.begin("defects", 0.04);
        find_defects();
        out_.defects = out_.pixels - selection_.count();
        evenly_lit_ = evenly_lit(setup_, selection_);
        photons_per_s_ = photons_per_s(setup_, evenly_lit_);
        const auto lit = static_cast<double>(evenly_lit_.count());
        light_pairs_ = static_cast<int>(std::clamp(std::ceil(kLightPixels / lit), 2.0, 16.0));
        measure_bandwidths();
        phases_.begin("response to light", 0.12);
        const ResponseCurve response = measure_light();
        phases_.begin("differences between pixels", 0.02);
        measure_nonuniformity(response);
        phases_.begin("darkness", 0.02);
        measure_darkness();
        out_.frames = bench_.frames_taken();
        const auto told = [this](double part) { phases_.within(part); };
        phases_.begin("MTF along rows", 0.40);
        out_.horizontal = measure_mtf(setup_, response, EdgeDirection::kAlongRows, pictures_, told);
        phases_.begin("MTF along columns", 0.40);
        out_.vertical = measure_mtf(setup_, response, EdgeDirection::kAlongColumns, pictures_, told);
        return std::move(out_);
    }

  private:
    double saturation_e(double gain_db) const { return configured_saturation_e(setup_.camera, gain_db); }
    // Opens the shutter for a share of the light that saturates at a gain.
    LightLevel expose_share(double share, double gain_db) {
        const double full = saturation_e(gain_db) / saturation_e(setup_.gain_db) / kOverexposure;
        LightLevel level;
        level.exposure_s = setup_.exposure_s * (setup_.by_light || share > 1.1 ? 1 : share);
        level.filter = full * (setup_.by_light || share > 1.1 ? share : 1);
        bench_.expose({level.exposure_s, gain_db, {}, {}}, level.filter);
        level.point.photons = photons_per_s_ * level.filter * level.exposure_s;
        return level;
    }
    void expose_dark(double exposure_s, double gain_db) { bench_.expose({exposure_s, gain_db, {}, {}}, 0); }

    // Finds pixels with a dark signal, gain or temporal noise far from that of all others.
    void find_defects() {
        const auto mean_of = [&](int frames) {
            FrameStack stack(selection_);
            for (int i = 0; i < frames; ++i) stack.add(bench_.frame());
            return stack;
        };
        const auto exclude = [&](const std::vector<double>& image) {
            exclude_outliers(less(image, smooth_surface(image, selection_, 3)), kDefectSigmas, selection_);
        };
        expose_dark(setup_.shortest_s, setup_.dark_gain_db);
        const FrameStack brief = mean_of(kStackFrames);
        expose_dark(setup_.longest_s, setup_.dark_gain_db);
        const FrameStack lasting = mean_of(kStackFrames / 4);
        const LightLevel half = expose_share(0.5, setup_.gain_db);
        const FrameStack flat = mean_of(kStackFrames / 4);
        expose_dark(half.exposure_s, setup_.gain_db);
        const FrameStack dark = mean_of(kStackFrames / 4);
        exclude(brief.mean_dn());
        // The cube root of a chi-square variate is Gaussian (Wilson & Hilferty, PNAS 17, 1931).
        std::vector<double> noise = brief.temporal_variance_dn2();
        for (double& value : noise) value = std::cbrt(value);
        exclude(noise);
        exclude(less(lasting.mean_dn(), brief.mean_dn()));
        exclude(less(flat.mean_dn(), dark.mean_dn()));
    }

    void measure_bandwidths() {
        const CameraModel& c = setup_.camera;
        const bool filters =
            c.filters.low_pass_cy_px > 0 || c.filters.high_pass_cy_px > 0 || c.filters.boost > 0;
        const bool transfer = c.ccd.parallel_inefficiency > 0 || c.ccd.serial_inefficiency > 0;
        if (!filters && !transfer) return;
        // Distance at which a one-pole filter has decayed to a thousandth. Late charge is below a thousandth
        // after two pixels.
        const double fade =
            c.filters.low_pass_cy_px > 0 ? std::log(1000) / (2 * kPi * c.filters.low_pass_cy_px) : 0;
        const NoiseReach reach{filters ? std::clamp(static_cast<int>(std::ceil(fade)), 3, 32) : 2,
                               transfer ? 2 : 0};
        // The noise `without` is subtracted from that of each pair.
        const auto mean_of_pairs = [&](NoiseReach within, const NoiseSums& without) {
            constexpr int kPairs = kStackFrames;
            NoiseSums mean;
            double sum = 0, square = 0;
            for (int i = 0; i < kPairs; ++i) {
                const DnImage& first = bench_.frame();
                const NoiseSums all = noise_sums(first, bench_.frame(), selection_, within);
                mean.variance += all.variance / kPairs, mean.total += all.total / kPairs;
                const double found =
                    NoiseSums{all.variance - without.variance, all.total - without.total}.bandwidth();
                sum += found, square += found * found;
            }
            const double bandwidth = sum / kPairs;
            return std::pair(
                Measured{bandwidth,
                         std::sqrt(std::max(0.0, square / kPairs - bandwidth * bandwidth) / (kPairs - 1))},
                mean);
        };
        // Read noise arises after the transfer, so the transfer has not smoothed it.
        NoiseSums reading;
        const LightLevel level = expose_share(0.6, setup_.gain_db);
        if (transfer) {
            expose_dark(level.exposure_s, setup_.gain_db);
            reading = mean_of_pairs(reach, {}).second;
            expose_share(0.6, setup_.gain_db);
        }
        const Measured shot = mean_of_pairs(reach, reading).first;
        out_.shot_bandwidth = shot.value;
        bandwidth_error_ = shot.uncertainty / shot.value;
        if (!filters) return;
        if (!transfer) {
            out_.read_bandwidth = out_.shot_bandwidth;
            return;
        }
        expose_dark(setup_.shortest_s, setup_.dark_gain_db);
        out_.read_bandwidth = mean_of_pairs({reach.columns, 0}, {}).first.value;
    }

    std::vector<LightLevel> light_series(double gain_db) {
        std::vector<LightLevel> out;
        for (const double share : level_fractions()) {
            LightLevel level = expose_share(share, gain_db);
            level.point.light = take_pairs(bench_, evenly_lit_, light_pairs_);
            // Noise is low, so a few frames determine the dark signal equally well.
            expose_dark(level.exposure_s, gain_db);
            level.point.dark = take_pairs(bench_, evenly_lit_, (light_pairs_ + 3) / 4);
            out.push_back(level);
            phases_.within(static_cast<double>(out.size()) / static_cast<double>(level_fractions().size()));
        }
        return out;
    }
    static std::vector<LightPoint> points_of(const std::vector<LightLevel>& levels) {
        std::vector<LightPoint> out;
        out.reserve(levels.size());
        for (const LightLevel& level : levels) out.push_back(level.point);
        return out;
    }
    // Returns K from levels at one gain, corrected for the noise that a filter removed.
    Measured gain_of(std::vector<LightPoint> points, const ResponseCurve& response,
                     double saturation_dn) const {
        Measured gain = small_signal_gain_dn_e(points, response, saturation_dn);
        gain.value /= out_.shot_bandwidth;
        gain.uncertainty = std::hypot(gain.uncertainty / out_.shot_bandwidth, gain.value * bandwidth_error_);
        return gain;
    }

    ResponseCurve measure_light() {
        out_.light = light_series(setup_.gain_db);
        const std::vector<LightPoint> points = points_of(out_.light);
        const LightPoint& saturation = points[saturation_index(points)];
        const double saturation_dn = saturation.signal_dn();
        const ResponseCurve response(points, saturation_dn);
        out_.standard_gain_dn_e = photon_transfer(points, saturation_dn).gain_dn_e;
        out_.gain_dn_e = gain_of(points, response, saturation_dn);
        const Measured small = response.responsivity_dn_photon();
        const Measured& k = out_.gain_dn_e;
        const auto relative = [](const Measured& m) { return m.uncertainty / m.value; };
        out_.quantum_efficiency = {small.value / k.value,
                                   small.value / k.value * std::hypot(relative(small), relative(k))};
        const auto electrons = [&](double signal_dn) {
            return (small.value * response.photons(signal_dn) + response.offset_dn()) / k.value;
        };
        // Saturation is found to the distance of two levels, a hundredth: a uniform error, 0.01 / sqrt 12.
        const double capacity_e = electrons(saturation_dn);
        out_.saturation_capacity_e = {capacity_e,
                                      capacity_e * std::hypot(relative(k), 0.01 / std::sqrt(12.0))};
        const LightLevel over = expose_share(kOverexposure, setup_.gain_db);
        const TemporalStatistics plateau = take_pairs(bench_, evenly_lit_, light_pairs_);
        expose_dark(over.exposure_s, setup_.gain_db);
        const TemporalStatistics dark = take_pairs(bench_, evenly_lit_, light_pairs_);
        const double full_e = electrons(plateau.mean_dn.value - dark.mean_dn.value);
        out_.full_well_e = {full_e, full_e * relative(k)};
        measure_linearity(points, saturation_dn);
        return response;
    }

    void measure_linearity(const std::vector<LightPoint>& points, double saturation_dn) {
        out_.linearity = linearity(response_points(points), saturation_dn);
        // Applies the same procedure to the data sheet's curve, at the same light and over the same range.
        std::vector<ResponsePoint> promised;
        promised.reserve(points.size());
        const double efficiency = configured_quantum_efficiency(setup_);
        for (const LightPoint& p : points)
            promised.push_back(
                {p.photons, configured_signal_dn(setup_.camera, efficiency * p.photons, setup_.gain_db), 0});
        out_.configured_linearity = linearity(promised, saturation_dn);
    }

    void measure_nonuniformity(const ResponseCurve& response) {
        const LightLevel half = expose_share(0.5, setup_.gain_db);
        const Stack flat = take_stack(bench_, selection_);
        expose_dark(half.exposure_s, setup_.gain_db);
        const Stack dark = take_stack(bench_, selection_);
        Nonuniformity prnu = prnu_fraction(flat.frames, flat.temporal, dark.frames, dark.temporal, selection_,
                                           out_.shot_bandwidth);
        // A nonlinear response scales gain differences by d ln(signal) / d ln(light). Light that arrives
        // outside the exposure counts, unless it is the smear of a frame-transfer CCD, which has the gains of
        // the column's other pixels.
        const double signal_dn = flat.temporal.mean_dn.value - dark.temporal.mean_dn.value;
        const double photons = response.photons(signal_dn);
        const bool smears = setup_.camera.shutter.kind == ShutterKind::kFrameTransfer;
        const double outside = smears ? 0 : response.offset_dn() / response.responsivity_dn_photon().value;
        const double light = photons + outside;
        const double stretch = signal_dn / (light * response.slope_dn_photon(photons));
        for (Measured* m : {&prnu.total, &prnu.row, &prnu.column, &prnu.pixel})
            m->value *= stretch, m->uncertainty *= stretch;
        out_.prnu_fraction = std::move(prnu);
    }

    void measure_darkness() {
        out_.dark_gain_dn_e = out_.gain_dn_e;
        if (setup_.dark_gain_db != setup_.gain_db) {
            const std::vector<LightPoint> points = points_of(light_series(setup_.dark_gain_db));
            const double saturation_dn = points[saturation_index(points)].signal_dn();
            out_.dark_gain_dn_e = gain_of(points, ResponseCurve(points, saturation_dn), saturation_dn);
        }
        measure_dark_series();
        expose_dark(setup_.shortest_s, setup_.dark_gain_db);
        const Stack brief = take_stack(bench_, selection_);
        out_.dsnu_e =
            dsnu_e(brief.frames, brief.temporal, selection_, out_.dark_gain_dn_e, out_.read_bandwidth);
        measure_dark_noise(brief.temporal);
    }

    void measure_dark_series() {
        const CameraModel& c = setup_.camera;
        const double dark_e = c.dark_current_now_e_s() * setup_.longest_s;
        const double gain = c.system_gain_dn_e(setup_.dark_gain_db);
        // The mean is over n pixels, or fewer independent values where rows have noise of their own.
        const double noise_e2 = std::pow(c.dark_noise_e(), 2) + dark_e + 1 / (12 * gain * gain);
        const double mean_e2 = noise_e2 / static_cast<double>(selection_.count()) +
                               std::pow(c.row_noise_e, 2) / selection_.height;
        const double wanted = dark_e > 0 ? mean_e2 / std::pow(kDarkCurrentError * dark_e, 2) : 0;
        const int pairs = static_cast<int>(std::clamp(wanted, 1.0 * kMinDarkPairs, 1.0 * kMaxDarkPairs));
        constexpr int kSteps = 8;
        for (int i = 0; i <= kSteps; ++i) {
            const double exposure_s = setup_.shortest_s + (setup_.longest_s - setup_.shortest_s) * i / kSteps;
            expose_dark(exposure_s, setup_.dark_gain_db);
            // The ends of the line determine its slope.
            const bool end = i == 0 || i == kSteps;
            out_.dark.push_back({exposure_s, take_pairs(bench_, selection_, end ? pairs : kMinDarkPairs)});
            if (setup_.longest_s <= setup_.shortest_s) break;
        }
        if (out_.dark.size() > 2)
            out_.dark_current = dark_current_e_s(out_.dark, out_.dark_gain_dn_e, out_.read_bandwidth);
    }

    // Measures at the shortest exposure. If its noise does not span the converter's steps, uses an exposure
    // at which dark current adds enough noise.
    void measure_dark_noise(TemporalStatistics brief) {
        constexpr double kEnough_dn2 = 0.5, kAim_dn2 = 0.6;
        const double gain = out_.dark_gain_dn_e.value;
        const double signal_dn_s = out_.dark_current.from_mean_e_s.value * gain;
        double exposure_s = setup_.shortest_s;
        if (brief.variance_dn2.value < kEnough_dn2 && signal_dn_s > 0) {
            exposure_s += (kAim_dn2 - brief.variance_dn2.value) / (gain * signal_dn_s);
            exposure_s = std::min(exposure_s, setup_.longest_s);
            expose_dark(exposure_s, setup_.dark_gain_db);
            brief = take_stack(bench_, selection_).temporal;
        }
        // Charge loses some of its shot noise while it is transferred.
        const double dark_signal_dn =
            std::max(0.0, signal_dn_s * exposure_s) * out_.shot_bandwidth / out_.read_bandwidth;
        out_.dark_noise_e = dark_noise_e(brief, dark_signal_dn, out_.dark_gain_dn_e, out_.read_bandwidth);
    }

    const DetectorPictures& pictures_;
    LabSetup setup_;
    PixelSelection selection_;
    CameraBench bench_;
    PixelSelection evenly_lit_;  // for figures that depend on the amount of light
    int light_pairs_ = 0;
    double photons_per_s_ = 0;
    double bandwidth_error_ = 0;  // relative
    Characterisation out_;
    Phases phases_;
};

}  // namespace

Characterisation characterise(const CameraModel& camera, const DetectorPictures& pictures) {
    return Laboratory(camera, pictures).measure();
}

}  // namespace hilcam
