#pragma once
// From the pixel's charge to a number: filters along the row, converter errors, companding.
//
// Filters act on the samples of a row in the order of read-out, noise and all (f in cycles per pixel):
//   low-pass   one pole:   y += (1 - exp(-2 pi f_c)) (x - y)
//   high-pass  one pole (AC coupling, clamped to the black level before each row)
//   boost      aperture correction: y = x + b (x - (x_before + x_after) / 2), gain 1 + b (1 - cos 2 pi f)

#include <cstdint>

#include "render/config_field.h"

namespace hilcam {

struct FilterConfig {
    double low_pass_cy_px = 0;   // -3 dB frequency; 0: none
    double high_pass_cy_px = 0;  // 0: none
    double boost = 0;            // 0: none
};
Fields fields(FilterConfig& config);

enum class Companding { kNone, kSquareRoot };

// Errors of the converter's steps in least significant bits: a parabola of the given greatest deviation
// (integral) and independent Gaussian deviations of the steps' widths (differential).
struct ConverterConfig {
    double inl_lsb = 0;
    double dnl_lsb = 0;
    Companding companding = Companding::kNone;
};
Fields fields(ConverterConfig& config);

}  // namespace hilcam
