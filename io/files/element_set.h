#pragma once
// Mean elements for SGP4 (io/orbits/sgp4.h) from files: two-line element sets (tle_file.h) and orbit mean-elements messages
// (omm_file.h).

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "render/vocabulary/time.h"

namespace hilcam {

// Angles [rad].
struct ElementSet {
    std::string name;  // name in the line above a two-line set, or OBJECT_NAME; may be empty
    std::string
        satellite;  // its catalogue number as written, blanks stripped; of a message without one, its OBJECT_ID
    std::string designator;  // OBJECT_ID of a message
    TimeTai epoch;
    double epoch_days_1950 = 0;  // UTC days since 1949-12-31T00:00
    double inclination_rad = 0;
    double node_rad = 0;
    double eccentricity = 0;
    double perigee_rad = 0;
    double mean_anomaly_rad = 0;
    double mean_motion_rad_min = 0;  // Kozai's
    double bstar_per_er = 0;
    std::string where;  // place in the file, for messages: "iss.tle:2"
    std::string
        refusal;  // why SGP4 cannot propagate it, of a set whose other figures were then not read; empty: it can
};

enum class TleChecksum { kVerify, kIgnore };

// All sets of a file, at most 128 MiB, in its order: two-line element sets, or an OMM as KVN, XML, CSV or JSON, which its
// first characters tell. Throws InputError with the place of what is no such set.
std::vector<ElementSet> load_element_sets(const std::filesystem::path& file,
                                          TleChecksum checksum = TleChecksum::kVerify);
// The same from memory; `name` stands for the file in messages.
std::vector<ElementSet> read_element_sets(std::string_view text, const std::string& name,
                                          TleChecksum checksum = TleChecksum::kVerify);

// The catalogue number that is written so: one to nine digits, or Space-Track's Alpha-5, whose first character stands for
// two digits: A0000 is 100000, Z9999 is 339999, without I and O. Nothing for what is neither.
std::optional<int> catalogue_number(std::string_view text);

// The set of a satellite (its number in any form, its name or its OBJECT_ID) whose epoch is the newest not after `time`, or
// the oldest when all are after it; of sets that SGP4 can propagate. An empty `satellite`: of a file with sets of only one.
// Throws InputError, also when the satellite has no set that SGP4 can propagate.
const ElementSet& choose_element_set(const std::vector<ElementSet>& sets, const std::string& satellite,
                                     TimeTai time, const std::string& file);

// Days of UTC since 1949-12-31T00:00 of a date of 1950 to 2200 and a part of its day, SGP4's count.
double days_since_1950(int year, int month, int day, double part_of_day);
// Says why SGP4 must not propagate a set of that ephemeris type (column 63 of a line 1, EPHEMERIS_TYPE); empty: it may.
std::string refusal_of_ephemeris_type(std::string_view type);

}  // namespace hilcam
