#include "emulator/clone/clone_measurement.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "emulator/clone/clone_darkness.h"
#include "emulator/clone/clone_maps.h"
#include "emulator/clone/frame_checks.h"
#include "emulator/clone/series_stack.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/units.h"
#include "sensor/measure/quantiser.h"

namespace hilcam {
namespace {

// Levels that determine the response's bend: four coefficients, and two to judge them.
constexpr std::size_t kLevelsForBend = 6;

Measured mixed(const Measured& a, const Measured& b, double share) {
    return {(1 - share) * a.value + share * b.value,
            std::hypot((1 - share) * a.uncertainty, share * b.uncertainty)};
}

// Returns the dark statistics at an exposure between two that were measured: mean and variance are straight
// in time.
TemporalStatistics mixed(const TemporalStatistics& a, const TemporalStatistics& b, double share) {
    TemporalStatistics out;
    out.mean_dn = mixed(a.mean_dn, b.mean_dn, share);
    out.variance_dn2 = mixed(a.variance_dn2, b.variance_dn2, share);
    out.row_dn2 = (1 - share) * a.row_dn2 + share * b.row_dn2;
    out.frame_dn2 = (1 - share) * a.frame_dn2 + share * b.frame_dn2;
    out.pairs = std::min(a.pairs, b.pairs);
    return out;
}

class CloneLaboratory {
  public:
    CloneLaboratory(const FrameSet& frames, const CameraModel& like, const std::function<void(double)>& told)
        : frames_(frames), like_(like), told_(told) {}

    CloneMeasurement measure() {
        check_series(frames_);
        out_.width = frames_.width, out_.height = frames_.height, out_.bits = frames_.bits;
        out_.gain_db = frames_.series.front().gain_db;
        choose_temperature();
        stacks_ = stack_series(frames_, whole(), brief_, [&](double share) { told_(0.5 * share); });
        std::vector<NumberFacts> facts;
        for (const SeriesStack& s : stacks_) facts.push_back(s.numbers);
        check_numbers(frames_, facts);
        faults_ = find_faults(frames_, stacks_, reference_darks(), like_);
        out_.good = faults_.good;
        measure_darks();
        measure_light();
        measure_darkness({frames_, brief_, stacks_[brief_].mean, [&](double dn) { return charge(dn).value; }},
                         out_);
        measure_pixel_maps(
            {frames_, like_, stacks_, reference_darks(), faults_, response_ ? &*response_ : nullptr}, out_);
        told_(1);
        return std::move(out_);
    }

  private:
    PixelSelection whole() const { return {0, 0, frames_.width, frames_.height}; }
    const FrameSeries& series(std::size_t i) const { return frames_.series[i]; }
    double temperature_of(const FrameSeries& s) const {
        return s.temperature_c.value_or(like_.temperature_c);
    }
    bool at_reference(const FrameSeries& s) const {
        return std::abs(temperature_of(s) - out_.temperature_c) <= kSameTemperature_k;
    }
    std::vector<std::size_t> all_of(SeriesKind kind) const {
        std::vector<std::size_t> out;
        for (std::size_t i = 0; i < frames_.series.size(); ++i)
            if (series(i).kind == kind) out.push_back(i);
        std::stable_sort(out.begin(), out.end(), [&](std::size_t a, std::size_t b) {
            return series(a).exposure_s < series(b).exposure_s;
        });
        return out;
    }
    // Returns the darks at the reference temperature, shortest exposure first.
    std::vector<std::size_t> reference_darks() const {
        std::vector<std::size_t> out = all_of(SeriesKind::kDark);
        std::erase_if(out, [&](std::size_t i) { return !at_reference(series(i)); });
        return out;
    }

    // Takes the temperature of the flats if there are darks at it, else that with the most series of darks.
    void choose_temperature() {
        std::vector<std::pair<double, int>> count;  // in the order of the series
        for (const std::size_t i : all_of(SeriesKind::kDark)) {
            const double t = temperature_of(series(i));
            const auto at = std::find_if(count.begin(), count.end(), [&](const auto& c) {
                return std::abs(c.first - t) <= kSameTemperature_k;
            });
            at == count.end() ? (void)count.emplace_back(t, 1) : (void)++at->second;
        }
        out_.temperature_c = std::max_element(count.begin(), count.end(), [](const auto& a, const auto& b) {
                                 return a.second < b.second;
                             })->first;
        for (const FrameSeries& s : frames_.series) {
            out_.temperature_told = out_.temperature_told || s.temperature_c.has_value();
            if (s.kind == SeriesKind::kFlat && s.temperature_c)
                for (const auto& [t, n] : count)
                    if (std::abs(t - *s.temperature_c) <= kSameTemperature_k) out_.temperature_c = t;
        }
        brief_ = reference_darks().front();
        if (!out_.temperature_told)
            out_.remarks.push_back(
                fmt::format("no temperature in the frames' names: {:g} C, as the camera's temperature_c",
                            out_.temperature_c));
    }

    // --- pairs

