#include "sensor/stray_light.h"

namespace hilcam {

Fields fields(StrayLightConfig& c) {
    return {
        number("veiling_glare_fraction", c.veiling_glare_fraction, 1, {0, 0.9},
               "of all light, spread over the picture"),
        number("glare_radius_px", c.glare_radius_px, 1, {0, 10000},
               "r of the halo r / (r^2 + x^2)^1.5; 0: evenly"),
        number("ghost_fraction", c.ghost_fraction, 1, {0, 0.5}, "of a source's light, in its ghost"),
        number("ghost_scale", c.ghost_scale, 1, {-5, 5},
               "the ghost's distance from the principal point over its source's; negative: mirrored"),
        number("ghost_radius_px", c.ghost_radius_px, 1, {8, 2000}, "of the blurred ghost of a point"),
    };
}

}  // namespace hilcam
