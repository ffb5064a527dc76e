#pragma once
// The optics turn light at the aperture into mean electrons: the S of equation (2).
//
// For an extended source with spectral radiance L, a pixel at field angle theta sees the solid angle pitch^2
// cos^3 / f^2 through the projected aperture A cos, so
//     electrons = sum over bins  L dlambda A (pitch/f)^2 fill cos^4(theta) T QE t lambda / (h c).
// For f much larger than the aperture this is the textbook's pi L T / (4 N^2) cos^4 (Boreman, Basic
// Electro-Optics for Electrical Engineers, SPIE, 1998, ch. 2); 1/(4 N^2) replaces 1/(4 N^2 + 1), 1.5 % at
// f/4, because the data sheet's f-number is taken as that of the solid angle. Another cos_power n replaces
// the 4, and vignetting is an additional factor. A point source with irradiance E gives
//     electrons = sum over bins  E dlambda A R (Omega_0 / Omega) T QE t lambda / (h c),
// times the fill factor on average,
// with R the relative illumination, Omega the solid angle of a pixel at its place, and Omega_0 that on the
// axis. A dense field of points and a uniform field thus agree through any lens.

#include <vector>

#include "render/vocabulary/spectrum.h"
#include "sensor/camera_model.h"

namespace hilcam {

// Returns the aperture area [m^2] that neither the central obscuration nor a spider's vanes cover.
double aperture_area_m2(const CameraModel& camera);

// Return the camera's data that the room stray/ needs.
SpiderPupil spider_pupil(const CameraModel& camera);
OutsideLens outside_lens(const CameraModel& camera);

// Returns the transmission of glass and filters at a wavelength; with a T-number, (N / T)^2 at all
// wavelengths.
double lens_transmission(const CameraModel& camera, double wavelength_um);

// Returns electrons per second and unit of on-axis spectral radiance [W m^-2 sr^-1 um^-1] for each bin,
// including the fill factor. filter: from a colour filter array, or null.
Spectrum electrons_per_s_per_radiance(const CameraModel& camera, const SpectralGrid& grid,
                                      const Curve* filter = nullptr);
// Returns the same for each channel of the detector: one channel, or one for each colour filter.
std::vector<Spectrum> channel_responses(const CameraModel& camera, const SpectralGrid& grid);
// Returns electrons per second and unit of on-axis spectral irradiance of a point [W m^-2 um^-1] for each
// bin, without the fill factor.
Spectrum electrons_per_s_per_irradiance(const CameraModel& camera, const SpectralGrid& grid,
                                        const Curve* filter = nullptr);

// The relative illumination of the image by the lens at a place [px of the geometry]: 1 on the axis.
class RelativeIllumination {
  public:
    RelativeIllumination(const CameraModel& camera, const ImageGeometry& geometry);
    // Returns the factor for an extended source.
    double at(double x_px, double y_px) const;
    // Returns the factor for a point source.
    double of_point(double x_px, double y_px) const;
    // Returns the image height over that of the sensor's farthest corner, 0 .. 1 on the sensor. All lines of
    // a line camera are on the axis.
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
