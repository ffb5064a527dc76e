#include "emulator/clone/clone_maps.h"

#include <algorithm>
#include <cmath>

#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

// Flats of which the gains are taken: bright enough that the pixels' offsets do not matter, and straight.
constexpr double kLeastSignal = 0.1, kMostSignal = 0.85;
// Parts of the converter's range from which a mean may be cut off.
constexpr double kNearEnd = 0.9;
// Two states that are so far apart [sigma] are told apart in every frame.
constexpr double kClearStates = 4;
constexpr int kShadingOrder = 4;

// Means of rows and columns contain a share of the scatter of their pixels, which also multiplies with the
// lines' own deviations: to first order that adds the pixels' variance over their number.
void add_scatter(Nonuniformity& n, double pixel_variance, const PixelSelection& good) {
    const double error = std::sqrt(std::max(pixel_variance, 0.0) / static_cast<double>(good.count()));
    n.row.uncertainty = std::hypot(n.row.uncertainty, error);
    n.column.uncertainty = std::hypot(n.column.uncertainty, error);
}

class MapMaker {
  public:
    MapMaker(const MapWork& work, CloneMeasurement& out)
        : work_(work), out_(out), k_(out.gain_dn_e.value), pixels_(out.good.use.size()) {}

    void make() {
        make_dark_line();
        make_gain();
        make_prnu();
        add_scatter(out_.dsnu_e, out_.offset_e.spread.measured.pixel / square(k_), out_.good);
        add_scatter(out_.prnu_fraction,
                    square(out_.prnu_fraction.pixel.value) + half_level().point.light.pixel_dn2() /
                                                                 frames(half_level().series) /
                                                                 square(half_level().point.signal_dn()),
                    out_.good);
        list_defects();
        finish_maps();
    }

  private:
    const TemporalStatistics& dark_statistics(std::size_t series) const {
        return std::find_if(out_.dark.begin(), out_.dark.end(),
                            [&](const MeasuredDark& d) { return d.series == series; })
            ->point.dark;
    }
    double frames(std::size_t series) const {
        return static_cast<double>(work_.frames.series[series].frames);
    }
    double exposure_s(std::size_t series) const { return work_.frames.series[series].exposure_s; }
    bool has_rate() const { return exposure_s(work_.darks.back()) > 1.001 * exposure_s(work_.darks.front()); }

    // --- offset and dark signal of each pixel

