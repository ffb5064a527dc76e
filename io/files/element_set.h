#pragma once
// Mean elements for SGP4 (io/orbits/sgp4.h) from files: two-line element sets (tle_file.h) and orbit
// mean-elements messages (omm_file.h).

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "render/vocabulary/time.h"

namespace hilcam {

// One set of mean elements. Angles [rad].
struct ElementSet {
    std::string name;  // from the line above a two-line set, or OBJECT_NAME; may be empty
    // Catalogue number as written, without blanks; OBJECT_ID for a message without a number.
    std::string satellite;
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
    // The reason why SGP4 cannot propagate the set; its other members are then not set. Empty: it can.
    std::string refusal;
};

enum class TleChecksum { kVerify, kIgnore };

// Returns all sets of a file of at most 128 MiB, in order: two-line element sets, or an OMM as KVN, XML, CSV
// or JSON. The first characters tell which. Throws InputError with the place of a malformed set.
std::vector<ElementSet> load_element_sets(const std::filesystem::path& file,
                                          TleChecksum checksum = TleChecksum::kVerify);
// Reads the same from memory; name stands for the file in messages.
std::vector<ElementSet> read_element_sets(std::string_view text, const std::string& name,
                                          TleChecksum checksum = TleChecksum::kVerify);

// Returns the catalogue number in a text: one to nine digits, or Space-Track's Alpha-5, in which a first
// letter stands for two digits (A0000 is 100000, Z9999 is 339999; there is no I and no O). Nothing for any
// other text.
std::optional<int> catalogue_number(std::string_view text);

// Returns the satellite's newest set with an epoch not after `time`, or its oldest set when all are later.
// Sets that SGP4 cannot propagate do not count. satellite: the number in any form, the name or the OBJECT_ID;
// may be empty when the file has one satellite. Throws InputError, also when no set can be propagated.
const ElementSet& choose_element_set(const std::vector<ElementSet>& sets, const std::string& satellite,
                                     TimeTai time, const std::string& file);

// Returns SGP4's count of days, UTC days since 1949-12-31T00:00, for a date from 1950 to 2200 and a fraction
// of its day.
double days_since_1950(int year, int month, int day, double part_of_day);
// Returns why SGP4 must not propagate a set of that ephemeris type (column 63 of line 1, EPHEMERIS_TYPE);
// empty: it may.
std::string refusal_of_ephemeris_type(std::string_view type);

}  // namespace hilcam
