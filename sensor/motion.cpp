#include "sensor/motion.h"

#include "render/units.h"

namespace hilcam {

Fields fields(JitterConfig& c) {
    return {
        numbers("rms_arcsec", c.rms_rad, kArcsecond_rad, {0, 36000}, {2, 2},
                "about the camera's x and y axes, within any exposure"),
        table("psd", c.psd_rad2_hz, {"hz", "arcsec2_hz"}, {1e-6, 1e6}, {0, 1e12},
              "one-sided power spectral density of each axis"),
    };
}

}  // namespace hilcam
