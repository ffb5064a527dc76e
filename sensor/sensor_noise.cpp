#include "sensor/sensor_noise.h"

#include <cmath>

#include "render/vocabulary/units.h"

namespace hilcam {

SensorNoise::SensorNoise(const CameraModel& c, double gain_db)
    : floor_e2_(square(c.dark_noise_e()) + 1 / (12 * square(c.system_gain_dn_e(gain_db))) + square(c.dsnu_e) +
                square(c.fixed_pattern.row_e) + square(c.fixed_pattern.column_e)),
      dark_share2_(square(c.fixed_pattern.dark_current_fraction)),
      light_share2_(square(c.prnu_fraction) + square(c.fixed_pattern.column_gain_fraction)) {}

double SensorNoise::variance_e2(double mean_e, double dark_e) const {
    return mean_e + floor_e2_ + dark_share2_ * square(dark_e) + light_share2_ * square(mean_e - dark_e);
}

double SensorNoise::sigma_e(double mean_e, double dark_e) const {
    return std::sqrt(variance_e2(mean_e, dark_e));
}

}  // namespace hilcam
