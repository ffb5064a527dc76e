#include "emulator/clone/series_stack.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "render/vocabulary/check.h"
#include "sensor/mosaic.h"

namespace hilcam {
namespace {

// `hilcam characterise` has the same limit: a share of 2e-9 of good pixels is beyond it.
constexpr double kFaultSigmas = 6;

std::vector<double> less_by(std::vector<double> a, const std::vector<double>& b) {
    std::transform(a.begin(), a.end(), b.begin(), a.begin(), std::minus<>());
    return a;
}

// The differences of a picture's pixels from a smooth surface, without those that are far larger than others.
struct Outliers {
    std::vector<double> deviation;
    PixelSelection rest;  // the selection without them
    double reach = 0;     // the smallest deviation that is one
};
Outliers outliers_of(const std::vector<double>& image, const PixelSelection& among, double least) {
    Outliers out{less_by(image, smooth_surface(image, among, 3)), among, 0};
    exclude_outliers(out.deviation, kFaultSigmas, out.rest, least);
    // Once more: outliers have bent the surface.
    out.deviation = less_by(image, smooth_surface(image, out.rest, 3));
    out.rest = among;
    exclude_outliers(out.deviation, kFaultSigmas, out.rest, least);
    double most = 0;
    for (std::size_t i = 0; i < among.use.size(); ++i)
        if (out.rest.use[i]) most = std::max(most, std::abs(out.deviation[i]));
    out.reach = most;
    return out;
}

}  // namespace

double SeriesStack::mean_of(const PixelSelection& selection) const {
    double sum = 0, count = 0;
    for (std::size_t i = 0; i < mean.size(); ++i)
        if (selection.use[i]) sum += mean[i], ++count;
    return sum / std::max(count, 1.0);
}

std::vector<SeriesStack> stack_series(const FrameSet& set, const PixelSelection& whole,
                                      std::size_t with_variance, const std::function<void(double)>& told) {
    std::size_t all = 0, done = 0;
    for (const FrameSeries& s : set.series) all += s.frames;
    std::vector<SeriesStack> out;
    DnImage frame(set.width, set.height);
    for (std::size_t i = 0; i < set.series.size(); ++i) {
        FrameStack stack(whole);
        NumberSurvey survey(set.bits);
        for (std::size_t k = 0; k < set.series[i].frames; ++k) {
            set.series[i].read(k, frame);
            stack.add(frame), survey.add(frame);
            told(static_cast<double>(++done) / static_cast<double>(all));
        }
        out.push_back({stack.mean_dn(), {}, survey.facts()});
        if (i == with_variance) out.back().variance = stack.temporal_variance_dn2();
    }
    return out;
}

std::vector<PixelSelection> color_planes(const CameraModel& like, int width, int height) {
    const Mosaic mosaic(like);
    PixelSelection none(0, 0, width, height);
    std::fill(none.use.begin(), none.use.end(), std::uint8_t{0});
    std::vector<PixelSelection> out(std::max<std::size_t>(like.color_filter.filters.size(), 1), none);
    std::size_t i = 0;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x, ++i) out[static_cast<std::size_t>(mosaic.channel(x, y))].use[i] = 1;
    std::erase_if(out, [](const PixelSelection& s) { return s.count() == 0; });
    return out;
}

PixelSelection both(PixelSelection a, const PixelSelection& b) {
    for (std::size_t i = 0; i < a.use.size(); ++i) a.use[i] = a.use[i] && b.use[i] ? 1 : 0;
    return a;
}

PixelSelection largest_plane(const PixelSelection& good, const CameraModel& like) {
    PixelSelection out;
    for (const PixelSelection& plane : color_planes(like, good.width, good.height))
        if (PixelSelection these = both(good, plane); out.use.empty() || these.count() > out.count())
            out = std::move(these);
    return out;
}