    TemporalStatistics pairs_of(std::size_t i, const PixelSelection& selection) const {
        PairSeries pairs(selection);
        DnImage a(frames_.width, frames_.height), b(frames_.width, frames_.height);
        for (std::size_t k = 0; k + 1 < series(i).frames; k += 2) {
            series(i).read(k, a), series(i).read(k + 1, b);
            pairs.add(a, b);
        }
        return pairs.result();
    }

    void measure_darks() {
        for (const std::size_t i : all_of(SeriesKind::kDark))
            out_.dark.push_back(
                {i, temperature_of(series(i)), {series(i).exposure_s, pairs_of(i, out_.good)}});
        told_(0.6);
        std::vector<DarkMean> means;
        for (const MeasuredDark& d : out_.dark)
            if (at_reference(series(d.series)))
                means.push_back(
                    {&series(d.series), d.point.dark.mean_dn.value, d.point.dark.mean_dn.uncertainty});
        double slowest = 1e300;
        for (const std::size_t i : all_of(SeriesKind::kFlat))
            slowest = std::min(
                slowest, (stacks_[i].mean_of(out_.good) - means.front().mean_dn) / series(i).exposure_s);
        if (slowest <= 0)
            throw InputError(frames_.name +
                             ": found flats that are as dark as the darks; accepted: flats of an "
                             "evenly lit surface");
        check_darkness(means, slowest, frames_.bits);
    }

    // Returns the statistics of the darks at an exposure, of the evenly lit pixels.
    TemporalStatistics dark_at(double exposure_s, const std::string& flat) {
        const std::vector<std::size_t> darks = reference_darks();
        const auto on_selection = [&](std::size_t i) -> const TemporalStatistics& {
            const auto found = lit_darks_.find(i);
            if (found != lit_darks_.end()) return found->second;
            return lit_darks_.emplace(i, pairs_of(i, lit_)).first->second;
        };
        for (const std::size_t i : darks)
            if (same_exposure(series(i).exposure_s, exposure_s)) return on_selection(i);
        std::size_t after = 1;
        while (after + 1 < darks.size() && series(darks[after]).exposure_s < exposure_s) ++after;
        if (darks.size() < 2) {
            if (!told_of_one_dark_)
                out_.remarks.push_back(
                    "darks of one exposure stand for all flats: dark current between the "
                    "exposures counts as light");
            told_of_one_dark_ = true;
            return on_selection(darks.front());
        }
        const double first_s = series(darks[after - 1]).exposure_s,
                     second_s = series(darks[after]).exposure_s;
        if (exposure_s > 1.05 * second_s)
            throw InputError(
                flat + ": found an exposure of " + fmt::format("{:g}", 1e3 * exposure_s) +
                " ms beyond that of the longest darks; accepted: darks whose exposures reach from "
                "the shortest flat's to the longest");
        return mixed(on_selection(darks[after - 1]), on_selection(darks[after]),
                     second_s > first_s ? (exposure_s - first_s) / (second_s - first_s) : 0);
    }

    // Corrects the variance of a dark for the rounding that noise below a step does not spread evenly.
    void straighten_rounding(TemporalStatistics& dark) const {
        const double before =
            variance_before_rounding_dn2(stacks_[brief_].mean, lit_, dark.variance_dn2.value);
        dark.variance_dn2.value = before + 1.0 / 12;
    }

    // --- light

    void measure_light() {
        lit_ = evenly_lit(frames_, stacks_, out_.good, like_);
        for (const std::size_t i : all_of(SeriesKind::kFlat)) {
            MeasuredLevel level;
            level.series = i;
            level.point.light = pairs_of(i, lit_);
            level.point.dark = dark_at(series(i).exposure_s, series(i).name);
            straighten_rounding(level.point.dark);
            level.point.photons = series(i).exposure_s * series(i).light;
            level.saturated = stacks_[i].numbers.ends > 1e-3;
            out_.light.push_back(level);
        }
        told_(0.8);
        std::sort(out_.light.begin(), out_.light.end(), [](const MeasuredLevel& a, const MeasuredLevel& b) {
            return a.point.signal_dn() < b.point.signal_dn();
        });
        find_saturation();
        find_out_light();
        measure_gain();
    }

    // Levels beyond that with the largest variance are saturated, if there the variance is well below it.
    void find_saturation() {
        std::vector<LightPoint> points = all_points();
        const std::size_t most = saturation_index(points);
        for (std::size_t i = most + 1; i < points.size(); ++i)
            if (points[i].light.variance_dn2.value < 0.7 * points[most].light.variance_dn2.value)
                out_.light[i].saturated = true;
        std::size_t usable = 0;
        for (const MeasuredLevel& level : out_.light) {
            if (!level.saturated) ++usable;
        }
        if (usable < 2)
            throw InputError(fmt::format(
                "{}: found {} of {} flats saturated; accepted: at least two below saturation (one beyond it "
                "tells the full well)",
                frames_.name, out_.light.size() - usable, out_.light.size()));
        const double end_dn = std::exp2(frames_.bits) - 1 - out_.light.front().point.dark.mean_dn.value;
        const bool reached = usable < out_.light.size();
        // Without a saturated flat, the converter's end is the only limit that is known.
        out_.saturation_dn = reached ? out_.light.back().point.signal_dn() : end_dn;
    }

