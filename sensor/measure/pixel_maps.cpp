#include "sensor/measure/pixel_maps.h"

#include <algorithm>
#include <cmath>

#include "render/vocabulary/check.h"
#include "render/vocabulary/units.h"

namespace hilcam {

LineWeights line_weights(std::span<const double> time_s, std::span<const double> variance_dn2) {
    HILCAM_CHECK(time_s.size() == variance_dn2.size());
    double one = 0, time = 0, square_time = 0;
    for (std::size_t i = 0; i < time_s.size(); ++i) {
        const double weight = 1 / variance_dn2[i];
        one += weight, time += weight * time_s[i], square_time += weight * square(time_s[i]);
    }
    const double determinant = one * square_time - square(time);
    HILCAM_CHECK(determinant > 1e-12 * one * square_time);
    LineWeights out;
    for (std::size_t i = 0; i < time_s.size(); ++i) {
        const double weight = 1 / variance_dn2[i];
        out.offset.push_back(weight * (square_time - time * time_s[i]) / determinant);
        out.rate.push_back(weight * (one * time_s[i] - time) / determinant);
    }
    out.offset_variance = square_time / determinant;
    out.rate_variance = one / determinant;
    out.covariance = -time / determinant;
    return out;
}

double MapSpread::pixel() const { return std::max(0.0, measured.pixel - noise); }

double MapSpread::correlation() const {
    const double all = std::max(0.0, measured.row) + std::max(0.0, measured.column) + measured.pixel;
    const double errors = noise + row_noise;
    return all > errors ? std::sqrt((all - errors) / all) : 0;
}

MapSpread map_spread(std::span<const double> map, const PixelSelection& selection, double noise,
                     double row_noise) {
    return {spatial_parts(map, selection), noise, row_noise};
}

std::vector<double> with_true_spread(std::span<const double> map, const PixelSelection& s,
                                     const MapSpread& spread) {
    const auto width = static_cast<std::size_t>(s.width), height = static_cast<std::size_t>(s.height);
    HILCAM_CHECK(map.size() == width * height);
    std::vector<double> row_sum(height, 0.0), row_count(height, 0.0), column_sum(width, 0.0),
        column_count(width, 0.0);
    double sum = 0, count = 0;
    for (std::size_t y = 0; y < height; ++y)
        for (std::size_t x = 0; x < width; ++x) {
            const std::size_t i = y * width + x;
            if (!s.use[i]) continue;
            row_sum[y] += map[i], ++row_count[y];
            column_sum[x] += map[i], ++column_count[x];
            sum += map[i], ++count;
        }
    const double mean = sum / std::max(count, 1.0);
    const auto part = [](double true_variance, double measured) {
        return measured > 0 ? std::sqrt(std::clamp(true_variance / measured, 0.0, 1.0)) : 0.0;
    };
    const SpatialParts& m = spread.measured;
    // Means of rows and columns also vary by their share of the pixels' scatter.
    const double of_rows = m.row + m.pixel / std::max(1.0, m.pixels / std::max(1.0, m.rows));
    const double of_columns = m.column + m.pixel / std::max(1.0, m.pixels / std::max(1.0, m.columns));
    const double share_pixel = part(spread.pixel(), m.pixel),
                 share_row = part(std::max(0.0, m.row - spread.row_noise), of_rows),
                 share_column = part(std::max(0.0, m.column), of_columns);
    const auto deviation = [mean](double total, double number) {
        return number > 0 ? total / number - mean : 0;
    };
    std::vector<double> out(map.begin(), map.end());
    for (std::size_t y = 0; y < height; ++y)
        for (std::size_t x = 0; x < width; ++x) {
            const std::size_t i = y * width + x;
            if (!s.use[i]) continue;
            const double row = deviation(row_sum[y], row_count[y]),
                         column = deviation(column_sum[x], column_count[x]);
            out[i] =
                mean + share_row * row + share_column * column + share_pixel * (map[i] - mean - row - column);
        }
    return out;
}

TwoStates two_states(std::span<const double> value_dn, double sigma_dn) {
    HILCAM_CHECK(value_dn.size() > 1 && sigma_dn > 0);
    const auto [least, most] = std::minmax_element(value_dn.begin(), value_dn.end());
    double low = *least, high = *most, share = 0.5;
    std::vector<double> is_high(value_dn.size());
    double highs = 0, lows = 0;
    for (int step = 0; step < 100; ++step) {
        double sum_high = 0, sum_low = 0;
        highs = lows = 0;
        for (std::size_t i = 0; i < value_dn.size(); ++i) {
            // The odds of the two states, as a logistic function of the value.
            const double odds =
                ((square(value_dn[i] - high) - square(value_dn[i] - low)) / (2 * square(sigma_dn))) +
                std::log((1 - share) / share);
            is_high[i] = 1 / (1 + std::exp(std::clamp(odds, -700.0, 700.0)));
            highs += is_high[i], sum_high += is_high[i] * value_dn[i];
            lows += 1 - is_high[i], sum_low += (1 - is_high[i]) * value_dn[i];
        }
        if (highs < 0.5 || lows < 0.5) break;
        high = sum_high / highs, low = sum_low / lows;
        share = std::clamp(highs / (highs + lows), 0.01, 0.99);
    }
    TwoStates out{low, high, sigma_dn * std::sqrt(1 / std::max(highs, 1.0) + 1 / std::max(lows, 1.0)), 0};
    for (std::size_t i = 1; i < is_high.size(); ++i)
        out.changes += (is_high[i] > 0.5) != (is_high[i - 1] > 0.5) ? 1 : 0;
    return out;
}

}  // namespace hilcam
