#include "sensor/measure/frame_statistics.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "render/vocabulary/units.h"
#include "sensor/measure/least_squares.h"

namespace hilcam {
namespace {

// Returns a row of the selection's rectangle.
std::span<const std::uint16_t> row_of(const DnImage& frame, const PixelSelection& s, int y) {
    return frame.row(s.top + y).subspan(static_cast<std::size_t>(s.left), static_cast<std::size_t>(s.width));
}
std::span<const std::uint8_t> use_of(const PixelSelection& s, int y) {
    return std::span(s.use).subspan(static_cast<std::size_t>(y) * static_cast<std::size_t>(s.width),
                                    static_cast<std::size_t>(s.width));
}

// Returns the variance that is common to a line, from the differences' mean in each: the means also vary with
// the remaining noise of the line's pixels.
double common_variance_dn2(std::span<const double> means, double mean, double pixels_of_line,
                           double variance_dn2) {
    double between = 0;
    for (const double value : means) between += square(value - mean);
    const double of_means = 0.5 * between / (static_cast<double>(means.size()) - 1);
    return (of_means - variance_dn2 / pixels_of_line) / (1 - 1 / pixels_of_line);
}

}  // namespace

std::size_t PixelSelection::count() const {
    return static_cast<std::size_t>(std::accumulate(use.begin(), use.end(), std::size_t{0}));
}

void PairSeries::add(const DnImage& a, const DnImage& b) {
    // Sums of whole numbers are exact in any order.
    std::int64_t sum = 0, difference = 0, squares = 0, pixels = 0;
    std::vector<double> row_means, column_means;
    double pixels_of_row = 0;
    std::vector<std::int64_t> column_sum(static_cast<std::size_t>(selection_.width)),
        column_pixels(static_cast<std::size_t>(selection_.width));
    for (int y = 0; y < selection_.height; ++y) {
        const auto use = use_of(selection_, y);
        const auto row_a = row_of(a, selection_, y), row_b = row_of(b, selection_, y);
        std::int64_t row_difference = 0, row_pixels = 0;
        for (std::size_t x = 0; x < use.size(); ++x) {
            if (!use[x]) continue;
            const std::int64_t d = std::int64_t{row_a[x]} - std::int64_t{row_b[x]};
            sum += std::int64_t{row_a[x]} + std::int64_t{row_b[x]};
            row_difference += d;
            column_sum[x] += d, ++column_pixels[x];
            squares += d * d;
            ++row_pixels;
        }
        difference += row_difference;
        pixels += row_pixels;
        if (row_pixels == 0) continue;
        row_means.push_back(static_cast<double>(row_difference) / static_cast<double>(row_pixels));
        pixels_of_row += static_cast<double>(row_pixels);
    }
    HILCAM_CHECK(pixels > 1);
    const auto n = static_cast<double>(pixels);
    const double mean_difference = static_cast<double>(difference) / n;
    const double variance = 0.5 * static_cast<double>(squares) / n;
    sum_ += static_cast<double>(sum) / (2 * n);
    square_ += variance;
    frame_ += 0.5 * square(mean_difference);
    if (row_means.size() > 1)
        row_ += common_variance_dn2(row_means, mean_difference,
                                    pixels_of_row / static_cast<double>(row_means.size()), variance);
    for (std::size_t x = 0; x < column_sum.size(); ++x)
        if (column_pixels[x] > 0)
            column_means.push_back(static_cast<double>(column_sum[x]) /
                                   static_cast<double>(column_pixels[x]));
    if (column_means.size() > 1)
        column_ += common_variance_dn2(column_means, mean_difference,
                                       n / static_cast<double>(column_means.size()), variance);
    ++pairs_;
}

TemporalStatistics PairSeries::result() const {
    HILCAM_CHECK(pairs_ > 0);
    const double pairs = pairs_;
    const auto pixels = static_cast<double>(selection_.count());
    TemporalStatistics out;
    out.pairs = pairs_;
    const double variance = square_ / pairs;
    // The uncertainties assume white noise: row noise that chance alone can produce is left out.
    const double rows = selection_.height;
    const double chance = variance / (pixels / rows) * std::sqrt(2 / (rows * pairs));
    out.row_dn2 = row_ / pairs > 4 * chance ? row_ / pairs : 0;
    // The frame's mean also varies by chance.
    const double of_frame = frame_ / pairs - (variance / pixels + out.row_dn2 / rows);
    out.frame_dn2 =
        of_frame > 3 * std::sqrt(2 / pairs) * (variance / pixels + out.row_dn2 / rows) ? of_frame : 0;
    const double columns = selection_.width;
    const double chance_of_column = variance / (pixels / columns) * std::sqrt(2 / (columns * pairs));
    out.column_dn2 = column_ / pairs > 4 * chance_of_column ? column_ / pairs : 0;
    const double white = variance - out.row_dn2 - out.frame_dn2;
    out.mean_dn = {sum_ / pairs,
                   std::sqrt((white / pixels + out.row_dn2 / rows + out.frame_dn2) / (2 * pairs))};
    // The error of a variance s^2 of n independent Gaussian values is s^2 sqrt(2 / n).
    out.variance_dn2 = {variance, std::sqrt(2 / pairs *
                                            (square(white) / pixels + square(out.row_dn2) / rows +
                                             square(out.frame_dn2) + 2 * white * out.row_dn2 / pixels))};
    return out;
}

double line_variance_uncertainty_dn2(const TemporalStatistics& s, double line_dn2, double lines,
                                     double line_pixels) {
    return (line_dn2 + s.pixel_dn2() / line_pixels) * std::sqrt(2 / (lines * s.pairs));
}

FrameStack::FrameStack(const PixelSelection& s)
    : left_(s.left),
      top_(s.top),
      width_(s.width),
      height_(s.height),
      sum_(s.use.size(), 0.0),
      square_(s.use.size(), 0.0) {}

void FrameStack::add(const DnImage& frame) {
    std::size_t i = 0;
    for (int y = 0; y < height_; ++y) {
        const auto row = frame.row(top_ + y).subspan(static_cast<std::size_t>(left_));
        for (std::size_t x = 0; x < static_cast<std::size_t>(width_); ++x, ++i) {
            const double value = row[x];
            sum_[i] += value;
            square_[i] += value * value;
        }
    }
    ++frames_;
}

std::vector<double> FrameStack::mean_dn() const {
    HILCAM_CHECK(frames_ > 0);
    std::vector<double> out(sum_);
    for (double& value : out) value /= frames_;
    return out;
}

std::vector<double> FrameStack::temporal_variance_dn2() const {
    HILCAM_CHECK(frames_ > 1);
    std::vector<double> out(sum_.size());
    for (std::size_t i = 0; i < out.size(); ++i)
        out[i] = (square_[i] - square(sum_[i]) / frames_) / (frames_ - 1);
    return out;
}

SpatialParts spatial_parts(std::span<const double> image, const PixelSelection& s) {
    const auto width = static_cast<std::size_t>(s.width), height = static_cast<std::size_t>(s.height);
    HILCAM_CHECK(image.size() == width * height);
    std::vector<double> row_sum(height, 0.0), row_count(height, 0.0), column_sum(width, 0.0),
        column_count(width, 0.0);
    double sum = 0;
    for (std::size_t y = 0; y < height; ++y)
        for (std::size_t x = 0; x < width; ++x) {
            if (!s.use[y * width + x]) continue;
            const double value = image[y * width + x];
            sum += value;
            row_sum[y] += value, ++row_count[y];
            column_sum[x] += value, ++column_count[x];
        }
    SpatialParts out;
    out.pixels = std::accumulate(row_count.begin(), row_count.end(), 0.0);
    HILCAM_CHECK(out.pixels > 1);
    const double mean = sum / out.pixels;
    for (std::size_t i = 0; i < image.size(); ++i)
        if (s.use[i]) out.total += square(image[i] - mean) / (out.pixels - 1);
    const auto between = [&](const std::vector<double>& sums, const std::vector<double>& counts,
                             double& groups) {
        double variance = 0;
        for (std::size_t i = 0; i < sums.size(); ++i)
            if (counts[i] > 0) variance += square(sums[i] / counts[i] - mean), ++groups;
        return groups > 1 ? variance / (groups - 1) : 0;
    };
    const double of_rows = between(row_sum, row_count, out.rows);
    const double of_columns = between(column_sum, column_count, out.columns);
    // Means of rows vary by s^2_row + s^2_pixel / N, those of columns by s^2_col + s^2_pixel / M, and all
    // pixels by the sum of the three. Solved for these three, this is the standard's set of equations.
    const double n = out.pixels / out.rows, m = out.pixels / out.columns;
    out.pixel = (out.total - of_rows - of_columns) / (1 - 1 / n - 1 / m);
    out.row = of_rows - out.pixel / n;
    out.column = of_columns - out.pixel / m;
    return out;
}

std::vector<double> smooth_surface(std::span<const double> image, const PixelSelection& s, int order) {
    // Means of blocks are enough to fit the shape. With few blocks, the shape is determined badly.
    constexpr int kBlock_px = 16;
    const int order_x = std::min(order, (s.width - 1) / kBlock_px);
    const int order_y = std::min(order, (s.height - 1) / kBlock_px);
    const auto terms = [&](double x, double y, std::vector<double>& out) {
        for (int j = 0; j <= order_y; ++j)
            for (int i = 0; i <= std::min(order_x, order - j); ++i)
                out.push_back(std::legendre(static_cast<unsigned>(i), x) *
                              std::legendre(static_cast<unsigned>(j), y));
    };
    std::vector<double> basis, mean, weight;
    for (int top = 0; top < s.height; top += kBlock_px)
        for (int left = 0; left < s.width; left += kBlock_px) {
            double sum = 0, count = 0, sum_x = 0, sum_y = 0;
            for (int y = top; y < std::min(top + kBlock_px, s.height); ++y)
                for (int x = left; x < std::min(left + kBlock_px, s.width); ++x) {
                    const auto i = static_cast<std::size_t>(y) * static_cast<std::size_t>(s.width) +
                                   static_cast<std::size_t>(x);
                    if (!s.use[i]) continue;
                    sum += image[i], ++count, sum_x += x, sum_y += y;
                }
            if (count == 0) continue;
            terms(2 * sum_x / count / std::max(1, s.width - 1) - 1,
                  s.height > 1 ? 2 * sum_y / count / (s.height - 1) - 1 : 0, basis);
            mean.push_back(sum / count);
            weight.push_back(count);
        }
    const Fitted fit = fit_linear(basis, mean, weight, std::vector<double>(mean.size(), 0.0));
    // Tables of the polynomials along each axis.
    const auto table = [&](int size) {
        std::vector<double> out;
        for (int i = 0; i < size; ++i)
            for (int k = 0; k <= order; ++k)
                out.push_back(
                    std::legendre(static_cast<unsigned>(k), size > 1 ? 2.0 * i / (size - 1) - 1 : 0));
        return out;
    };
    const std::vector<double> along_x = table(s.width), along_y = table(s.height);
    const auto step = static_cast<std::size_t>(order) + 1;
    std::vector<double> out;
    out.reserve(image.size());
    for (std::size_t y = 0; y < static_cast<std::size_t>(s.height); ++y)
        for (std::size_t x = 0; x < static_cast<std::size_t>(s.width); ++x) {
            double value = 0;
            auto c = fit.coefficient.begin();
            for (int j = 0; j <= order_y; ++j)
                for (int i = 0; i <= std::min(order_x, order - j); ++i)
                    value += *c++ * along_x[x * step + static_cast<std::size_t>(i)] *
                             along_y[y * step + static_cast<std::size_t>(j)];
            out.push_back(value);
        }
    return out;
}

std::size_t exclude_outliers(std::span<const double> image, double sigmas, PixelSelection& s, double least) {
    std::vector<double> values;
    for (std::size_t i = 0; i < image.size(); ++i)
        if (s.use[i]) values.push_back(image[i]);
    if (values.empty()) return 0;
    const auto median = [&] {
        const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
        std::nth_element(values.begin(), middle, values.end());
        return *middle;
    };
    const double center = median();
    for (double& value : values) value = std::abs(value - center);
    const double reach = sigmas * std::max(1.4826 * median(), least);
    std::size_t out = 0;
    for (std::size_t i = 0; i < image.size(); ++i)
        if (s.use[i] && std::abs(image[i] - center) > reach) s.use[i] = 0, ++out;
    return out;
}

NoiseSums noise_sums(const DnImage& a, const DnImage& b, const PixelSelection& s, NoiseReach reach) {
    const auto width = static_cast<std::size_t>(s.width);
    std::vector<double> difference(s.use.size(), 0.0);
    for (int y = 0; y < s.height; ++y) {
        const auto use = use_of(s, y);
        const auto row_a = row_of(a, s, y), row_b = row_of(b, s, y);
        double* row = difference.data() + static_cast<std::size_t>(y) * width;
        double sum = 0, pixels = 0;
        for (std::size_t x = 0; x < width; ++x)
            if (use[x])
                row[x] = static_cast<double>(row_a[x]) - static_cast<double>(row_b[x]), sum += row[x],
                ++pixels;
        // Removes noise that is common to the row, which the filter does not cause.
        for (std::size_t x = 0; x < width; ++x)
            if (use[x]) row[x] -= sum / pixels;
    }
    const auto covariance = [&](int dx, int dy) {
        double sum = 0, count = 0;
        for (int y = 0; y + dy < s.height; ++y)
            for (int x = std::max(0, -dx); x < std::min(s.width, s.width - dx); ++x) {
                const auto i = static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x);
                const auto j = i + static_cast<std::size_t>(dy) * width + static_cast<std::size_t>(dx);
                if (s.use[i] && s.use[j]) sum += difference[i] * difference[j], ++count;
            }
        return count > 0 ? sum / count : 0;
    };
    const double variance = covariance(0, 0);
    double total = variance;
    for (int dx = 1; dx <= reach.columns; ++dx) total += 2 * covariance(dx, 0);
    for (int dy = 1; dy <= reach.rows; ++dy)
        for (int dx = -reach.columns; dx <= reach.columns; ++dx) total += 2 * covariance(dx, dy);
    // The row's mean, which was subtracted, contains 1/width of the sum, and is missing from each of 2
    // columns + 1 terms.
    return {variance, total / (1 - (2.0 * reach.columns + 1) / s.width)};
}

}  // namespace hilcam
