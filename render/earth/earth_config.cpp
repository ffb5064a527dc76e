#include "render/earth/earth_config.h"

#include "render/vocabulary/time.h"

namespace hilcam {

Fields fields(CloudsConfig& c) {
    return {
        required(path("map", c.map, "map of the same form as earth_surface.map, whose clouds are used")),
        required(text("at_utc", c.at_utc, "its instant, UTC: YYYY-MM-DDThh:mm:ss[.f]Z")),
    };
}

void validate(const CloudsConfig& c) {
    at_key("at_utc", [&] { parse_utc(c.at_utc); });
}

Fields fields(EarthGroundConfig& c) {
    return {
        required(
            path("map", c.map,
                 "map of the same form as earth_surface.map, whose land, ice, water and lights are used")),
        integer("month", c.month, {0, 12}, "its month, each year, 1 to 12; 0: at_utc says when it is"),
        text("at_utc", c.at_utc, "its instant, UTC: YYYY-MM-DDThh:mm:ss[.f]Z"),
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
                      "(Cloud-optimised, too), or a picture (.png) from 180 W and 90 N on; large ones need "
                      "overviews (gdaladdo)")),
        required(choice(
            "kind", c.kind,
            {"land", "infrared", "water", "clouds", "cloud_thickness", "cloud_tops", "lights"},
            "meaning of its values, after coding, scale and offset. land: reflectance in red, green and "
            "blue; infrared: that from 0.72 um on (left out: told from the colours); water: share of "
            "the ground; clouds: white of a picture, 0 to 1; cloud_thickness: optical thickness; "
            "cloud_tops: height [m]; lights: share of the brightest")),
        choice("coding", c.coding, {"linear", "srgb", "blue_marble"},
               "srgb: values of 0 to 255 are codes of sRGB, which stand for 0 to 1, before scale and offset; "
               "blue_marble: so are they, and NASA's Blue Marble, whose colours become reflectances as "
               "tools/make_earth_map.py has it (land alone)"),
        number("scale", c.scale, 1, {-1e9, 1e9}, "factor on the file's values, beside the file's own"),
        number("offset", c.offset, 1, {-1e9, 1e9}, "number that is added to that"),
        numbers(
            "bounds_deg", c.bounds_deg, 1, {-360, 540}, {0, 4},
            "[west, south, east, north] of the outer edges of a file without a projection, the whole Earth"),
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
             "map of land, water, clouds and lights, as the source tree's tools/make_earth_map.py makes it; "
             "left out: the "
             "Earth is "
             "earth.albedo or earth.albedo_map"),
        number("wind_m_s", c.wind_m_s, 1, {0, 30},
               "wind over all seas at 12.5 m, which makes the glint wide"),
        number("cloud_thickness", c.cloud_thickness, 1, {0, 10},
               "factor on the clouds' optical thickness; 0: no clouds"),
        path("cloud_map", c.cloud_map,
             "another map of the same form, whose clouds are used; left out: those of map"),
        sections(
            "clouds", c.clouds,
            "cloud maps of several instants, in the order of time: between two of them each place has their "
            "mean by time, before the first and after the last that map stays; in place of cloud_map"),
        integer("cloud_seed", c.cloud_seed, {0, 1e9}, "seed of invented clouds; 0: those of a map"),
        number("lights", c.lights, 1, {0, 100}, "factor on the light of cities at night"),
        sections(
            "ground", c.ground,
            "surface maps of several months, which come again each year, or of several instants, in their "
            "order: "
            "between two of them each place has their mean by time; clouds stay those of map or of the other "
            "keys"),
        sections(
            "layers", c.layers,
            "maps that take the place of parts of map, and may be far larger than memory: tiles of them are "
            "read as they are looked at"),
        integer("memory_mb", c.memory_mb, {16, 65536},
                "memory for tiles of layers, of each camera; where a frame needs more, all of it is coarser"),
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
