#include "sensor/cosmic_rays.h"

namespace hilcam {

Fields fields(CosmicRayConfig& c) {
    return {
        number("rate_cm2_s", c.rate_cm2_s, 1, {0, 1e6}, "particles through the detector"),
        number("depth_um", c.depth_um, 1, {0.1, 1000}, "of silicon that collects charge"),
        number("electrons_per_um", c.electrons_per_um, 1, {1, 1e5}, "along a track"),
        number("spread_fraction", c.spread_fraction, 1, {0, 2}, "of that, from track to track"),
    };
}

}  // namespace hilcam
