#pragma once
// The electronics turn a pixel's charge into a number: filters along the row, converter errors, companding.
//
// Filters act on the samples of a row in the order of read-out, noise and all (f in cycles per pixel):
//   low-pass   one pole:   y += (1 - exp(-2 pi f_c)) (x - y)
//   high-pass  one pole (AC coupling, clamped to the black level before each row)
//   boost      aperture correction: y = x + b (x - (x_before + x_after) / 2), gain 1 + b (1 - cos 2 pi f)

#include <cstdint>
#include <span>
#include <vector>

#include "render/vocabulary/config_field.h"
#include "render/vocabulary/table.h"

namespace hilcam {

struct FilterConfig {
    double low_pass_cy_px = 0;   // -3 dB frequency; 0: none
    double high_pass_cy_px = 0;  // 0: none
    double boost = 0;            // 0: none
};
Fields fields(FilterConfig& config);

enum class Companding { kNone, kSquareRoot, kTable };

// Errors of the converter's steps in least significant bits: a parabola of the given greatest deviation
// (integral) and independent Gaussian deviations of the steps' widths (differential).
struct ConverterConfig {
    double inl_lsb = 0;
    double dnl_lsb = 0;
    Companding companding = Companding::kNone;
    Table companding_table{};  // number, code of 8 bits; straight between its points
};
Fields fields(ConverterConfig& config);
// Throws KeyError for a table that falls, and for one without its use.
void validate(const ConverterConfig& config);

// Along one row, from its first sample on. Before it stand the first sample's own value (low-pass, boost) and
// the black level 0 (high-pass). Loop, any thread.
class RowFilter {
  public:
    explicit RowFilter(const FilterConfig& config);
    bool none() const { return low_pass_ == 1 && high_pass_ == 1 && boost_ == 0; }
    void apply(std::span<float> samples) const;
    // Modulus of its transfer function [cycles/px].
    double mtf(double frequency_cy_px) const;

  private:
    float low_pass_ = 1;   // share of a step that one sample takes; 1: none
    float high_pass_ = 1;  // share of the output that one sample keeps; 1: none
    float boost_ = 0;
};

// Voltage steps to numbers.
class Converter {
  public:
    // seed: of the steps' own errors. number_bits: of the numbers that are companded, where sums have more. Owner thread.
    Converter(const ConverterConfig& config, int bits, std::uint64_t seed, int number_bits = 0);
    // `value` in DN before rounding; numbers are not companded. Loop, any thread, as is what follows.
    void convert(std::span<const float> value_dn, std::span<std::uint16_t> dn) const;
    // Compands numbers of the converter, where the camera does.
    void compand(std::span<std::uint16_t> dn) const;

  private:
    std::uint16_t step_of(float value_dn) const;

    float max_dn_;
    float inl_lsb_;
    std::vector<float> edge_error_lsb_;      // error of the lower edge of each step; empty: none
    std::vector<std::uint16_t> companding_;  // by converted number; empty: none
};

}  // namespace hilcam
