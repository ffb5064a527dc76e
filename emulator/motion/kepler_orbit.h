#pragma once
// Unperturbed motion about a centre from Kepler's elements: ellipses and hyperbolas. Vallado, Fundamentals of
// Astrodynamics and Applications, 4th ed., 2013, chapter 2.

#include "render/sky/bodies.h"

namespace hilcam {

// Angles refer to ICRF's equator and x axis.
struct KeplerElements {
    double semi_major_axis_m = 7e6;  // negative: a hyperbola
    double eccentricity = 0;         // any but 1
    double inclination_rad = 0;
    double node_rad = 0;          // right ascension of the ascending node
    double periapsis_rad = 0;     // argument of the periapsis
    double mean_anomaly_rad = 0;  // at epoch
};

// Returns the eccentric anomaly E with E - e sin E = M (e < 1), to rounding, by Newton steps inside a
// bracket; for a hyperbola F with e sinh F - F = M.
double eccentric_anomaly(double mean_anomaly_rad, double eccentricity);
// Returns the mean anomaly for a true anomaly, which must be inside the asymptotes of a hyperbola.
double mean_anomaly(double true_anomaly_rad, double eccentricity);

class KeplerOrbit {
  public:
    // Requires gravity_m3_s2 > 0, a (1 - e) > 0 and e != 1; throws InputError otherwise.
    KeplerOrbit(const KeplerElements& elements, double gravity_m3_s2);
    // Returns the state about the centre in ICRF axes. seconds: since epoch. Loop.
    StateVector at(double seconds) const;

  private:
    KeplerElements elements_;
    double gravity_m3_s2_, mean_motion_rad_s_;
    Vec3d periapsis_dir_, across_dir_;
};

}  // namespace hilcam
