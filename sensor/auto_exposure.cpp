#include "sensor/auto_exposure.h"

#include <algorithm>
#include <cmath>

#include "sensor/camera_model.h"

namespace hilcam {

Fields fields(AutoExposureConfig& c) {
    return {
        flag("on", c.on, "true: the camera sets its own exposure time"),
        number("target_fraction", c.target_fraction, 1, {0.01, 0.95},
               "target of the percentile, as a share of full scale"),
        number("percentile", c.percentile, 1, {1, 99.99},
               "percentile of the frame's pixels that is compared with the target"),
        number("speed", c.speed, 1, {0.01, 1},
               "share of the remaining distance, in stops, covered in one frame"),
        number("tolerance_stops", c.tolerance_stops, 1, {0, 2},
               "largest distance from the target at which the exposure stays unchanged"),
    };
}

double next_exposure_s(const AutoExposureConfig& c, Brightness seen, double present_s,
                       const ExposureLimits& limits) {
    // Treats black as a ten-thousandth of full scale, so that the exposure grows by a bounded step.
    constexpr double kDarkest = 1e-4;
    const double missing_stops = std::log2(c.target_fraction / std::max(seen.fraction, kDarkest));
    double stops = c.speed * missing_stops;
    if (seen.saturated)
        stops = std::min(stops, -1.0);
    else if (std::abs(missing_stops) <= c.tolerance_stops)
        stops = 0;
    return std::clamp(present_s * std::exp2(stops), limits.min_s, limits.max_s);
}

DnScale dn_scale_of(const CameraModel& c, const Exposure& exposure) {
    const auto [binning_x, binning_y] = binning_of(c, exposure);
    const auto pixels = static_cast<double>(binning_x * binning_y);
    const double well_e = c.read_e(c.full_well_e) * (c.binning == BinningKind::kCharge ? pixels : 1);
    DnScale scale;
    scale.max_dn = std::exp2(static_cast<double>(c.bits)) - 1;
    scale.black_dn = exposure.black_level_dn.value_or(c.offset_dn);
    scale.full_dn = std::min(scale.max_dn, scale.black_dn + well_e * c.system_gain_dn_e(exposure.gain_db));
    if (c.binning == BinningKind::kSum) {
        scale.max_dn = std::exp2(c.number_bits()) - 1;
        scale.black_dn = std::min(pixels * scale.black_dn, scale.max_dn - 1);
        scale.full_dn = std::min(pixels * scale.full_dn, scale.max_dn);
    }
    scale.square_root = c.converter.companding == Companding::kSquareRoot;
    if (c.converter.companding == Companding::kTable) scale.companding = &c.converter.companding_table;
    return scale;
}

namespace {

// Returns the mean number for a code; codes in the table never fall.
double number_of_code(const Table& table, double code) {
    const auto at = [&](double wanted, bool last) {
        double found = last ? table.x.back() : table.x.front();
        for (std::size_t i = 0; i + 1 < table.x.size(); ++i) {
            const double low = table.y[i], high = table.y[i + 1];
            if (high == low || wanted < low || wanted > high) continue;
            found = table.x[i] + (wanted - low) / (high - low) * (table.x[i + 1] - table.x[i]);
            if (!last) break;
        }
        return found;
    };
    if (code <= table.y.front()) return table.x.front();
    if (code >= table.y.back()) return table.x.back();
    return 0.5 * (at(code, false) + at(code, true));
}

}  // namespace

Brightness FrameHistogram::measure(const DnImage& frame, int black_columns, int black_rows, double percentile,
                                   const DnScale& scale) {
    std::fill(counts_.begin(), counts_.end(), 0u);
    for (int y = black_rows; y < frame.height(); ++y)
        for (const std::uint16_t dn : frame.row(y).subspan(static_cast<std::size_t>(black_columns)))
            ++counts_[std::min<std::size_t>(dn, counts_.size() - 1)];
    const double pixels = static_cast<double>(frame.width() - black_columns) * (frame.height() - black_rows);
    const auto rank = static_cast<std::uint64_t>(std::ceil(percentile / 100 * pixels));
    std::uint64_t below = 0;
    std::size_t at = 0;
    while (at + 1 < counts_.size() && (below += counts_[at]) < rank) ++at;
    double dn = static_cast<double>(at);
    if (scale.companding) dn = number_of_code(*scale.companding, dn);
    if (scale.square_root) dn = dn * dn / (255.0 * 255.0) * scale.max_dn;
    // Noise spreads a saturated level over some numbers below it.
    constexpr double kNearlyFull = 0.98;
    const double range_dn = scale.full_dn - scale.black_dn;
    return {(dn - scale.black_dn) / range_dn, dn - scale.black_dn >= kNearlyFull * range_dn};
}

}  // namespace hilcam
