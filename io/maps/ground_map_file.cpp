#include "io/maps/ground_map_file.h"

#include <algorithm>
#include <cmath>

#include "io/maps/map_helper.h"
#include "io/maps/picture_raster.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/plain_number.h"

namespace hilcam {

Fields fields(GroundMapConfig& c) {
    return {
        required(path(
            "file", c.file, c.where,
            "map: GeoTIFF, PDS3 or ISIS label, data file of an ENVI header, or a picture with bounds_deg")),
        choice("kind", c.kind,
               {"heights", "albedo", "rock_abundance", "lobe_width", "lobe_backward", "surge_amplitude",
                "surge_width", "slope_deg"},
               "meaning of the map's values: heights above the body's ellipsoid [m], factors on the "
               "material's reflectance (one channel, or red, green and blue), share of the ground covered by "
               "boulders, or the material's key of that name (hapke)"),
        choice("between", c.between, {"bilinear", "cubic"}, "interpolation between the posts"),
        number("scale", c.scale, 1, {-1e9, 1e9},
               "factor on the file's values, in addition to the file's own factor"),
        number("offset", c.offset, 1, {-1e9, 1e9}, "number added after scale [m for heights]"),
        choice(
            "coding", c.coding, {"linear", "srgb"},
            "coding of the values. srgb: sRGB codes of 0 to 255, decoded to 0 to 1 before scale and offset"),
        choice("holes", c.holes, {"refuse", "fill"},
               "treatment of holes (no-data). refuse: they are an error; fill: the map below shows through, "
               "or height 0"),
        numbers("no_data", c.no_data, 1, {-1e9, 1e9}, {0, 4},
                "values of the file that are holes, in addition to its own; left out: -9999, -32768 and the "
                "like, where no other value is near"),
        choice("latitudes", c.latitudes, {"label", "planetocentric", "planetographic"},
               "kind of the map's latitudes. label: as in the file; if the file gives none, a sphere for a "
               "flattened body counts as planetocentric"),
        choice("longitudes", c.longitudes, {"label", "east", "west"},
               "positive direction of the projection's longitudes. label: as in the file, else east"),
        number("blend_posts", c.blend_posts, 1, {0, 1e4},
               "width of the margin that blends the map into the one below, in posts of this map"),
        numbers("bounds_deg", c.bounds_deg, 1, {-360, 540}, {0, 4},
                "[west, south, east, north] outer edges of a map in longitude and latitude, used if the file "
                "has no projection or a wrong one"),
    };
}

void validate(const GroundMapConfig& c) {
    const std::vector<double>& b = c.bounds_deg;
    if (b.empty()) return;
    if (c.longitudes != MapLongitudes::kLabel)
        throw KeyError("longitudes",
                       "has no effect with bounds_deg, which counts to the east; accepted: one of them");
    if (b.size() != 4)
        throw refused_key("bounds_deg", std::to_string(b.size()) + " numbers", "[west, south, east, north]");
    if (!(b[0] < b[2] && b[2] - b[0] <= 360))
        throw refused_key("bounds_deg", "west " + plain(b[0]) + ", east " + plain(b[2]),
                          "an east that is more, by 360 at most");
    if (!(b[1] < b[3] && b[1] >= -90 && b[3] <= 90))
        throw refused_key("bounds_deg", "south " + plain(b[1]) + ", north " + plain(b[3]),
                          "a north that is more, both within -90 to 90");
}

namespace {

// Refuses values beyond the kind's limits; looks at some hundreds of posts along each edge.
void refuse_beyond(const GroundMapConfig& config, GroundRaster& raster) {
    const std::optional<ParameterLimits> limits = limits_of(config.kind);
    if (!limits) return;
    constexpr int kMax = 512;
    const GroundRaster::Shape& shape = raster.shape();
    int level = 0;
    while ((std::max(shape.columns, shape.rows) >> level) > kMax &&
           (std::min(shape.columns, shape.rows) >> level) > 1)
        ++level;
    const int columns = shape.columns >> level, rows = shape.rows >> level;
    std::vector<float> values(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
    raster.read(level, 0, 0, columns, rows, values);
    for (std::size_t i = 0; i < values.size(); ++i) {
        const auto value = static_cast<double>(values[i]);
        // Single precision may round the limits themselves. Holes are not compared.
        const double slack = 1e-6 * std::max(std::abs(limits->least), std::abs(limits->most));
        if (value < limits->least - slack || value > limits->most + slack)
            throw InputError(config.where + ": " + config.file.string() + ": found " + plain(value) +
                             " at column " +
                             std::to_string((i % static_cast<std::size_t>(columns)) << level) + ", row " +
                             std::to_string((i / static_cast<std::size_t>(columns)) << level) +
                             "; accepted: " + plain(limits->least) + " to " + plain(limits->most) +
                             ", with scale and offset");
    }
}

}  // namespace

GroundMap open_ground_map(const GroundMapConfig& config, const MappedBody& body) {
    GroundMap map;
    map.kind = config.kind;
    map.between = config.between;
    map.raster =
        is_picture(config.file) ? open_picture_raster(config, body) : open_map_by_helper(config, body);
    refuse_beyond(config, *map.raster);
    map.blend_m = config.blend_posts * map.raster->shape().spacing_m;
    return map;
}

}  // namespace hilcam
