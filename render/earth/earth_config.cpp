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
    };
}

void validate(const EarthConfig& c) {
    if (c.map.empty() && !c.cloud_map.empty()) throw KeyError("cloud_map", "has no effect without 'map'");
    if (c.map.empty() && c.cloud_seed != 0) throw KeyError("cloud_seed", "has no effect without 'map'");
    if (!c.cloud_map.empty() && c.cloud_seed != 0)
        throw KeyError("cloud_seed", "and 'cloud_map' both say where clouds are; accepted: one of them");
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