    LineWeights weights_of(const std::vector<std::size_t>& darks) const {
        std::vector<double> time, variance;
        for (const std::size_t s : darks) {
            time.push_back(exposure_s(s));
            variance.push_back(std::max(dark_statistics(s).pixel_dn2(), 1e-6) / frames(s));
        }
        return line_weights(time, variance);
    }
    void make_dark_line() {
        offset_dn_.assign(pixels_, 0), rate_dn_s_.assign(pixels_, 0);
        if (!has_rate()) return take_one_exposure();
        weights_ = weights_of(work_.darks);
        for (std::size_t s = 0; s < work_.darks.size(); ++s)
            for (std::size_t i = 0; i < pixels_; ++i) {
                offset_dn_[i] += weights_.offset[s] * work_.stacks[work_.darks[s]].mean[i];
                rate_dn_s_[i] += weights_.rate[s] * work_.stacks[work_.darks[s]].mean[i];
            }
        refit_cut_off_pixels();
        double row_of_offset = 0, row_of_rate = 0;
        for (std::size_t s = 0; s < work_.darks.size(); ++s) {
            const double row = dark_statistics(work_.darks[s]).row_dn2 / frames(work_.darks[s]);
            row_of_offset += square(weights_.offset[s]) * row, row_of_rate += square(weights_.rate[s]) * row;
        }
        out_.dsnu_e =
            dsnu_e(offset_dn_, {weights_.offset_variance, row_of_offset}, out_.good, out_.gain_dn_e);
        out_.dark_spread_e_s =
            dsnu_e(rate_dn_s_, {weights_.rate_variance, row_of_rate}, out_.good, out_.gain_dn_e);
        out_.offset_e.spread = map_spread(offset_dn_, out_.good, weights_.offset_variance, row_of_offset);
        out_.dark_e_s.spread = map_spread(rate_dn_s_, out_.good, weights_.rate_variance, row_of_rate);
    }
    void take_one_exposure() {
        double frames_of_all = 0;
        for (const std::size_t s : work_.darks) frames_of_all += frames(s);
        for (const std::size_t s : work_.darks)
            for (std::size_t i = 0; i < pixels_; ++i)
                offset_dn_[i] += frames(s) / frames_of_all * work_.stacks[s].mean[i];
        const TemporalStatistics& dark = dark_statistics(work_.darks.front());
        weights_.offset_variance = dark.pixel_dn2() / frames_of_all;
        const PictureError rest{weights_.offset_variance, dark.row_dn2 / frames_of_all};
        out_.dsnu_e = dsnu_e(offset_dn_, rest, out_.good, out_.gain_dn_e);
        out_.offset_e.spread = map_spread(offset_dn_, out_.good, rest.pixel_dn2, rest.row_dn2);
    }
    // A hot pixel that reaches the converter's end at long exposures is fitted to the shorter ones.
    void refit_cut_off_pixels() {
        const double limit = kNearEnd * (std::exp2(work_.frames.bits) - 1);
        for (std::size_t i = 0; i < pixels_; ++i) {
            std::size_t usable = 0;
            while (usable < work_.darks.size() && work_.stacks[work_.darks[usable]].mean[i] < limit) ++usable;
            if (usable == work_.darks.size()) continue;
            std::vector<std::size_t> some(
                work_.darks.begin(),
                work_.darks.begin() + static_cast<std::ptrdiff_t>(std::max<std::size_t>(usable, 2)));
            while (some.size() < work_.darks.size() &&
                   exposure_s(some.back()) <= 1.001 * exposure_s(some.front()))
                some.push_back(work_.darks[some.size()]);
            const LineWeights w = weights_of(some);
            offset_dn_[i] = rate_dn_s_[i] = 0;
            for (std::size_t s = 0; s < some.size(); ++s)
                offset_dn_[i] += w.offset[s] * work_.stacks[some[s]].mean[i],
                    rate_dn_s_[i] += w.rate[s] * work_.stacks[some[s]].mean[i];
        }
    }
    std::vector<double> without_dark(std::size_t flat) const {
        std::vector<double> out = work_.stacks[flat].mean;
        for (std::size_t i = 0; i < pixels_; ++i) out[i] -= offset_dn_[i] + rate_dn_s_[i] * exposure_s(flat);
        return out;
    }
    // Variance of the dark's part in without_dark().
    double dark_variance(double time_s) const {
        return weights_.offset_variance + 2 * time_s * weights_.covariance +
               square(time_s) * weights_.rate_variance;
    }

    // --- gain of each pixel

