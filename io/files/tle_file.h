#pragma once
// Reads two-line element sets (TLE) as Space-Track and CelesTrak publish them: two lines of 69 columns,
// optionally below a line with a name.

#include <string>
#include <string_view>
#include <vector>

#include "io/files/element_set.h"

namespace hilcam {

// Returns all sets of a text, in order. Years 57 to 99 are 1957 to 1999, 00 to 56 are 2000 to 2056. With
// kIgnore, lines may lack the checksum's column. A set made for another theory (column 63) is kept with its
// refusal. Throws InputError with file:line for a wrong length, line number, satellite, column or checksum;
// name stands for the file.
std::vector<ElementSet> read_tles(std::string_view text, const std::string& name,
                                  TleChecksum checksum = TleChecksum::kVerify);

}  // namespace hilcam
