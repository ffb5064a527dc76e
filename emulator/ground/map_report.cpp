#include "emulator/ground/map_report.h"

namespace hilcam {

MapReport report_maps(const GlobeConfig& globe, const MappedBody& body) {
    MapReport out;
    for (const GroundMapConfig& config : globe.maps) {
        const GroundMap map = open_ground_map(config, body);
        const GroundRaster::Reading& reading = map.raster->reading();
        const std::string name = (config.where.empty() ? "" : config.where + ": ") + config.file.string();
        if (!reading.taken.empty()) out.taken.push_back(name + ": " + reading.taken);
        for (const std::string& doubt : reading.doubts) out.doubts.push_back(name + ": " + doubt);
    }
    return out;
}

}  // namespace hilcam
