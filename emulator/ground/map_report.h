#pragma once
// This tells how the maps of a scenario were understood: the kinds of their latitudes and longitudes, their units, and what is probably not
// meant.

#include <string>
#include <vector>

#include "emulator/ground/globe_config.h"

namespace hilcam {

struct MapReport {
    std::vector<std::string> taken;   // a line for each map that says anything
    std::vector<std::string> doubts;  // a line each
};

// Opens each map of the ground for that. Throws InputError.
MapReport report_maps(const GlobeConfig& globe, const MappedBody& body);

}  // namespace hilcam
