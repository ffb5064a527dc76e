#pragma once
// The layers of the U.S. Standard Atmosphere 1976 (NOAA, NASA, USAF, NOAA-S/T 76-1562): the density of the
// air and of its ozone by geometric height.
//
//     density  below 86 km the standard's layers in closed form (eqs. 18, 33a, 33b, table 4), on which its
//              other tables are based; from there to 100 km its table I, linear in the logarithm
//     ozone    its mid-latitude model (part 3; Krueger & Minzner, J. Geophys. Res. 81, 4477, 1976), 2 to
//              74 km in steps of 2 km, linear in between; constant below 2 km, none above 74 km
// Real air differs by latitude and season, at 45 to 60 km by tens of per cent in polar winters.

namespace hilcam {

// Returns the density relative to sea level: 1 at 0 m. height_m: 0 to 100 km, clamped.
double standard_air_density(double height_m);
// Returns the number density of ozone [m^-3]; its column above sea level is 348 Dobson units.
double standard_ozone_m3(double height_m);

}  // namespace hilcam
