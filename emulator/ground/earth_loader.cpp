#include "emulator/ground/earth_loader.h"

#include "io/files/earth_map_file.h"
#include "io/maps/earth_layers.h"

namespace hilcam {
namespace {

GroundMaps load_ground(const std::vector<EarthGroundConfig>& configs) {
    std::vector<GroundMaps::Monthly> months;
    std::vector<GroundMaps::Timed> instants;
    for (const EarthGroundConfig& one : configs)
        if (one.month != 0)
            months.push_back({static_cast<int>(one.month), read_earth_map(one.map)});
        else
            instants.push_back({parse_utc(one.at_utc), read_earth_map(one.map)});
    return months.empty() ? GroundMaps(std::move(instants)) : GroundMaps(std::move(months));
}

}  // namespace

EarthMaps load_earth_maps(const EarthConfig& config) {
    CloudMaps clouds;
    if (config.cloud_seed != 0) clouds = seeded_clouds(static_cast<std::uint64_t>(config.cloud_seed));
    if (!config.cloud_map.empty()) clouds = read_earth_map(config.cloud_map);
    if (!config.clouds.empty()) {
        std::vector<CloudMaps::Timed> maps;
        for (const CloudsConfig& one : config.clouds)
            maps.push_back({parse_utc(one.at_utc), read_earth_map(one.map)});
        clouds = CloudMaps(std::move(maps));
    }
    if (!config.ground.empty()) {
        if (clouds.empty()) clouds = read_earth_map(config.map);
        return {load_ground(config.ground), std::move(clouds), nullptr};
    }
    LayeredEarth earth = with_layers(read_earth_map(config.map), config.layers);
    return {std::move(earth.map), std::move(clouds), std::move(earth.detail)};
}

std::shared_ptr<const EarthModel> make_earth(const EarthConfig& config, EarthMaps maps, const Atmosphere* air,
                                             const SpectralGrid& grid) {
    return std::make_shared<EarthModel>(config, std::move(maps.ground), std::move(maps.clouds), air, grid,
                                        std::move(maps.detail));
}

}  // namespace hilcam