    std::vector<LightPoint> all_points() const {
        std::vector<LightPoint> out;
        for (const MeasuredLevel& level : out_.light) out.push_back(level.point);
        return out;
    }
    std::vector<LightPoint> usable_points() const {
        std::vector<LightPoint> out;
        for (const MeasuredLevel& level : out_.light)
            if (!level.saturated) out.push_back(level.point);
        return out;
    }

    // Different signals at the same exposure and stated light: the light was changed, and nobody said how.
    void find_out_light() {
        out_.light_known = true;
        const std::vector<LightPoint> points = usable_points();
        for (std::size_t i = 1; i < points.size(); ++i)
            if (same_exposure(points[i].photons, points[i - 1].photons) &&
                points[i].signal_dn() > 1.02 * points[i - 1].signal_dn())
                out_.light_known = false;
        if (!out_.light_known)
            out_.remarks.push_back(
                "levels by light that is not stated (light: of the series): gain by the "
                "standard's straight line, no linearity");
    }

    void measure_gain() {
        const std::vector<LightPoint> points = usable_points();
        if (points.front().signal_dn() > 0.7 * out_.saturation_dn)
            throw InputError(
                frames_.name +
                ": found no flat below 70 % of saturation; accepted: levels from a twentieth on");
        out_.standard_gain_dn_e = photon_transfer(points, out_.saturation_dn).gain_dn_e;
        out_.gain_dn_e = out_.standard_gain_dn_e;
        const auto in_fit = std::count_if(points.begin(), points.end(), [&](const LightPoint& p) {
            return p.signal_dn() > 0.01 * out_.saturation_dn && p.signal_dn() < 0.95 * out_.saturation_dn;
        });
        if (out_.light_known && static_cast<std::size_t>(in_fit) >= kLevelsForBend) {
            response_.emplace(points, out_.saturation_dn);
            out_.gain_dn_e = small_signal_gain_dn_e(points, *response_, out_.saturation_dn);
            out_.linearity = linearity(response_points(points), out_.saturation_dn);
        } else if (out_.light_known) {
            out_.remarks.push_back(
                fmt::format("{} levels below saturation: gain by the standard's straight line; {} tell the "
                            "response's bend",
                            in_fit, kLevelsForBend));
        }
        if (!(out_.gain_dn_e.value > 0))
            throw InputError(frames_.name +
                             ": found flats whose noise does not grow with their signal; "
                             "accepted: flats as the camera makes them, each a frame of its own");
        for (MeasuredLevel& level : out_.light) {
            level.charge_e = charge(level.point.signal_dn()).value;
            if (!level.saturated)
                out_.full_well_at_least_e = std::max(out_.full_well_at_least_e, level.charge_e);
        }
        measure_full_well();
        if (response_) out_.nonlinearity = bend(*response_, out_.gain_dn_e, full_well_e());
    }
    Measured charge(double signal_dn) const {
        if (response_) return charge_e(*response_, out_.gain_dn_e, signal_dn);
        const double value = signal_dn / out_.gain_dn_e.value;
        return {value, value * out_.gain_dn_e.uncertainty / out_.gain_dn_e.value};
    }
    // A plateau below the converter's end is the full well.
    void measure_full_well() {
        const MeasuredLevel& top = out_.light.back();
        const double end_dn = std::exp2(frames_.bits) - 1;
        const bool plateau = top.saturated && stacks_[top.series].numbers.ends < 1e-3;
        if (plateau && top.point.light.mean_dn.value < end_dn - 1)
            // A full well holds its dark current, too: what is subtracted is the offset alone.
            out_.full_well_e =
                charge(top.point.light.mean_dn.value - dark_at(series(brief_).exposure_s, "").mean_dn.value);
        else
            out_.full_well_at_least_e =
                std::max(out_.full_well_at_least_e, top.saturated ? charge(top.point.signal_dn()).value : 0);
    }
    double full_well_e() const {
        if (out_.full_well_e) return out_.full_well_e->value;
        return std::max(like_.full_well_e, out_.full_well_at_least_e);
    }

    const FrameSet& frames_;
    const CameraModel& like_;
    const std::function<void(double)>& told_;
    std::vector<SeriesStack> stacks_;
    PixelFaults faults_;
    PixelSelection lit_;     // good pixels with the same light
    std::size_t brief_ = 0;  // the darks with the shortest exposure at the reference temperature
    std::map<std::size_t, TemporalStatistics> lit_darks_;
    bool told_of_one_dark_ = false;
    std::optional<ResponseCurve> response_;
    CloneMeasurement out_;
};

}  // namespace

CloneMeasurement measure_clone(const FrameSet& frames, const CameraModel& like,
                               const std::function<void(double)>& told) {
    return CloneLaboratory(frames, like, told).measure();
}

}  // namespace hilcam
