#pragma once
// Reports how the maps of a scenario were understood: kinds of latitude and longitude, units, and probable
// mistakes.

#include <string>
#include <vector>

#include "emulator/ground/globe_config.h"

namespace hilcam {

struct MapReport {
    std::vector<std::string> taken;   // one line for each map that states something
    std::vector<std::string> doubts;  // one line each
};

// Opens each map of the ground to do so. Throws InputError.
MapReport report_maps(const GlobeConfig& globe, const MappedBody& body);

}  // namespace hilcam
