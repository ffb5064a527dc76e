#pragma once
// The Earth's axes of date in the models that kernels name: the IAU's precession of 1976 (Lieske et al.,
// Astron. Astrophys. 58, 1, 1977) and nutation of 1980 (Seidelmann, Celest. Mech. 27, 79, 1982), without the
// frame bias.

#include "io/spice/body_orientation.h"

namespace hilcam {

enum class EarthAxes {
    kMeanEquator,   // mean equator and equinox of date
    kTrueEquator,   // true equator and equinox of date
    kMeanEcliptic,  // mean ecliptic and equinox of date
    kTeme           // true equator; x is the mean equinox, projected onto it: SGP4's axes
};

// Returns the axes relative to J2000, with their rate. Loop.
FrameTurn earth_of_date(EarthAxes axes, double et_s);

}  // namespace hilcam
