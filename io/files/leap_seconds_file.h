#pragma once
// The IERS's list of leap seconds (leap-seconds.list, as NTP and tzdata have it).

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "render/vocabulary/time_system.h"

namespace hilcam {

struct LeapSecondsFile {
    std::vector<LeapSecond> table;
    TimeTai expires;  // from then on the file may lack a leap second
};

// Loads a list of at most 1 MiB. Its hash is not checked. Throws InputError with file:line for what is no
// such list: a line of two numbers that do not rise, a date that is not the first of a month, no date of
// expiry ("#@").
LeapSecondsFile load_leap_seconds(const std::filesystem::path& file);
LeapSecondsFile read_leap_seconds(std::string_view text, const std::string& name);

}  // namespace hilcam
