#include "emulator/ground/globe_config.h"

namespace hilcam {

Fields fields(GlobeConfig& g) {
    return {
        required(text("body", g.body, "body whose ground it is: one of the program's, or of `bodies`")),
        sections("maps", g.maps,
                 "maps of heights, albedo and other figures by place; where several lie over each other the "
                 "finest counts"),
        section("relief", g.relief, "seeded relief between the posts of the maps; left out: none"),
        section("craters", g.craters, "seeded craters; left out: none"),
        section("boulders", g.boulders, "seeded boulders; left out: none"),
        integer("memory_mb", g.memory_mb, {32, 1'000'000},
                "greatest memory of maps and ground that is kept, beside the triangles in use"),
        number("finest_m", g.finest_m, 1, {1e-3, 1e6}, "least distance of the ground's vertices, about"),
    };
}

}  // namespace hilcam
