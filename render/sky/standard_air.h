#pragma once
// The layers of the U.S. Standard Atmosphere 1976 (NOAA, NASA, USAF, NOAA-S/T 76-1562): how dense the air is and where its
// ozone lies, by geometric height.
//
//   density  below 86 km the standard's layers in closed form (eqs. 18, 33a, 33b, table 4), on which all its other tables rest;
//            from there to 100 km its table I, straight in the logarithm
//   ozone    its mid-latitude model (part 3; Krueger & Minzner, J. Geophys. Res. 81, 4477, 1976), 2 to 74 km in steps of 2 km,
//            linear between; as much below 2 km as there, none above 74 km
// The real air differs by latitude and season, at 45 to 60 km by tens of per cent in polar winters.

namespace hilcam {

// Density over that at sea level: 1 at 0 m. height_m: 0 to 100 km; the ends' values beyond.
double standard_air_density(double height_m);
// Number density of ozone [m^-3]; its column over sea level is 348 Dobson units.
double standard_ozone_m3(double height_m);

}  // namespace hilcam