std::size_t middle_flat(const FrameSet& set, std::span<const SeriesStack> stacks) {
    const PixelSelection whole(0, 0, set.width, set.height);
    std::vector<std::pair<double, std::size_t>> flats;
    for (std::size_t i = 0; i < set.series.size(); ++i)
        if (set.series[i].kind == SeriesKind::kFlat && stacks[i].numbers.ends < 1e-3)
            flats.emplace_back(stacks[i].mean_of(whole), i);
    if (flats.empty())
        throw InputError(set.name +
                         ": found saturated flats only; accepted: at least two levels below saturation");
    std::sort(flats.begin(), flats.end());
    return flats[flats.size() / 2].second;
}

PixelFaults find_faults(const FrameSet& set, std::span<const SeriesStack> stacks,
                        std::span<const std::size_t> darks, const CameraModel& like) {
    const PixelSelection whole(0, 0, set.width, set.height);
    const SeriesStack& brief = stacks[darks.front()];
    PixelFaults out;
    out.noisy.assign(whole.use.size(), 0), out.hot = out.weak = out.noisy;
    // Steps that rounding can make between pixels that are the same.
    constexpr double kLeastMean_dn = 0.05, kLeastNoise = 0.04, kLeastGain = 1e-4;
    out.good = outliers_of(brief.mean, whole, kLeastMean_dn).rest;

    // The cube root of a chi-square variate is Gaussian (Wilson & Hilferty, PNAS 17, 1931).
    std::vector<double> noise = brief.variance;
    for (double& value : noise) value = std::cbrt(value);
    const Outliers noisy = outliers_of(noise, whole, kLeastNoise);
    for (std::size_t i = 0; i < noise.size(); ++i)
        out.noisy[i] = !noisy.rest.use[i] && noisy.deviation[i] > 0 ? 1 : 0;
    out.good = both(out.good, noisy.rest);

    const double time_s = set.series[darks.back()].exposure_s - set.series[darks.front()].exposure_s;
    if (time_s > 0) {
        const Outliers warm =
            outliers_of(less_by(stacks[darks.back()].mean, brief.mean), whole, kLeastMean_dn);
        for (std::size_t i = 0; i < noise.size(); ++i)
            out.hot[i] = !warm.rest.use[i] && warm.deviation[i] > 0 ? 1 : 0;
        out.hot_limit_dn_s = warm.reach / time_s;
        out.good = both(out.good, warm.rest);
    }

    std::vector<double> response = less_by(stacks[middle_flat(set, stacks)].mean, brief.mean);
    for (const PixelSelection& plane : color_planes(like, set.width, set.height)) {
        const std::vector<double> surface = smooth_surface(response, both(out.good, plane), 3);
        for (std::size_t i = 0; i < response.size(); ++i)
            if (plane.use[i]) response[i] = surface[i] > 0 ? response[i] / surface[i] : 0;
    }
    const Outliers gain = outliers_of(response, whole, kLeastGain);
    for (std::size_t i = 0; i < response.size(); ++i) out.weak[i] = response[i] < 0.5 ? 1 : 0;
    out.good = both(out.good, gain.rest);
    if (out.good.count() < whole.use.size() / 2)
        throw InputError(set.name +
                         ": found more than half of the pixels unlike the others; accepted: flats of "
                         "an evenly lit surface without shadows, and darks of the same camera");
    return out;
}

PixelSelection evenly_lit(const FrameSet& set, std::span<const SeriesStack> stacks,
                          const PixelSelection& good, const CameraModel& like) {
    const PixelSelection plane = largest_plane(good, like);
    const std::vector<double> light = smooth_surface(stacks[middle_flat(set, stacks)].mean, plane, 4);
    double most = 0;
    for (std::size_t i = 0; i < light.size(); ++i)
        if (plane.use[i]) most = std::max(most, light[i]);
    PixelSelection out = plane;
    for (std::size_t i = 0; i < light.size(); ++i)
        out.use[i] = plane.use[i] && light[i] >= 0.97 * most ? 1 : 0;
    return 10 * out.count() < plane.count() ? plane : out;
}

}  // namespace hilcam
