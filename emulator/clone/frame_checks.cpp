#include "emulator/clone/frame_checks.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "render/vocabulary/check.h"
#include "render/vocabulary/units.h"
#include "sensor/measure/least_squares.h"

namespace hilcam {
namespace {

constexpr std::size_t kFewestDarks = 8, kFewestFlats = 2;

std::uint16_t swapped(std::uint16_t value) { return static_cast<std::uint16_t>(value << 8 | value >> 8); }

[[noreturn]] void refuse(const std::string& where, const std::string& found, const std::string& accepted) {
    throw InputError(where + ": found " + found + "; accepted: " + accepted);
}

// Returns the sum of squared deviations from the line through the points, in units of their errors; skip: a
// point that is left out.
double misfit(std::span<const DarkMean> darks, double grain_dn, std::size_t skip) {
    std::vector<double> time, mean, weight;
    for (std::size_t i = 0; i < darks.size(); ++i) {
        if (i == skip) continue;
        time.push_back(darks[i].series->exposure_s), mean.push_back(darks[i].mean_dn);
        weight.push_back(1 / (square(darks[i].uncertainty_dn) + square(grain_dn)));
    }
    if (std::all_of(time.begin(), time.end(), [&](double t) { return t == time.front(); })) {
        double sum = 0, weights = 0, out = 0;
        for (std::size_t i = 0; i < mean.size(); ++i) sum += weight[i] * mean[i], weights += weight[i];
        for (std::size_t i = 0; i < mean.size(); ++i) out += weight[i] * square(mean[i] - sum / weights);
        return out;
    }
    const Fitted line = fit_polynomial(time, mean, weight, std::vector<double>(time.size(), 0.0), 1);
    double out = 0;
    for (std::size_t i = 0; i < time.size(); ++i)
        out += weight[i] * square(mean[i] - line.coefficient[0] - line.coefficient[1] * time[i]);
    return out;
}

// Refuses the series that alone is far from the line of the others.
void check_line(std::span<const DarkMean> darks, int bits) {
    if (darks.size() < 3) return;
    // Real offsets drift by some tenths of a number; light changes the mean by far more.
    const double grain_dn = std::max(0.3, 2e-4 * std::exp2(bits));
    constexpr double kSigmas = 8;
    const auto freedom = static_cast<double>(darks.size()) - 2;
    if (misfit(darks, grain_dn, darks.size()) < square(kSigmas) * freedom) return;
    std::size_t odd = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < darks.size(); ++i)
        if (const double left = misfit(darks, grain_dn, i); left < least) least = left, odd = i;
    // Through any two of three there is a line; light makes the brightest.
    if (darks.size() == 3)
        odd = static_cast<std::size_t>(
            std::max_element(darks.begin(), darks.end(),
                             [](const auto& a, const auto& b) { return a.mean_dn < b.mean_dn; }) -
            darks.begin());
    refuse(darks[odd].series->name,
           fmt::format("darks with a mean of {:.1f} DN, far from the line of the other darks",
                       darks[odd].mean_dn),
           "frames without any light, whose mean rises in a straight line with the exposure");
}

}  // namespace

void check_series(const FrameSet& set) {
    std::size_t flats = 0, darks = 0;
    for (const FrameSeries& s : set.series) {
        (s.kind == SeriesKind::kDark ? darks : flats)++;
        const std::size_t fewest = s.kind == SeriesKind::kDark ? kFewestDarks : kFewestFlats;
        if (s.frames < fewest)
            refuse(s.name, fmt::format("{} frames", s.frames),
                   fmt::format("at least {} of each dark and {} of each flat; 64 of each are usual",
                               kFewestDarks, kFewestFlats));
        if (s.gain_db != set.series.front().gain_db)
            refuse(set.name,
                   fmt::format("gains of {:g} and {:g} dB in {} and {}", set.series.front().gain_db,
                               s.gain_db, set.series.front().name, s.name),
                   "one gain; put the frames of each gain into a folder of their own");
    }
    if (darks == 0) refuse(set.name, "no dark frames", "at least one series of darks");
    if (flats < 2)
        refuse(set.name, fmt::format("{} series of flats", flats),
               "flats of at least two levels, of ten for the response's bend: the gain is the slope of their "
               "variances");
}

