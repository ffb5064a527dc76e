#pragma once
// Two-line element sets (TLE), as Space-Track and CelesTrak publish them: two lines of 69 columns, perhaps
// under a line with a name.

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "render/vocabulary/time.h"

namespace hilcam {

// Mean elements of SGP4 (io/orbits/sgp4.h). Angles [rad].
struct Tle {
    std::string name;       // name in the line above, without blanks around; may be empty
    std::string satellite;  // its number as written, five characters or fewer, blanks stripped
    TimeTai epoch;
    double epoch_days_1950 = 0;  // UTC days since 1949-12-31T00:00
    double inclination_rad = 0;
    double node_rad = 0;
    double eccentricity = 0;
    double perigee_rad = 0;
    double mean_anomaly_rad = 0;
    double mean_motion_rad_min = 0;  // Kozai's
    double bstar_per_er = 0;
    int line = 0;  // line of the file where line 1 of the set stands
};

enum class TleChecksum { kVerify, kIgnore };

// All sets of a file, at most 16 MiB, in its order. Years 57 to 99 are 1957 to 1999, 00 to 56 are 2000 to
// 2056. Throws InputError with file:line for a line of wrong length, number, satellite, column or checksum.
std::vector<Tle> load_tles(const std::filesystem::path& file, TleChecksum checksum = TleChecksum::kVerify);
// The same from memory; `name` stands for the file in messages.
std::vector<Tle> read_tles(std::string_view text, const std::string& name,
                           TleChecksum checksum = TleChecksum::kVerify);

// The set of a satellite (its number, or its name) whose epoch is the newest not after `time`, or the oldest
// when all are after it. An empty `satellite`: of a file with sets of only one. Throws InputError.
const Tle& choose_tle(const std::vector<Tle>& sets, const std::string& satellite, TimeTai time,
                      const std::string& file);

}  // namespace hilcam