    // A bent response changes gain differences by d ln(signal) / d ln(light).
    double stretch(double signal_dn) const {
        if (!work_.response) return 1;
        const ResponseCurve& r = *work_.response;
        const double photons = r.photons(signal_dn);
        const double outside = r.offset_dn() / r.responsivity_dn_photon().value;
        return signal_dn / ((photons + outside) * r.slope_dn_photon(photons));
    }
    std::vector<const MeasuredLevel*> levels_for_gain() const {
        std::vector<const MeasuredLevel*> out;
        const MeasuredLevel* nearest = nullptr;
        for (const MeasuredLevel& level : out_.light) {
            if (level.saturated) continue;
            const double share = level.point.signal_dn() / out_.saturation_dn;
            if (share > kLeastSignal && share < kMostSignal) out.push_back(&level);
            nearest = &level;  // the brightest, if there is none in the range
        }
        if (out.empty()) out.push_back(nearest);
        return out;
    }
    const MeasuredLevel& half_level() const {
        const MeasuredLevel* best = nullptr;
        for (const MeasuredLevel* level : levels_for_gain())
            if (!best || std::abs(level->point.signal_dn() / out_.saturation_dn - 0.5) <
                             std::abs(best->point.signal_dn() / out_.saturation_dn - 0.5))
                best = level;
        return *best;
    }
    void make_gain() {
        gain_.assign(pixels_, 0);
        const std::vector<PixelSelection> planes =
            color_planes(work_.like, work_.frames.width, work_.frames.height);
        double weights = 0, of_offset = 0, of_rate = 0, of_flats = 0, of_rows = 0;
        for (const MeasuredLevel* level : levels_for_gain()) {
            const double signal = level->point.signal_dn(), n = frames(level->series);
            const double variance =
                (level->point.light.pixel_dn2() / n + dark_variance(exposure_s(level->series))) /
                square(signal);
            const double weight = 1 / variance;
            std::vector<double> image = without_dark(level->series);
            for (const PixelSelection& plane : planes)
                add_plane(image, both(out_.good, plane), plane, weight);
            weights += weight;
            of_flats += square(weight / signal) * level->point.light.pixel_dn2() / n;
            of_rows += square(weight / signal) * level->point.light.row_dn2 / n;
            of_offset += weight / signal, of_rate += weight / signal * exposure_s(level->series);
        }
        for (double& value : gain_) value /= weights;
        // The darks' error is the same in all levels.
        const double of_dark = square(of_offset) * weights_.offset_variance +
                               2 * of_offset * of_rate * weights_.covariance +
                               square(of_rate) * weights_.rate_variance;
        out_.gain.spread =
            map_spread(gain_, out_.good, (of_flats + of_dark) / square(weights), of_rows / square(weights));
    }
    void add_plane(const std::vector<double>& image, const PixelSelection& good, const PixelSelection& plane,
                   double weight) {
        const std::vector<double> shading = smooth_surface(image, good, kShadingOrder);
        double sum = 0, count = 0;
        for (std::size_t i = 0; i < pixels_; ++i)
            if (good.use[i]) sum += image[i], ++count;
        const double bend = stretch(sum / std::max(count, 1.0));
        for (std::size_t i = 0; i < pixels_; ++i)
            if (plane.use[i]) gain_[i] += weight * bend * (image[i] / shading[i] - 1);
    }
    void make_prnu() {
        const MeasuredLevel& level = half_level();
        const double signal = level.point.signal_dn(), n = frames(level.series);
        Nonuniformity prnu =
            prnu_fraction(without_dark(level.series), signal,
                          {level.point.light.pixel_dn2() / n + dark_variance(exposure_s(level.series)),
                           level.point.light.row_dn2 / n},
                          largest_plane(out_.good, work_.like));
        const double bend = stretch(signal);
        for (Measured* m : {&prnu.total, &prnu.row, &prnu.column, &prnu.pixel})
            m->value *= bend, m->uncertainty *= bend;
        out_.prnu_fraction = std::move(prnu);
    }

    // --- defects

    void list_defects() {
        out_.hot_limit_e_s = work_.faults.hot_limit_dn_s / k_;
        hot_ = work_.faults.hot;
        mean_rate_dn_s_ = mean_of_good(rate_dn_s_);
        const double straight = straight_rate();
        for (std::size_t i = 0; i < pixels_; ++i)
            if (work_.faults.noisy[i] && !work_.faults.weak[i]) candidates_.push_back(i);
        list_blinking();
        for (std::size_t i = 0; i < pixels_; ++i) {
            if (work_.faults.weak[i])
                list(DefectKind::kDead, i, 0);
            else if (hot_[i] && has_rate())
                list(DefectKind::kHot, i, std::max(0.0, rate_dn_s_[i] * straight / k_));
        }
    }
    void list(DefectKind kind, std::size_t i, double value) {
        out_.defects.push_back(
            {kind, static_cast<int>(i) % out_.width, static_cast<int>(i) / out_.width, value});
    }
    // Noisy pixels blink, unless their dark current is enough to explain it.
    void list_blinking() {
        const std::size_t brief = work_.darks.front();
        const double n = frames(brief), time_s = exposure_s(brief);
        const double quiet_dn2 = dark_statistics(brief).variance_dn2.value;
        std::erase_if(candidates_, [&](std::size_t i) {
            const double expected = quiet_dn2 + k_ * std::max(0.0, rate_dn_s_[i]) * time_s;
            return work_.stacks[brief].variance[i] < expected * (1 + 6 * std::sqrt(2 / (n - 1)));
        });
        std::vector<std::vector<double>> values(candidates_.size());
        DnImage frame(out_.width, out_.height);
        for (std::size_t k = 0; k < work_.frames.series[brief].frames && !candidates_.empty(); ++k) {
            work_.frames.series[brief].read(k, frame);
            for (std::size_t c = 0; c < candidates_.size(); ++c)
                values[c].push_back(static_cast<double>(frame.all()[candidates_[c]]));
        }
        double changes = 0, chances = 0;
        for (std::size_t c = 0; c < candidates_.size(); ++c) {
            const std::size_t i = candidates_[c];
            const double sigma = std::sqrt(quiet_dn2 + k_ * std::max(0.0, rate_dn_s_[i]) * time_s);
            const TwoStates states = two_states(values[c], sigma);
            const double height_dn = states.high_dn - states.low_dn;
            if (height_dn > kClearStates * sigma) changes += states.changes, chances += n - 1;
            // The mean depends on how long each state was seen; the camera's offset is between them.
            cool_if_only_blinking(i, height_dn);
            offset_dn_[i] = 0.5 * (states.high_dn + states.low_dn) - rate_dn_s_[i] * time_s;
            list(DefectKind::kBlinking, i, height_dn / k_);
        }
        // A state is drawn anew every n frames and is another every second time. The number of changes
        // is binomial.
        if (changes > 0)
            out_.blinking_frames = {std::max(1.0, 0.5 * chances / changes),
                                    0.5 * chances / changes * std::sqrt(0.5 / changes)};
    }

