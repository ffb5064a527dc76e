#pragma once
// What moves the picture during an exposure and from one exposure to the next.
//
// Jitter: Gaussian of a fixed standard deviation, or from a one-sided power spectral density S(f) per axis.
// Of the latter an exposure of T blurs what is faster, with variance
//     integral S(f) (1 - sinc^2(f T)) df        (Lucke, Sirlin, San Martin, "New definitions of pointing
// stability: AC and DC effects", J. Astronautical Sciences 40(4), 1992), and shows the rest as a
// displacement of the whole picture from frame to frame.

#include <cstdint>
#include <vector>

#include "render/config_field.h"
#include "render/random.h"
#include "render/table.h"
#include "render/time.h"

namespace hilcam {

struct JitterConfig {
    std::vector<double> rms_rad = {0, 0};  // about the camera's x and y axes, within any exposure
    Table psd_rad2_hz;                     // f [Hz], S [arcsec^2/Hz] of each axis; empty: none
};
Fields fields(JitterConfig& config);

}  // namespace hilcam
