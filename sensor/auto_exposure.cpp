#include "sensor/auto_exposure.h"

namespace hilcam {

Fields fields(AutoExposureConfig& c) {
    return {
        flag("on", c.on, "the camera sets its exposure time itself"),
        number("target_fraction", c.target_fraction, 1, {0.01, 0.95}, "of full scale, of the percentile"),
        number("percentile", c.percentile, 1, {1, 99.99}, "of the frame's pixels, that is to be there"),
        number("speed", c.speed, 1, {0.01, 1}, "share of the way that a frame goes, in stops"),
        number("tolerance_stops", c.tolerance_stops, 1, {0, 2}, "nothing is changed within"),
    };
}

}  // namespace hilcam