    // The means of a blinking pixel differ by the time in each state, which looks like a dark current. States
    // may last for eight frames; three standard deviations of the difference of two means.
    void cool_if_only_blinking(std::size_t i, double height_dn) {
        if (!has_rate()) return;
        const double time_s = exposure_s(work_.darks.back()) - exposure_s(work_.darks.front());
        const double slack_dn_s =
            3 * 0.5 * height_dn * std::sqrt(2 * 8 / frames(work_.darks.back())) / time_s;
        if (std::abs(rate_dn_s_[i] - mean_rate_dn_s_) > slack_dn_s) return;
        hot_[i] = 0, rate_dn_s_[i] = mean_rate_dn_s_;
    }

    // --- maps for the camera file

    // The factor that makes dark rates straight in charge, as the mean dark current is.
    double straight_rate() const {
        const bool seen =
            out_.dark_current_e_s && out_.dark_current_e_s->value > 5 * out_.dark_current_e_s->uncertainty;
        return seen && mean_rate_dn_s_ > 0 ? out_.dark_current_e_s->value * k_ / mean_rate_dn_s_ : 1;
    }

    void finish_maps() {
        const double mean = mean_of_good(offset_dn_);
        out_.offset_e.value = with_true_spread(offset_dn_, out_.good, out_.offset_e.spread);
        for (double& value : out_.offset_e.value) value = (value - mean) / k_;
        out_.gain.value = with_true_spread(gain_, out_.good, out_.gain.spread);
        for (double& value : out_.gain.value) value = std::max(0.0, 1 + value);
        if (!has_rate()) return;
        const double straight = straight_rate();
        out_.dark_e_s.value = with_true_spread(rate_dn_s_, out_.good, out_.dark_e_s.spread);
        for (double& value : out_.dark_e_s.value) value = std::max(0.0, value * straight / k_);
    }
    double mean_of_good(const std::vector<double>& image) const {
        double sum = 0, count = 0;
        for (std::size_t i = 0; i < pixels_; ++i)
            if (out_.good.use[i]) sum += image[i], ++count;
        return sum / std::max(count, 1.0);
    }

    const MapWork& work_;
    CloneMeasurement& out_;
    double k_;
    std::size_t pixels_;
    LineWeights weights_;
    std::vector<double> offset_dn_, rate_dn_s_, gain_;
    std::vector<std::size_t> candidates_;  // pixels that may blink
    std::vector<std::uint8_t> hot_;
    double mean_rate_dn_s_ = 0;
};

}  // namespace

void measure_pixel_maps(const MapWork& work, CloneMeasurement& out) { MapMaker(work, out).make(); }

}  // namespace hilcam
