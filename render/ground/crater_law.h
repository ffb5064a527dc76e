#pragma once
// The laws of how many craters there are: what has fallen since the ground was new, or what is left of it where new craters have worn
// away the old ones. Cumulative numbers, per square metre, of diameters above one.

#include <vector>

namespace hilcam {

// The Moon's production function at an age of 1 Ga, 10 m to 300 km (Neukum, Ivanov and Hartmann, Space Sci. Rev. 96, 55, 2001,
// table 1, "new"); below, on with its slope at 10 m.
double neukum_per_m2(double diameter_m);
// Its factor at another age: N(1 km) of the Moon's chronology over that of 1 Ga (there, eq. 5).
double neukum_age_factor(double age_ga);
// The density of equilibrium, 10^-1.1 D^-2 (Trask, JPL Tech. Rep. 32-800, 252, 1966).
double equilibrium_per_m2(double diameter_m);

// The lesser of the two at each diameter, as a table between two diameters, with its inverse.
class CraterLaw {
  public:
    CraterLaw(double age_ga, double smallest_m, double largest_m);
    // Number per square metre of diameters above one; constant beyond the table.
    double per_m2(double diameter_m) const;
    // The diameter above which there are so many.
    double diameter_m(double per_m2) const;
    double age_factor() const { return age_factor_; }

  private:
    double age_factor_;
    std::vector<double> log_diameter_, log_number_;  // base 10; the numbers fall
};

}  // namespace hilcam
