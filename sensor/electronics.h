#pragma once
// The electronics turn a pixel's charge into a number: filters along the row, converter errors, companding.
//
// Filters act on a row's samples, with their noise, in the order of read-out (f in cycles per pixel):
//   low-pass   one pole: y += (1 - exp(-2 pi f_c)) (x - y)
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

// Errors of the converter's steps in least significant bits. Integral: a parabola with the given largest
// deviation. Differential: independent Gaussian deviations of the step widths.
struct ConverterConfig {
    double inl_lsb = 0;
    double dnl_lsb = 0;
    Companding companding = Companding::kNone;
    Table companding_table{};  // number, 8-bit code; linear between its points
};
Fields fields(ConverterConfig& config);
// Throws KeyError for a table that falls, or one that is not used.
void validate(const ConverterConfig& config);

// Filters one row from its first sample on. The sample before the first is taken to be the first one's value
// (low-pass, boost), or the black level 0 (high-pass). Loop, any thread.
class RowFilter {
  public:
    explicit RowFilter(const FilterConfig& config);
    bool none() const { return low_pass_ == 1 && high_pass_ == 1 && boost_ == 0; }
    void apply(std::span<float> samples) const;
    // Returns the modulus of the transfer function [cycles/px].
    double mtf(double frequency_cy_px) const;

  private:
    float low_pass_ = 1;   // share of a step that one sample follows; 1: no filter
    float high_pass_ = 1;  // share of the output that remains after one sample; 1: no filter
    float boost_ = 0;
};

// Converts voltage steps to numbers.
class Converter {
  public:
    // seed: for the errors of the steps. number_bits: bits of the numbers to compand, if sums have more than
    // `bits`. Owner thread.
    Converter(const ConverterConfig& config, int bits, std::uint64_t seed, int number_bits = 0);
    // Converts values in DN, before rounding, without companding. Loop, any thread; so is compand().
    void convert(std::span<const float> value_dn, std::span<std::uint16_t> dn) const;
    // Compands the converter's numbers if the camera does so.
    void compand(std::span<std::uint16_t> dn) const;

  private:
    std::uint16_t step_of(float value_dn) const;

    float max_dn_;
    float inl_lsb_;
    std::vector<float> edge_error_lsb_;      // error of each step's lower edge; empty: none
    std::vector<std::uint16_t> companding_;  // code of each number; empty: no companding
};

}  // namespace hilcam
