#include "emulator/ground/globe_loader.h"

#include <algorithm>
#include <optional>

#include "render/ground/globe_terrain.h"
#include "render/ground/rock_abundance.h"
#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

// Measures parameters that are not given on the maps, which are opened once more for that.
ReliefSettings complete(ReliefSettings relief, const GlobeConfig& globe, const MappedBody& body) {
    if (relief.deviation_m > 0 && relief.longest_m > 0) return relief;
    std::vector<GroundMap> maps;
    double spacing_m = 0;
    for (const GroundMapConfig& map : globe.maps) {
        if (map.kind != GroundKind::kHeights) continue;
        maps.push_back(open_ground_map(map, body));
        const double own_m = maps.back().raster->shape().spacing_m;
        spacing_m = spacing_m > 0 ? std::min(spacing_m, own_m) : own_m;
    }
    if (maps.empty())
        throw InputError(
            "terrain.globe.relief: there is no height map to measure; accepted: with deviation_m and "
            "longest_m");
    if (!(relief.longest_m > 0)) relief.longest_m = 2 * spacing_m;
    if (relief.deviation_m > 0) return relief;
    constexpr std::size_t kBytes = std::size_t{32} << 20;
    GroundSurface surface(body.figure, std::move(maps), kBytes);
    const std::optional<ReliefSettings> measured = measured_relief(surface, spacing_m);
    if (!measured)
        throw InputError(
            "terrain.globe.relief: the maps are flat; accepted: with deviation_m, at_m and hurst");
    relief.deviation_m = measured->deviation_m, relief.at_m = measured->at_m, relief.hurst = measured->hurst;
    return relief;
}

}  // namespace

std::vector<GroundMap> open_maps(const GlobeConfig& globe, const MappedBody& body) {
    std::vector<GroundMap> maps;
    for (const GroundMapConfig& map : globe.maps)
        if (map.kind != GroundKind::kRockAbundance) maps.push_back(open_ground_map(map, body));
    return maps;
}

std::unique_ptr<const BoulderField> boulders_of(const GlobeConfig& globe, const MappedBody& body) {
    std::vector<GroundMap> maps;
    for (const GroundMapConfig& map : globe.maps) {
        if (map.kind != GroundKind::kRockAbundance) continue;
        if (!globe.boulders)
            throw InputError(map.where + ": kind: found rock_abundance without boulders; accepted: with " +
                             "terrain.globe.boulders, which gives their sizes");
        maps.push_back(open_ground_map(map, body));
    }
    if (!globe.boulders || (maps.empty() && !(globe.boulders->abundance > 0))) return nullptr;
    const double radius_m = body.figure.equatorial_radius_m;
    if (maps.empty()) return std::make_unique<BoulderField>(radius_m, *globe.boulders);
    // Cells are sized for at least this share, so that a cell holds few boulders where a map has more of
    // them.
    constexpr double kMinSeeded = 0.02;
    BoulderSettings seeded = *globe.boulders;
    seeded.abundance = std::max(seeded.abundance, kMinSeeded);
    return std::make_unique<BoulderField>(
        radius_m, seeded,
        std::make_shared<RockAbundance>(body.figure, std::move(maps), globe.boulders->abundance,
                                        seeded.abundance));
}

std::vector<std::unique_ptr<const GroundDetail>> details_of(const GlobeConfig& globe,
                                                            const MappedBody& body) {
    std::vector<std::unique_ptr<const GroundDetail>> details;
    const double radius_m = body.figure.equatorial_radius_m;
    if (globe.relief)
        details.push_back(std::make_unique<GroundRelief>(radius_m, complete(*globe.relief, globe, body)));
    if (globe.craters) details.push_back(std::make_unique<CraterField>(radius_m, *globe.craters));
    if (auto boulders = boulders_of(globe, body)) details.push_back(std::move(boulders));
    return details;
}

std::unique_ptr<Terrain> load_globe(const GlobeConfig& globe, const MappedBody& body,
                                    const Material& material) {
    const auto* const hapke = std::get_if<brdf::Hapke>(&material.brdf);
    for (const GroundMapConfig& map : globe.maps)
        if (is_of_hapke(map.kind) && !hapke)
            throw InputError(map.where +
                             ": kind: found a parameter of Hapke's law; accepted: with a material of "
                             "model hapke (terrain.material)");
    constexpr int kMegabyteBits = 20;
    return std::make_unique<GlobeTerrain>(
        body.figure, open_maps(globe, body), details_of(globe, body),
        GlobeSettings{static_cast<std::size_t>(globe.memory_mb) << kMegabyteBits, globe.finest_m,
                      hapke ? hapke->parameters : HapkeParameters{}});
}

}  // namespace hilcam
