#pragma once
// Reads SPICE's text kernels (LSK, PCK, FK, IK, SCLK, meta-kernels): assignments between \begindata and
// \begintext, NAIF, "Kernel Required Reading", section "Text Kernel Specifications".
//
// The assignments are NAME = value and NAME += value. A value is a number (exponent with E or D), a text in
// single quotes, a date after @, or several values of one kind in parentheses, separated by blanks, commas or
// line ends.

#include <string>
#include <string_view>

#include "io/spice/kernel_pool.h"

namespace hilcam {

// Dates of kernels count from this Julian date, in days of this length.
inline constexpr double kJulianDay_s = 86400, kJ2000_jd = 2451545;

// Reads a kernel's assignments into the pool; name stands for the file in messages. Throws InputError with
// file:line.
void read_text_kernel(std::string_view text, const std::string& name, KernelPool& pool);

// Returns the seconds from J2000 (2000-01-01T12:00:00) to a date in the form after @: 1972-JAN-1, JAN-1-1972,
// 1-JAN-1972/12:00:00.5, 1972-01-01T12:00. Days have 86400 s. Nothing when it is no such date.
std::optional<double> kernel_date_s(std::string_view text);

}  // namespace hilcam
