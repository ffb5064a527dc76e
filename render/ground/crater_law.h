#pragma once
// The number of craters: what has formed since the ground was new, or what remains in equilibrium, where new
// craters erase old ones. Cumulative numbers per square metre above a diameter.

#include <vector>

namespace hilcam {

// The Moon's production function at an age of 1 Ga, 10 m to 300 km (Neukum, Ivanov and Hartmann, Space Sci.
// Rev. 96, 55, 2001, table 1, "new"); smaller diameters continue its slope at 10 m.
double neukum_per_m2(double diameter_m);
// Its factor for another age: N(1 km) of the Moon's chronology over that of 1 Ga (same paper, eq. 5).
double neukum_age_factor(double age_ga);
// The equilibrium density, 10^-1.1 D^-2 (Trask, JPL Tech. Rep. 32-800, 252, 1966).
double equilibrium_per_m2(double diameter_m);

// The smaller of the two at each diameter, tabulated between two diameters, with its inverse.
class CraterLaw {
  public:
    CraterLaw(double age_ga, double smallest_m, double largest_m);
    // Returns the number per square metre above a diameter; constant outside the table.
    double per_m2(double diameter_m) const;
    // Returns the diameter above which there are this many.
    double diameter_m(double per_m2) const;
    double age_factor() const { return age_factor_; }

  private:
    double age_factor_;
    std::vector<double> log_diameter_, log_number_;  // base 10; the numbers decrease
};

}  // namespace hilcam