void NumberSurvey::add(const DnImage& frame) {
    for (int y = 0; y < frame.height(); ++y) {
        const auto row = frame.row(y);
        for (std::size_t x = 0; x < row.size(); ++x) {
            const std::uint16_t value = row[x], other = swapped(value);
            facts_.most = std::max(facts_.most, value);
            facts_.most_swapped = std::max(facts_.most_swapped, other);
            facts_.bits_used = static_cast<std::uint16_t>(facts_.bits_used | value);
            facts_.zeros += value == 0 ? 1 : 0;
            facts_.ends += value >= end_ ? 1 : 0;
            if (x == 0) continue;
            facts_.step += std::abs(static_cast<double>(value) - static_cast<double>(row[x - 1]));
            facts_.step_swapped +=
                std::abs(static_cast<double>(other) - static_cast<double>(swapped(row[x - 1])));
            ++steps_;
        }
    }
    numbers_ += static_cast<double>(frame.pixels());
}

NumberFacts NumberSurvey::facts() const {
    NumberFacts out = facts_;
    out.zeros /= std::max(numbers_, 1.0), out.ends /= std::max(numbers_, 1.0);
    out.step /= std::max(steps_, 1.0), out.step_swapped /= std::max(steps_, 1.0);
    return out;
}

void check_numbers(const FrameSet& set, std::span<const NumberFacts> facts) {
    const unsigned end = (1u << set.bits) - 1;
    NumberFacts all;
    std::size_t largest = 0;
    for (std::size_t i = 0; i < facts.size(); ++i) {
        if (facts[i].most > all.most) all.most = facts[i].most, largest = i;
        all.most_swapped = std::max(all.most_swapped, facts[i].most_swapped);
        all.bits_used = static_cast<std::uint16_t>(all.bits_used | facts[i].bits_used);
        all.step += facts[i].step, all.step_swapped += facts[i].step_swapped;
    }
    if (all.most == 0) refuse(set.name, "nothing but zeros", "frames of a camera");
    const int shift = std::countr_zero(all.bits_used);
    const std::string where = set.series[largest].name;
    const std::string up_to = fmt::format("numbers up to {}", all.most);
    const std::string fits = fmt::format("0 to {} of {} bits", end, set.bits);
    // Exchanged bytes turn noise, which is in the low bits, into large steps from pixel to pixel.
    if ((all.most > end && all.most_swapped <= end) || (set.bits > 8 && all.step > 16 * all.step_swapped))
        refuse(where, up_to + ", smoother with their bytes exchanged",
               fits + "; raw files with the high byte first need byte_order: big");
    if (all.most > end && shift > 0 && (all.most >> shift) <= static_cast<int>(end))
        refuse(where, fmt::format("{}, all multiples of {}", up_to, 1 << shift),
               fmt::format("{}; numbers that are shifted up need shift_bits: {}", fits, shift));
    if (all.most > end) refuse(where, up_to, fits);
    if (set.bits > 8 && (all.most <= 255 || (shift > 0 && (all.most >> shift) <= 255)))
        refuse(where,
               shift > 0 ? fmt::format("{}, all multiples of {}", up_to, 1 << shift)
                         : up_to + " in the brightest flat",
               fmt::format("all {} bits of the camera; these look like 8-bit pictures, which have lost the "
                           "noise",
                           set.bits));
    if (shift > 0)
        refuse(where, fmt::format("{}, all multiples of {}", up_to, 1 << shift),
               fmt::format("{}; numbers that are shifted up need shift_bits: {}", fits, shift));
    for (std::size_t i = 0; i < facts.size(); ++i)
        if (facts[i].zeros > 0.01)
            refuse(set.series[i].name, fmt::format("{:.0f} % of the numbers 0", 100 * facts[i].zeros),
                   "a black level that is above the noise in the dark: raise the camera's offset");
}

void check_darkness(std::span<const DarkMean> darks, double flat_rate_dn_s, int bits) {
    for (const DarkMean& d : darks)
        if (d.mean_dn > 0.5 * std::exp2(bits))
            refuse(d.series->name, fmt::format("darks with a mean of {:.0f} DN", d.mean_dn),
                   "frames without any light, below half of the converter's range");
    check_line(darks, bits);
    if (darks.size() < 2) return;
    const auto [shortest, longest] = std::minmax_element(
        darks.begin(), darks.end(),
        [](const DarkMean& a, const DarkMean& b) { return a.series->exposure_s < b.series->exposure_s; });
    const double time_s = longest->series->exposure_s - shortest->series->exposure_s;
    if (time_s <= 0) return;
    const double rate = (longest->mean_dn - shortest->mean_dn) / time_s;
    if (rate > 0.3 * flat_rate_dn_s)
        refuse(longest->series->name,
               fmt::format("darks that rise by {:.4g} DN/s, where the faintest flat rises by {:.4g} DN/s",
                           rate, flat_rate_dn_s),
               "frames without any light, or flats that are at least three times as bright as the darks");
}

}  // namespace hilcam
