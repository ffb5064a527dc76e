#include "emulator/ground/globe_config.h"

namespace hilcam {

Fields fields(GlobeConfig& g) {
    return {
        required(text("body", g.body, "body of the ground: a built-in one, or one of `bodies`")),
        sections("maps", g.maps,
                 "maps of heights, albedo and other values by place; where maps overlap, the finest is used"),
        section("relief", g.relief, "seeded relief finer than the maps' posts; left out: none"),
        section("craters", g.craters, "seeded craters; left out: none"),
        section("boulders", g.boulders, "seeded boulders; left out: none"),
        integer("memory_mb", g.memory_mb, {32, 1'000'000},
                "largest memory for cached maps and ground, beside the triangles in use"),
        number("finest_m", g.finest_m, 1, {1e-3, 1e6},
               "approximate smallest distance between ground vertices"),
    };
}

}  // namespace hilcam
