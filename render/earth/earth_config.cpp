#include "render/earth/earth_config.h"

#include "render/vocabulary/time.h"

namespace hilcam {

Fields fields(CloudsConfig& c) {
    return {
        required(path("map", c.map, "map of the same format as earth_surface.map; its clouds are used")),
        required(text("at_utc", c.at_utc, "instant of the map, UTC: YYYY-MM-DDThh:mm:ss[.f]Z")),
    };
}

void validate(const CloudsConfig& c) {
    at_key("at_utc", [&] { parse_utc(c.at_utc); });
}

Fields fields(EarthGroundConfig& c) {
    return {
        required(
            path("map", c.map,
                 "map of the same format as earth_surface.map; its land, ice, water and lights are used")),
        integer("month", c.month, {0, 12},
                "month of the map in each year, 1 to 12; 0: at_utc gives its instant"),
        text("at_utc", c.at_utc, "instant of the map, UTC: YYYY-MM-DDThh:mm:ss[.f]Z"),
    };
}

void validate(const EarthGroundConfig& c) {
    if (c.month != 0 && !c.at_utc.empty())
        throw KeyError("at_utc", "and 'month' both say when the map is; accepted: one of them");
    if (c.month == 0 && c.at_utc.empty())
        throw KeyError("month", "is missing, and at_utc; accepted: one of them");
    if (c.month == 0) at_key("at_utc", [&] { parse_utc(c.at_utc); });
}

Fields fields(EarthLayerConfig& c) {
    return {
        required(path("file", c.file, c.where,
                      "map of the whole Earth in longitude and latitude, twice as wide as high: GeoTIFF "
                      "(also cloud-optimised), or picture (.png) starting at 180 W and 90 N; a large one "
                      "needs overviews (gdaladdo)")),
        required(
            choice("kind", c.kind,
                   {"land", "infrared", "water", "clouds", "cloud_thickness", "cloud_tops", "lights"},
                   "meaning of the values after coding, scale and offset. land: reflectance in red, green "
                   "and blue; infrared: reflectance from 0.72 um on (left out: estimated from the colours); "
                   "water: share of the ground; clouds: white of a picture, 0 to 1; cloud_thickness: optical "
                   "thickness; cloud_tops: height [m]; lights: share of the brightest")),
        choice("coding", c.coding, {"linear", "srgb", "blue_marble"},
               "coding of the values. srgb: sRGB codes of 0 to 255, decoded to 0 to 1 before scale and "
               "offset; blue_marble: the same for NASA's Blue Marble, with its colours converted to "
               "reflectance as in tools/make_earth_map.py (land only)"),
        number("scale", c.scale, 1, {-1e9, 1e9},
               "factor on the file's values, in addition to the file's own factor"),
        number("offset", c.offset, 1, {-1e9, 1e9}, "number added after scale"),
        numbers("bounds_deg", c.bounds_deg, 1, {-360, 540}, {0, 4},
                "[west, south, east, north] outer edges of the map, for a file without a projection; they "
                "span the whole Earth"),
    };
}

void validate(const EarthLayerConfig& c) {
    if (c.coding == EarthLayerConfig::Coding::kBlueMarble && c.kind != EarthLayerConfig::Kind::kLand)
        throw refused_key("coding", "blue_marble",
                          "linear, srgb, as only land has the colours of that picture");
    if (c.bounds_deg.empty()) return;
    if (c.bounds_deg.size() != 4)
        throw refused_key("bounds_deg", std::to_string(c.bounds_deg.size()) + " numbers",
                          "[west, south, east, north]");
    const double east_deg = c.bounds_deg[2] - c.bounds_deg[0];
    if (east_deg != 360 || c.bounds_deg[1] != -90 || c.bounds_deg[3] != 90)
        throw refused_key("bounds_deg", "another than the whole Earth",
                          "[west, -90, east, 90] with an east that is 360 more, as [-180, -90, 180, 90]");
}

Fields fields(EarthConfig& c) {
    return {
        path("map", c.map,
             "map of land, water, clouds and lights, made by tools/make_earth_map.py of the source tree; "
             "left out: the Earth has earth.albedo or earth.albedo_map"),
        number("wind_m_s", c.wind_m_s, 1, {0, 30},
               "wind speed at 12.5 m over all seas, which sets the width of the glint"),
        number("cloud_thickness", c.cloud_thickness, 1, {0, 10},
               "factor on the clouds' optical thickness; 0: no clouds"),
        path("cloud_map", c.cloud_map, "map of the same format for the clouds; left out: the clouds of map"),
        sections("clouds", c.clouds,
                 "cloud maps of several instants, in order of time, with interpolation between them; the "
                 "first and last also hold before and after. Replaces cloud_map"),
        integer("cloud_seed", c.cloud_seed, {0, 1e9}, "seed of invented clouds; 0: the clouds of a map"),
        number("lights", c.lights, 1, {0, 100}, "factor on city lights at night"),
        sections("ground", c.ground,
                 "surface maps of several months, repeated each year, or of several instants, in order, with "
                 "interpolation between them. Clouds remain those of map or of the cloud keys"),
        sections(
            "layers", c.layers,
            "maps that replace parts of map, read in tiles as needed; they may be far larger than memory"),
        integer("memory_mb", c.memory_mb, {16, 65536},
                "memory for tiles of layers per camera; a frame that needs more is coarser everywhere"),
    };
}

namespace {

void validate_ground(const EarthConfig& c) {
    if (c.map.empty()) throw KeyError("ground", "has no effect without 'map'");
    if (!c.layers.empty())
        throw KeyError("ground", "and 'layers' both say what the surface is; accepted: one of them");
    for (std::size_t i = 1; i < c.ground.size(); ++i) {
        const EarthGroundConfig &before = c.ground[i - 1], &now = c.ground[i];
        const std::string key = "ground." + std::to_string(i) + ".";
        if ((before.month == 0) != (now.month == 0))
            throw KeyError(
                key + (now.month == 0 ? "at_utc" : "month"),
                "is of another kind than the map before has; accepted: all months, or all instants");
        if (now.month != 0 && now.month <= before.month)
            throw KeyError(key + "month", "found " + std::to_string(now.month) +
                                              "; accepted: later than the map before, " +
                                              std::to_string(before.month));
        if (now.month == 0 && !(parse_utc(before.at_utc) < parse_utc(now.at_utc)))
            throw KeyError(key + "at_utc",
                           "found " + now.at_utc + "; accepted: later than the map before, " + before.at_utc);
    }
}

}  // namespace

void validate(const EarthConfig& c) {
    if (!c.ground.empty()) validate_ground(c);
    if (c.map.empty() && !c.cloud_map.empty()) throw KeyError("cloud_map", "has no effect without 'map'");
    if (c.map.empty() && c.cloud_seed != 0) throw KeyError("cloud_seed", "has no effect without 'map'");
    if (!c.cloud_map.empty() && c.cloud_seed != 0)
        throw KeyError("cloud_seed", "and 'cloud_map' both say where clouds are; accepted: one of them");
    if (c.map.empty() && !c.layers.empty()) throw KeyError("layers", "has no effect without 'map'");
    bool has_clouds = false;
    for (std::size_t i = 0; i < c.layers.size(); ++i) {
        using Kind = EarthLayerConfig::Kind;
        const Kind kind = c.layers[i].kind;
        for (std::size_t k = 0; k < i; ++k)
            if (c.layers[k].kind == kind)
                throw KeyError("layers." + std::to_string(i) + ".kind",
                               "is that of layers." + std::to_string(k) + "; accepted: one layer of a kind");
        if (kind != Kind::kClouds && kind != Kind::kCloudThickness && kind != Kind::kCloudTops) continue;
        if (!c.cloud_map.empty() || c.cloud_seed != 0 || !c.clouds.empty())
            throw KeyError("layers." + std::to_string(i) + ".kind",
                           "and another key both say where clouds are; accepted: one of them");
        if (kind != Kind::kCloudTops && has_clouds)
            throw KeyError("layers." + std::to_string(i) + ".kind",
                           "another layer says where clouds are, too; accepted: clouds or cloud_thickness");
        has_clouds = has_clouds || kind != Kind::kCloudTops;
    }
    if (c.clouds.empty()) return;
    if (c.map.empty()) throw KeyError("clouds", "has no effect without 'map'");
    if (!c.cloud_map.empty() || c.cloud_seed != 0)
        throw KeyError("clouds", std::string("and '") + (c.cloud_seed != 0 ? "cloud_seed" : "cloud_map") +
                                     "' both say where clouds are; accepted: one of them");
    for (std::size_t i = 1; i < c.clouds.size(); ++i)
        if (!(parse_utc(c.clouds[i - 1].at_utc) < parse_utc(c.clouds[i].at_utc)))
            throw KeyError("clouds." + std::to_string(i) + ".at_utc",
                           "found " + c.clouds[i].at_utc + "; accepted: later than the map before, " +
                               c.clouds[i - 1].at_utc);
}

}  // namespace hilcam
