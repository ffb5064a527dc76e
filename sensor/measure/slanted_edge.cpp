#include "sensor/measure/slanted_edge.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>

#include "render/vocabulary/check.h"
#include "render/vocabulary/units.h"
#include "sensor/measure/least_squares.h"
#include "sensor/mtf.h"

namespace hilcam {
namespace {

constexpr int kBinsPerPixel = 8;
constexpr double kBin_px = 1.0 / kBinsPerPixel;
constexpr int kFrequencies = 64;  // steps up to 1 cycle/px

// The picture, transposed if necessary so that its edge is near the columns.
struct Upright {
    int width, height;
    std::vector<double> value;
    std::vector<std::uint8_t> use;
};

Upright upright(const EdgePicture& p, bool transpose) {
    Upright out{transpose ? p.height : p.width, transpose ? p.width : p.height, {}, {}};
    for (int y = 0; y < out.height; ++y)
        for (int x = 0; x < out.width; ++x) {
            const auto i = static_cast<std::size_t>(transpose ? x * p.width + y : y * p.width + x);
            out.value.push_back(p.value[i]);
            out.use.push_back(p.use[i]);
        }
    return out;
}

// The edge: x = offset + slope y [px, pixel centres at +0.5].
struct Line {
    double offset = 0, slope = 0;
    double at(double y) const { return offset + slope * y; }
};

// Returns the centroid of a row's derivative under a Hann window about `center` with the given half width;
// NaN when the row has no step there.
double edge_in_row(const Upright& p, int y, double center, double half_width) {
    double sum = 0, moment = 0, before = 0;
    int last = -1;
    for (int x = 0; x < p.width; ++x) {
        const auto i = static_cast<std::size_t>(y * p.width + x);
        if (!p.use[i]) continue;
        if (last >= 0) {
            const double place = 0.5 * (last + x) + 0.5;
            const double from = (place - center) / half_width;
            if (std::abs(from) < 1) {
                const double weighted = (p.value[i] - before) * (0.5 + 0.5 * std::cos(kPi * from));
                sum += weighted, moment += weighted * place;
            }
        }
        before = p.value[i], last = x;
    }
    return moment / sum;
}

Line find_edge(const Upright& p, double half_width) {
    Line line{0.5 * p.width, 0};
    // Narrows the window step by step about the previous line.
    for (const double reach :
         {1.0 * p.width, 0.5 * p.width, half_width, 0.5 * half_width, 0.5 * half_width}) {
        std::vector<double> y, x;
        for (int row = 0; row < p.height; ++row) {
            const double at = edge_in_row(p, row, line.at(row + 0.5), reach);
            if (std::isfinite(at) && at > 0 && at < p.width) y.push_back(row + 0.5), x.push_back(at);
        }
        if (y.size() < 16) throw InputError("slanted edge: no edge is seen");
        const std::vector<double> equal(y.size(), 1.0), none(y.size(), 0.0);
        const Fitted fit = fit_polynomial(y, x, equal, none, 1);
        line = {fit.coefficient[0], fit.coefficient[1]};
    }
    return line;
}

struct SpreadFunction {
    std::vector<double> value;  // mean over each bin, moved to the bin's centre
    std::vector<double> count;
    double first_px = 0;  // centre of the first bin
};

SpreadFunction spread_function(const Upright& p, const Line& line, double half_width) {
    const double slope = std::abs(line.slope);
    const double cosine = 1 / std::hypot(1.0, line.slope);
    // Uses whole cycles of two pixels if possible, for colour filters with that period.
    const double cycle = slope * p.height >= 2 ? 2 : 1;
    const double cycles = std::floor(slope * p.height / cycle);
    if (cycles < 1) throw InputError("slanted edge: too few rows for its angle");
    const int rows = static_cast<int>(std::lround(cycles * cycle / slope));
    const int top = (p.height - std::min(rows, p.height)) / 2;

    const int bins = 2 * static_cast<int>(half_width * kBinsPerPixel);
    SpreadFunction out;
    out.value.assign(static_cast<std::size_t>(bins), 0.0);
    out.count = out.value;
    out.first_px = (0.5 - bins / 2) * kBin_px;
    std::vector<double> place(out.value);
    for (int y = top; y < top + std::min(rows, p.height); ++y)
        for (int x = 0; x < p.width; ++x) {
            const auto i = static_cast<std::size_t>(y * p.width + x);
            if (!p.use[i]) continue;
            const double distance = (x + 0.5 - line.at(y + 0.5)) * cosine;
            const int bin = static_cast<int>(std::floor(distance * kBinsPerPixel)) + bins / 2;
            if (bin < 0 || bin >= bins) continue;
            const auto k = static_cast<std::size_t>(bin);
            out.value[k] += p.value[i], place[k] += distance, ++out.count[k];
        }
    const auto empty = static_cast<std::size_t>(std::count(out.count.begin(), out.count.end(), 0.0));
    if (empty > out.count.size() / 20)
        throw InputError(
            "slanted edge: too few pixels for its fine sampling, as of filters that are strips; accepted: a "
            "filter "
            "that has more of the window");
    std::vector<double> mean(out.value.size());
    for (std::size_t k = 0; k < mean.size(); ++k) {
        if (out.count[k] > 0)
            mean[k] = out.value[k] / out.count[k], place[k] /= out.count[k];
        else  // a bin without pixels takes its neighbour's value
            mean[k] = k > 0 ? mean[k - 1] : p.value[0],
            place[k] = out.first_px + kBin_px * static_cast<double>(k);
    }
    for (std::size_t k = 0; k < mean.size(); ++k) {
        const std::size_t before = k > 0 ? k - 1 : k, after = std::min(k + 1, mean.size() - 1);
        const double rise = (mean[after] - mean[before]) / std::max(place[after] - place[before], kBin_px);
        out.value[k] = mean[k] + rise * (out.first_px + kBin_px * static_cast<double>(k) - place[k]);
    }
    return out;
}

// Returns Tukey's window: 1 over the middle half, falling as a cosine to 0 at both ends.
double window(double from_middle) {
    const double a = std::abs(from_middle);
    return a < 0.5 ? 1 : a < 1 ? 0.5 + 0.5 * std::cos(2 * kPi * (a - 0.5)) : 0;
}

}  // namespace

EdgeMtf slanted_edge_mtf(const EdgePicture& picture, const SlantedEdgeOptions& options) {
    HILCAM_CHECK(picture.value.size() == picture.use.size() &&
                 picture.value.size() ==
                     static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height));
    // The direction with the larger gradient is across the edge.
    double across = 0, along = 0;
    for (int y = 0; y + 1 < picture.height; ++y)
        for (int x = 0; x + 1 < picture.width; ++x) {
            const auto i = static_cast<std::size_t>(y * picture.width + x);
            across += picture.value[i + 1] - picture.value[i];
            along += picture.value[i + static_cast<std::size_t>(picture.width)] - picture.value[i];
        }
    const bool transpose = std::abs(along) > std::abs(across);
    const Upright p = upright(picture, transpose);
    const Line line = find_edge(p, options.half_width_px);
    if (std::abs(line.slope) < std::tan(1 * kDegree_rad) || std::abs(line.slope) > 1)
        throw refused("slanted edge", "along a row or a column, or none", "1 to 45 degrees");
    const SpreadFunction esf = spread_function(p, line, options.half_width_px);

