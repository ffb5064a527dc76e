#include "emulator/clone/image_lag.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

#include "render/vocabulary/check.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

constexpr std::size_t kDarks = 12, kShown = 5;
// A dark frame with more than this part of the bright ones was still lit when its exposure began.
constexpr double kPartlyLit = 0.1;
constexpr std::size_t kMostPartlyLit = 2;
constexpr double kWorstScatter = 0.02;  // scatter of the dark frames, as a part of the bright ones

struct Decay {
    std::vector<double> left;
    double scatter = 0;
    std::size_t passed_over = 0;
};

// bright: mean of the frame before; darks: those after it.
Decay decay(double bright, std::span<const double> darks, const std::string& name) {
    const std::span<const double> base = darks.last(darks.size() / 3);
    double mean = 0, sum = 0;
    const auto n = static_cast<double>(base.size());
    for (const double value : base) mean += value / n;
    for (const double value : base) sum += square(value - mean);
    Decay out;
    out.scatter = std::sqrt(sum / (n - 1) * (1 + 1 / n)) / (bright - mean);
    if (!(out.scatter < kWorstScatter)) return out;
    const auto part = [&](std::size_t i) { return (darks[i] - mean) / (bright - mean); };
    while (out.passed_over < darks.size() && part(out.passed_over) > kPartlyLit) ++out.passed_over;
    if (out.passed_over > kMostPartlyLit)
        throw InputError(
            fmt::format("{}: found {} frames between bright and dark; accepted: at most {}: switch the "
                        "light off within a frame",
                        name, out.passed_over, kMostPartlyLit));
    for (std::size_t k = 0; k < kShown; ++k) out.left.push_back(part(out.passed_over + k));
    return out;
}

}  // namespace

ImageLag image_lag(std::span<const double> means, const std::string& name) {
    std::vector<Decay> decays;
    if (!means.empty()) {
        const auto [least, most] = std::minmax_element(means.begin(), means.end());
        const double half = 0.5 * (*least + *most);
        for (std::size_t i = 1; i < means.size(); ++i) {
            if (!(means[i - 1] > half && means[i] <= half)) continue;
            // The frame in which the light went off may come first: the bright one is before it.
            std::size_t end = i;
            while (end < means.size() && means[end] <= half) ++end;
            const double bright = i >= 2 && means[i - 2] > means[i - 1] ? means[i - 2] : means[i - 1];
            if (end - i < kDarks) continue;
            const Decay one = decay(bright, means.subspan(i, end - i), name);
            // Noise of dark frames has such steps, too.
            if (!one.left.empty()) decays.push_back(one);
        }
    }
    if (decays.empty())
        throw InputError(
            fmt::format("{}: found no bright frame with {} dark ones after it; accepted: frames in the "
                        "order of their taking, first of an evenly lit surface, then without light",
                        name, kDarks));
    ImageLag out;
    const auto n = static_cast<double>(decays.size());
    for (std::size_t k = 0; k < kShown; ++k) {
        Measured one;
        for (const Decay& d : decays) one.value += d.left[k] / n, one.uncertainty += square(d.scatter / n);
        one.uncertainty = std::sqrt(one.uncertainty);
        out.left.push_back(one);
    }
    for (const Decay& d : decays) out.passed_over = std::max(out.passed_over, d.passed_over);
    return out;
}

}  // namespace hilcam
