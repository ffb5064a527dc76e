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
    // The reason why SGP4 cannot propagate the set; its other figures are then not read. Empty: it can.
    std::string refusal;
};

enum class TleChecksum { kVerify, kIgnore };

// All sets of a file, at most 128 MiB, in its order: two-line element sets, or an OMM as KVN, XML, CSV or JSON, which its
// first characters tell. Throws InputError with the place of what is no such set.
std::vector<ElementSet> load_element_sets(const std::filesystem::path& file,
                                          TleChecksum checksum = TleChecksum::kVerify);
// The same from memory; `name` stands for the file in messages.
std::vector<ElementSet> read_element_sets(std::string_view text, const std::string& name,
                                          TleChecksum checksum = TleChecksum::kVerify);

// Returns the catalogue number that a text stands for: one to nine digits, or Space-Track's Alpha-5, in which a first letter
// counts two digits (A0000 is 100000, Z9999 is 339999; there is no I and no O). Returns nothing for any other text.
std::optional<int> catalogue_number(std::string_view text);

// Returns the newest set of a satellite whose epoch is not after `time`, or its oldest set when all are later. `satellite` is the
// number in any form, the name or the OBJECT_ID; it may be empty where the file has one satellite. Sets that SGP4 cannot propagate
// do not count.
// Throws InputError, also when the satellite has no set that SGP4 can propagate.
const ElementSet& choose_element_set(const std::vector<ElementSet>& sets, const std::string& satellite,
                                     TimeTai time, const std::string& file);

// Days of UTC since 1949-12-31T00:00 of a date of 1950 to 2200 and a part of its day, SGP4's count.
double days_since_1950(int year, int month, int day, double part_of_day);
// Says why SGP4 must not propagate a set of that ephemeris type (column 63 of a line 1, EPHEMERIS_TYPE); empty: it may.
std::string refusal_of_ephemeris_type(std::string_view type);

}  // namespace hilcam
