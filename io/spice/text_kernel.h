#pragma once
// SPICE's text kernels (LSK, PCK, FK, IK, SCLK, meta-kernels): assignments between \begindata and \begintext, NAIF,
// "Kernel Required Reading", section "Text Kernel Specifications".
//
// NAME = value and NAME += value; values are numbers (exponents with E or D), texts between single quotes, dates after
// @, or several of one kind in parentheses, apart by blanks, commas or lines.

#include <string>
#include <string_view>

#include "io/spice/kernel_pool.h"

namespace hilcam {

// Dates of kernels are counted in days of so many seconds from this Julian date.
inline constexpr double kJulianDay_s = 86400, kJ2000_jd = 2451545;

// Reads a kernel's assignments into the pool; `name` stands for the file in messages. Throws InputError with file:line.
void read_text_kernel(std::string_view text, const std::string& name, KernelPool& pool);

// Returns the seconds from J2000 (2000-01-01T12:00:00) to a date as kernels have them after @: 1972-JAN-1,
// JAN-1-1972, 1-JAN-1972/12:00:00.5, 1972-01-01T12:00. Days have 86400 s. None: it is no such date.
std::optional<double> kernel_date_s(std::string_view text);

}  // namespace hilcam
