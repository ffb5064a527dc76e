#include "sensor/optics.h"

#include <cmath>

#include "render/units.h"

namespace hilcam {

double aperture_area_m2(const CameraModel& c) {
    const double d = c.aperture_diameter_m();
    return kPi / 4 * d * d * (1 - c.central_obscuration_ratio * c.central_obscuration_ratio);
}

Spectrum electrons_per_s_per_irradiance(const CameraModel& c, const SpectralGrid& grid) {
    const double area_m2 = aperture_area_m2(c);
    Spectrum out;
    for (int b = 0; b < grid.size(); ++b) {
        // Integral of T QE lambda over the bin; Simpson on 32 pieces, curves are linear between their knots.
        constexpr int kPieces = 32;
        const double step = grid.width_um(b) / kPieces;
        double electrons_per_joule_um = 0;
        for (int i = 0; i <= kPieces; ++i) {
            const double wavelength_um = grid.from_um(b) + i * step;
            const double factor = i == 0 || i == kPieces ? 1 : (i % 2 ? 4 : 2);
            electrons_per_joule_um += factor * step / 3 * c.transmission.at(wavelength_um) *
                                      c.quantum_efficiency.at(wavelength_um) / photon_energy_j(wavelength_um);
        }
        out[b] = static_cast<float>(area_m2 * electrons_per_joule_um);
    }
    return out;
}

Spectrum electrons_per_s_per_radiance(const CameraModel& c, const SpectralGrid& grid) {
    const double pixel_rad = c.pitch_m / c.focal_length_m;
    Spectrum out = electrons_per_s_per_irradiance(c, grid);
    for (float& value : out.bin) value *= static_cast<float>(pixel_rad * pixel_rad * c.fill_factor);
    return out;
}

double cos_falloff(const ImageGeometry& geometry, double x_px, double y_px, double power) {
    const Vec3d d = geometry.direction_camera(x_px, y_px);
    return std::pow(1 / length(d), power);
}

}  // namespace hilcam
