#pragma once
// From light at the aperture to mean electrons: the S of equation (2).
//
// Extended source of spectral radiance L: a pixel at field angle theta sees the solid angle pitch^2 cos^3 /
// f^2 through the projected aperture A cos, so
//     electrons = sum over bins  L dlambda A (pitch/f)^2 fill cos^4(theta) T QE t lambda / (h c).
// For f much larger than the aperture this is the textbook pi L T / (4 N^2) cos^4 (Boreman, Basic
// Electro-Optics for Electrical Engineers, SPIE, 1998, ch. 2); 1/(4 N^2) stands for 1/(4 N^2 + 1), 1.5 % at
// f/4, the data sheet's f-number taken as that of the solid angle. Another cos_power n replaces the 4. A
// point source of irradiance E gives
//     electrons = sum over bins  E dlambda A cos^(n-3)(theta) T QE t lambda / (h c), times fill on average,
// so that a dense field of points and a uniform field agree.

#include "render/spectrum.h"
#include "sensor/camera_model.h"

namespace hilcam {

// Unobscured aperture area [m^2].
double aperture_area_m2(const CameraModel& camera);

// Electrons per second and unit of on-axis spectral radiance [W m^-2 sr^-1 um^-1], per bin; fill factor
// included.
Spectrum electrons_per_s_per_radiance(const CameraModel& camera, const SpectralGrid& grid);
// Electrons per second and unit of on-axis spectral irradiance of a point [W m^-2 um^-1], per bin; without
// fill factor.
Spectrum electrons_per_s_per_irradiance(const CameraModel& camera, const SpectralGrid& grid);

// cos^power of the field angle at a point of the image [px of the sensor frame].
double cos_falloff(const ImageGeometry& geometry, double x_px, double y_px, double power);

}  // namespace hilcam
