#include "io/maps/value_judge.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "render/vocabulary/plain_number.h"

namespace hilcam {
namespace {

struct Spread {
    double least = std::numeric_limits<double>::infinity(), most = -least, sum = 0;
    double count = 0;

    void take(double value) {
        least = std::min(least, value), most = std::max(most, value);
        sum += value, count += 1;
    }
};

}  // namespace

std::vector<float> unsaid_holes(std::span<const float> raw) {
    // Values that GIS programs and generic mapping tools use for holes, and the lowest signed 16-bit numbers.
    constexpr std::array<float, 6> kHabits = {-999, -9999, -32767, -32768, -99999, -999999};
    std::array<bool, kHabits.size()> met{};
    Spread others;
    for (const float value : raw) {
        const auto* const found = std::find(kHabits.begin(), kHabits.end(), value);
        if (found != kHabits.end())
            met[static_cast<std::size_t>(found - kHabits.begin())] = true;
        else if (std::isfinite(value) && std::abs(value) < 1e9F)
            others.take(static_cast<double>(value));
    }
    std::vector<float> out;
    if (!(others.count > 0)) return out;
    const double apart = std::max(100.0, 0.1 * (others.most - others.least));
    for (std::size_t i = 0; i < kHabits.size(); ++i) {
        const auto value = static_cast<double>(kHabits[i]);
        if (met[i] && (value < others.least - apart || value > others.most + apart))
            out.push_back(kHabits[i]);
    }
    return out;
}

std::string judge_heights(std::span<const float> heights_m, const Figure& figure, bool whole_turn,
                          std::vector<std::string>& doubts) {
    Spread all;
    for (const float height_m : heights_m)
        if (std::isfinite(height_m)) all.take(static_cast<double>(height_m));
    if (!(all.count > 0)) return {};
    const double radius_m = figure.equatorial_radius_m, mean_m = all.sum / all.count;
    const auto rounded = [](double value) { return plain(std::round(value)); };
    const auto are_radii = [&](double unit_m) {
        return all.least * unit_m > 0.5 * radius_m && all.most * unit_m < 1.5 * radius_m;
    };
    constexpr double kKilometre = 1000;
    if (are_radii(1))
        return "its heights are radii, " + rounded(all.least) + " to " + rounded(all.most) +
               " m; accepted: heights over the ellipsoid, with offset: " + plain(-radius_m) +
               (figure.polar_radius_m < radius_m ? " where they are over a sphere of that radius" : "");
    // A tenth of a radius is more than the relief of any round body: Vesta's is 0.09 (Jaumann et al., Science
    // 336, 687, 2012).
    if (const double max_m = std::max(std::abs(all.least), std::abs(all.most)); max_m > 0.1 * radius_m)
        doubts.push_back("its heights go from " + rounded(all.least) + " to " + rounded(all.most) +
                         " m, more than a tenth of the body's radius of " + rounded(radius_m) +
                         " m; scale and offset make metres over the ellipsoid of what the file has");
    else if (are_radii(kKilometre) && all.most - all.least < 0.05 * mean_m)
        doubts.push_back(
            "its heights, " + rounded(all.least) + " to " + rounded(all.most) +
            " m, look like radii in km; if they are, scale: 1000 and offset: " + plain(-radius_m));
    // The relief of the Moon and planets is 0.003 to 0.01 of their radius.
    else if (whole_turn && all.most > all.least && all.most - all.least < 2e-5 * radius_m)
        doubts.push_back("all of the body lies within " +
                         plain(std::round(10 * (all.most - all.least)) / 10) +
                         " m of height; if the file's heights are in km, scale: 1000");
    return {};
}

}  // namespace hilcam
