#pragma once
// The drawing of a spider's spikes (spider.h), which leaves it to the caller where a pixel's electrons go.

#include <algorithm>
#include <cmath>

#include "sensor/spider.h"

namespace hilcam {

template <class Add>
void SpiderSpikes::draw(double x_px, double y_px, double electrons, int width_px, Rows rows,
                        const Add& add) const {
    const double each = electrons / static_cast<double>(vanes_.size());
    for (const Vane& vane : vanes_) {
        // Steps of a pixel along the axis that the spike is nearer to; across it by the other.
        const bool flat = std::abs(vane.cosine) >= std::abs(vane.sine);
        const double step = std::abs(flat ? vane.cosine : vane.sine);
        const double slope = flat ? vane.sine / vane.cosine : vane.cosine / vane.sine;
        const double from_px = flat ? x_px : y_px, across_px = flat ? y_px : x_px;
        const double sigma = across_sigma_px_ / step, reach = 3.5 * sigma + 0.5;
        const auto least = [](double v, double most) { return std::clamp(v, 0.0, most); };
        int begin = flat ? 0 : rows.begin, end = flat ? width_px : rows.end;
        if (flat && std::abs(slope) > 1e-9) {
            // Columns in which the spike can be in these rows.
            const double a = (rows.begin - reach - y_px) / slope + x_px,
                         b = (rows.end + reach - y_px) / slope + x_px;
            begin = static_cast<int>(least(std::floor(std::min(a, b)), width_px));
            end = static_cast<int>(least(std::ceil(std::max(a, b)) + 1, width_px));
        }
        const int across_begin = flat ? rows.begin : 0, across_end = flat ? rows.end : width_px;
        for (int i = begin; i < end; ++i) {
            const double way = i + 0.5 - from_px, middle = across_px + slope * way;
            const double light = each * along(std::abs(way) / step) / step;
            if (!(light > 1e-6)) continue;
            const int first = static_cast<int>(least(std::floor(middle - reach), across_end)),
                      last = static_cast<int>(least(std::ceil(middle + reach), across_end));
            const auto below = [&](double edge) {
                return 0.5 * std::erf((edge - middle) / (sigma * 1.4142135623730951));
            };
            double before = below(std::max(first, across_begin));
            for (int k = std::max(first, across_begin); k < last; ++k) {
                const double after = below(k + 1.0);
                add(flat ? i : k, flat ? k : i, static_cast<float>(light * (after - before)));
                before = after;
            }
        }
    }
}

}  // namespace hilcam
