#pragma once
// Reads the IERS's list of leap seconds (leap-seconds.list, as NTP and tzdata ship it).

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "render/vocabulary/time_system.h"

namespace hilcam {

struct LeapSecondsFile {
    std::vector<LeapSecond> table;
    TimeTai expires;  // from then on the list may lack a leap second
};

// Loads a list of at most 1 MiB; its hash is not checked. Throws InputError with file:line for a malformed
// list: a line of two numbers that do not rise, a date that is not the first of a month, a missing date of
// expiry ("#@").
LeapSecondsFile load_leap_seconds(const std::filesystem::path& file);
LeapSecondsFile read_leap_seconds(std::string_view text, const std::string& name);

}  // namespace hilcam
