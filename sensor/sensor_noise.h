#pragma once
// A pixel's number is off its mean charge by a noise that the sensor alone makes: shot, read and fixed noise
// together, in electrons. What a rendering error is measured by.
//
// EMVA 1288 Release 4.0 (linear), the noise of its total signal-to-noise ratio:
//   sigma^2 = q + sigma_d^2 + 1/(12 K^2)              shot, all temporal noise in the dark,
//                                                      quantisation
//           + DSNU^2 + rows^2 + columns^2 + (p q_d)^2  fixed, in the dark; p: spread of the dark currents
//           + (PRNU^2 + columns' gains^2) (q - q_d)^2  fixed, with light
// q: mean charge, q_d: its part that is dark current. Fixed noise is that of a pixel drawn at random: what
// one camera's own maps say is not asked. Not counted: defects, cosmic rays, what blooming or late charge
// brings.

#include "sensor/camera_model.h"

namespace hilcam {

class SensorNoise {
  public:
    SensorNoise(const CameraModel& camera, double gain_db);

    // Returns the variance of a pixel with that mean charge [e-, 0 or more], of which dark_e is dark current.
    // Any thread.
    double variance_e2(double mean_e, double dark_e) const;
    double sigma_e(double mean_e, double dark_e) const;

  private:
    double floor_e2_;     // the part that does not depend on the charge
    double dark_share2_;  // squares of shares
    double light_share2_;
};

}  // namespace hilcam