    const std::size_t steps = esf.value.size() - 1;
    std::vector<double> weight(steps), place(steps);
    double seen = 0;
    for (std::size_t k = 0; k < steps; ++k) {
        place[k] = esf.first_px + kBin_px * (static_cast<double>(k) + 0.5);
        weight[k] = window(place[k] / options.half_width_px);
        seen += weight[k] * (esf.value[k + 1] - esf.value[k]);
    }
    const double step = options.step != 0 ? options.step : seen;

    EdgeMtf out;
    const double tilt = std::atan(line.slope);
    out.normal_rad = transpose ? kPi / 2 + tilt : -tilt;
    for (int i = 0; i <= kFrequencies; ++i) {
        const double f = static_cast<double>(i) / kFrequencies;
        std::vector<std::complex<double>> wave(steps);
        std::complex<double> sum = 0;
        for (std::size_t k = 0; k < steps; ++k) {
            wave[k] = weight[k] * std::polar(1.0, -2 * kPi * f * place[k]);
            sum += wave[k] * (esf.value[k + 1] - esf.value[k]);
        }
        const double correction = std::abs(step) * sinc(f * kBin_px) * sinc(f * kBin_px);
        // Only noise in the direction of the sum changes its modulus.
        const std::complex<double> direction = std::abs(sum) > 0 ? std::conj(sum) / std::abs(sum) : 1.0;
        double variance = 0;
        for (std::size_t k = 0; k <= steps; ++k) {
            const std::complex<double> factor =
                (k > 0 ? wave[k - 1] : 0.0) - (k < steps ? wave[k] : std::complex<double>(0.0));
            const double part = std::real(factor * direction);
            variance += part * part * picture.noise * picture.noise / std::max(esf.count[k], 1.0);
        }
        out.frequency_cy_px.push_back(f);
        out.mtf.push_back(std::abs(sum) / correction);
        out.uncertainty.push_back(std::sqrt(variance) / correction);
    }
    return out;
}

}  // namespace hilcam
