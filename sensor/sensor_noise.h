#pragma once
// The deviation of a pixel's number from its mean charge that the sensor alone causes: shot, read and fixed
// noise together, in electrons. Rendering errors are measured in this unit.
//
// EMVA 1288 Release 4.0 (linear), the noise in its total signal-to-noise ratio:
//   sigma^2 = q + sigma_d^2 + 1/(12 K^2)               shot noise, temporal dark noise, quantisation
//           + DSNU^2 + rows^2 + columns^2 + (p q_d)^2  fixed, in the dark; p: spread of the dark currents
//           + (PRNU^2 + columns' gains^2) (q - q_d)^2  fixed, with light
// q: mean charge; q_d: its dark current. Fixed noise is that of a randomly chosen pixel, not from the
// camera's own maps. Not included: defects, cosmic rays, effects of blooming or late charge.

#include "sensor/camera_model.h"

namespace hilcam {

class SensorNoise {
  public:
    SensorNoise(const CameraModel& camera, double gain_db);

    // Returns the variance of a pixel with that mean charge [e-, 0 or more], including dark_e of dark
    // current. Any thread.
    double variance_e2(double mean_e, double dark_e) const;
    double sigma_e(double mean_e, double dark_e) const;

  private:
    double floor_e2_;     // part that does not depend on the charge
    double dark_share2_;  // relative variances
    double light_share2_;
};

}  // namespace hilcam
