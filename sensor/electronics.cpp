#include "sensor/electronics.h"

#include <algorithm>
#include <cmath>
#include <complex>

#include "render/vocabulary/clones.h"
#include "render/vocabulary/random.h"
#include "render/vocabulary/units.h"
#include "sensor/noise.h"

namespace hilcam {

Fields fields(FilterConfig& c) {
    return {
        number("low_pass_cy_px", c.low_pass_cy_px, 1, {0, 100},
               "-3 dB frequency of the low-pass along a row; 0: none"),
        number("high_pass_cy_px", c.high_pass_cy_px, 1, {0, 0.5},
               "-3 dB frequency of the high-pass along a row; 0: none"),
        number("boost", c.boost, 1, {0, 4}, "coefficient b of the gain 1 + b (1 - cos 2 pi f) along a row"),
    };
}

Fields fields(ConverterConfig& c) {
    return {
        number("inl_lsb", c.inl_lsb, 1, {0, 64}, "integral nonlinearity: largest deviation, at mid-scale"),
        number("dnl_lsb", c.dnl_lsb, 1, {0, 0.3}, "differential nonlinearity: standard deviation"),
        choice("companding", c.companding, {"none", "square_root", "table"},
               "companding of the DN to 8 bits"),
        table("companding_table", c.companding_table, {"dn", "code"}, {0, 65535}, {0, 255},
              "8-bit code by DN, for companding: table; linear between points, rounded"),
    };
}

void validate(const ConverterConfig& c) {
    const bool by_table = c.companding == Companding::kTable;
    if (by_table == c.companding_table.empty())
        throw KeyError(by_table ? "companding" : "companding_table",
                       by_table ? "found table without companding_table; accepted: both or neither"
                                : "has no effect without companding: table; accepted: both or neither");
    const std::vector<double>& codes = c.companding_table.y;
    if (!std::is_sorted(codes.begin(), codes.end()))
        throw KeyError("companding_table",
                       "found codes that fall while the numbers rise; accepted: codes that do not");
}

RowFilter::RowFilter(const FilterConfig& c) : boost_(static_cast<float>(c.boost)) {
    if (c.low_pass_cy_px > 0) low_pass_ = static_cast<float>(1 - std::exp(-2 * kPi * c.low_pass_cy_px));
    if (c.high_pass_cy_px > 0) high_pass_ = static_cast<float>(std::exp(-2 * kPi * c.high_pass_cy_px));
}

void RowFilter::apply(std::span<float> samples) const {
    if (samples.empty()) return;
    if (low_pass_ < 1) {
        float y = samples[0];
        for (float& x : samples) x = y += low_pass_ * (x - y);
    }
    if (high_pass_ < 1) {
        float y = 0, before = 0;
        for (float& x : samples) {
            y = high_pass_ * (y + x - before);
            before = x;
            x = y;
        }
    }
    if (boost_ > 0) {
        float before = samples[0];
        for (std::size_t i = 0; i < samples.size(); ++i) {
            const float here = samples[i];
            const float after = i + 1 < samples.size() ? samples[i + 1] : here;
            samples[i] = here + boost_ * (here - 0.5f * (before + after));
            before = here;
        }
    }
}

double RowFilter::mtf(double f) const {
    const std::complex<double> delay = std::polar(1.0, -2 * kPi * f);
    const double a = static_cast<double>(low_pass_), b = static_cast<double>(high_pass_);
    double modulus = 1;
    if (low_pass_ < 1) modulus *= std::abs(a / (1.0 - (1 - a) * delay));
    if (high_pass_ < 1) modulus *= std::abs(b * (1.0 - delay) / (1.0 - b * delay));
    return modulus * (1 + static_cast<double>(boost_) * (1 - std::cos(2 * kPi * f)));
}

Converter::Converter(const ConverterConfig& c, int bits, std::uint64_t seed, int number_bits)
    : max_dn_(static_cast<float>((1 << bits) - 1)), inl_lsb_(static_cast<float>(c.inl_lsb)) {
    const std::uint32_t steps = std::uint32_t{1} << bits;
    // A step's width is the difference between two edges, so each edge has 1 / sqrt 2 of its deviation.
    if (c.dnl_lsb > 0)
        for (std::uint32_t i = 0; i <= steps; ++i) {
            const auto words = random_words({seed, 0}, RandomPurpose::kConverter, i);
            const float error =
                normal_quantile(uniform01(words[0])) * static_cast<float>(c.dnl_lsb * std::sqrt(0.5));
            // Edges must not change their order.
            edge_error_lsb_.push_back(std::clamp(error, -0.49f, 0.49f));
        }
    if (c.companding == Companding::kNone) return;
    const std::uint32_t numbers = std::uint32_t{1} << std::max(bits, number_bits);
    for (std::uint32_t i = 0; i < numbers; ++i) {
        const double code = c.companding == Companding::kTable
                                ? c.companding_table.at(static_cast<double>(i))
                                : 255 * std::sqrt(static_cast<double>(i) / static_cast<double>(numbers - 1));
        companding_.push_back(static_cast<std::uint16_t>(std::lround(code)));
    }
}

namespace {

HILCAM_CLONES void round_all(const float* value_dn, std::size_t count, float max_dn, std::uint16_t* dn) {
    for (std::size_t i = 0; i < count; ++i)
        dn[i] = static_cast<std::uint16_t>(
            static_cast<std::int32_t>(std::min(std::max(value_dn[i], 0.0f), max_dn) + 0.5f));
}

}  // namespace

void Converter::convert(std::span<const float> value_dn, std::span<std::uint16_t> dn) const {
    if (edge_error_lsb_.empty() && inl_lsb_ == 0)
        round_all(value_dn.data(), value_dn.size(), max_dn_, dn.data());
    else
        std::transform(value_dn.begin(), value_dn.end(), dn.begin(), [&](float v) { return step_of(v); });
}

void Converter::compand(std::span<std::uint16_t> dn) const {
    if (!companding_.empty())
        for (std::uint16_t& value : dn) value = companding_[value];
}

std::uint16_t Converter::step_of(float value_dn) const {
    const float x = std::min(std::max(value_dn, 0.0f), max_dn_);
    const float bent = std::min(x + 4 * inl_lsb_ * (x / max_dn_) * (1 - x / max_dn_), max_dn_);
    auto step = static_cast<std::int32_t>(bent + 0.5f);
    if (!edge_error_lsb_.empty()) {
        const float beyond = bent - static_cast<float>(step);  // -0.5 .. 0.5
        const auto edge = [&](std::int32_t i) { return edge_error_lsb_[static_cast<std::size_t>(i)]; };
        if (step > 0 && beyond < -0.5f + edge(step))
            --step;
        else if (step < static_cast<std::int32_t>(max_dn_) && beyond >= 0.5f + edge(step + 1))
            ++step;
    }
    return static_cast<std::uint16_t>(step);
}

}  // namespace hilcam
