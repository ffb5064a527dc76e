#pragma once
// Automatic exposure: the camera sets its own exposure time from the frames it has taken.

#include "render/config_field.h"

namespace hilcam {

struct AutoExposureConfig {
    bool on = false;
    double target_fraction = 0.5;  // of full scale, of the percentile below
    double percentile = 99;        // of the frame's pixels
    double speed = 0.5;            // share of the way, in stops, that each frame goes; 1: at once
    double tolerance_stops = 0.1;  // nothing is changed within this
};
Fields fields(AutoExposureConfig& config);

}  // namespace hilcam
