#include "emulator/ground/body_loader.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <vector>

#include "io/images/picture_file.h"
#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

BodyRelief load_relief(const std::string& name, const Figure& figure, const BodyConfig& config) {
    const std::string key = name + ".height_map";
    if (figure.equatorial_radius_m != figure.polar_radius_m)
        throw InputError(key + ": the body is flattened; accepted: a round one");
    const PixelMap map = read_pixel_map(config.height_map, true);
    if (map.width() < 8 || map.height() < 4)
        throw InputError(
            fmt::format("{}: found {} x {} pixels; accepted: 8 x 4 or more", key, map.width(), map.height()));
    std::vector<float> heights_m(map.all().begin(), map.all().end());
    for (float& value : heights_m)
        value = static_cast<float>(config.height_zero_m + config.height_step_m * static_cast<double>(value));
    const auto [least, most] = std::minmax_element(heights_m.begin(), heights_m.end());
    constexpr double kMaxShare = 0.05;
    const double bound_m = kMaxShare * figure.equatorial_radius_m;
    if (!(static_cast<double>(*least) > -bound_m && static_cast<double>(*most) < bound_m))
        throw InputError(
            fmt::format("{}: found heights from {:.6g} to {:.6g} m; accepted: within {:.6g} m of the sphere",
                        key, *least, *most, bound_m));
    return {figure.equatorial_radius_m, map.width(), map.height(), std::move(heights_m)};
}

}  // namespace

SceneBody load_body(BodyId id, const std::string& name, const Figure& figure, const BodyConfig& config,
                    const SpectralGrid& grid) {
    SceneBody body;
    body.visible = config.visible;
    body.look = BodyLook(id, config, grid);
    if (!config.albedo_map.empty()) body.map = MipTexture(read_picture(config.albedo_map));
    body.map_reference = config.albedo_map_reference;
    if (config.albedo_map_latitudes == MapLatitude::kPlanetocentric) {
        const double ratio = figure.polar_radius_m / figure.equatorial_radius_m;
        body.map_latitude_factor = ratio * ratio;
    }
    if (config.visible && !config.height_map.empty()) body.relief = load_relief(name, figure, config);
    body.planetshine = config.planetshine;
    if (config.rings && id != BodyId::kSaturn)
        throw InputError(name + ".rings: found true; accepted: rings are for saturn alone");
    body.rings = config.rings;
    return body;
}

}  // namespace hilcam
