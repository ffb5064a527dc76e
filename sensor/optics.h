#pragma once
// The optics turn light at the aperture into mean electrons: the S of equation (2).
//
// Extended source of spectral radiance L: a pixel at field angle theta sees the solid angle pitch^2 cos^3 /
// f^2 through the projected aperture A cos, so
//     electrons = sum over bins  L dlambda A (pitch/f)^2 fill cos^4(theta) T QE t lambda / (h c).
// For f much larger than the aperture this is the textbook pi L T / (4 N^2) cos^4 (Boreman, Basic
// Electro-Optics for Electrical Engineers, SPIE, 1998, ch. 2); 1/(4 N^2) stands for 1/(4 N^2 + 1), 1.5 % at
// f/4, the data sheet's f-number taken as that of the solid angle. Another cos_power n replaces the 4, and
// vignetting multiplies it. A point source of irradiance E gives
//     electrons = sum over bins  E dlambda A R (Omega_0 / Omega) T QE t lambda / (h c), times fill on
//     average,
// R the relative illumination and Omega the solid angle of a pixel at its place (Omega_0 on the axis), so
// that a dense field of points and a uniform field agree through any lens.

#include <vector>

#include "render/vocabulary/spectrum.h"
#include "sensor/camera_model.h"

namespace hilcam {

// Aperture area [m^2] that neither the central obscuration nor a spider's vanes cover.
double aperture_area_m2(const CameraModel& camera);

// These give the figures of a camera that the room of stray light uses.
SpiderPupil spider_pupil(const CameraModel& camera);
OutsideLens outside_lens(const CameraModel& camera);

// Glass and filters at a wavelength; with a T-number (N / T)^2 at all of them.
double lens_transmission(const CameraModel& camera, double wavelength_um);

// Electrons per second and unit of on-axis spectral radiance [W m^-2 sr^-1 um^-1], per bin; fill factor
// included. filter: of a colour filter array, or null.
Spectrum electrons_per_s_per_radiance(const CameraModel& camera, const SpectralGrid& grid,
                                      const Curve* filter = nullptr);
// The same of each channel of the detector: of all of it, or of each colour filter.
std::vector<Spectrum> channel_responses(const CameraModel& camera, const SpectralGrid& grid);
// Electrons per second and unit of on-axis spectral irradiance of a point [W m^-2 um^-1], per bin; without
// fill factor.
Spectrum electrons_per_s_per_irradiance(const CameraModel& camera, const SpectralGrid& grid,
                                        const Curve* filter = nullptr);

// The lens illuminates the image at a place [px of the geometry] by this factor, 1 on the axis.
class RelativeIllumination {
  public:
    RelativeIllumination(const CameraModel& camera, const ImageGeometry& geometry);
    // Returns the factor for an extended source.
    double at(double x_px, double y_px) const;
    // Returns the factor for a point source.
    double of_point(double x_px, double y_px) const;
    // Image height over that of the sensor's farthest corner, 0 .. 1 on the sensor. All lines of a line
    // camera lie on the axis.
    double field_fraction(double x_px, double y_px) const;

  private:
    double solid_angle(double x_px, double y_px) const;
    double on_sensor(double y_px) const { return one_line_ ? geometry_.center_px().y : y_px; }

    ImageGeometry geometry_;
    bool one_line_;
    double cos_power_;
    Table vignetting_;
    double corner_px_;
    double axis_solid_angle_;
};

}  // namespace hilcam
