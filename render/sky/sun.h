#pragma once
// The Sun: its spectrum, and its disk with limb darkening.

#include <array>

#include "render/vocabulary/config_field.h"
#include "render/vocabulary/spectrum.h"
#include "render/vocabulary/units.h"

namespace hilcam {

// Returns the Sun's mean spectral irradiance at 1 au over each bin [W m^-2 um^-1]: ASTM G173-03's
// extraterrestrial spectrum (Gueymard, Solar Energy 76, 2004; 1348 W m^-2 to 4 um), stored as means over 5 nm
// to 1.1 um and 20 nm to 2.5 um; beyond it ASTM E490-00a (Kurucz to 4 um, Smith & Gottlieb beyond), to 1 % at
// a wavelength. InputError for a grid that begins below 0.28 um.
Spectrum solar_irradiance_1au_w_m2_um(const SpectralGrid& grid);

struct SunConfig {
    Curve spectrum;  // at 1 au [W m^-2 um^-1]; empty: the table above
    bool has_spectrum = false;
    bool limb_darkening = true;
    // The Sun's position for an origin in free space: given by its direction, or by where its light comes
    // from in the first picture (emulator/scenario/free_space.h).
    Vec3d direction;  // world axes, of any length
    double distance_m = kAstronomicalUnit_m, phase_rad = 0, azimuth_rad = 0;
    bool has_direction = false, has_distance = false, has_phase = false, has_azimuth = false;
};
Fields fields(SunConfig& config);

// Radiance over the disk relative to its mean, by the cosine mu of the angle to the Sun's surface normal: a
// polynomial of fifth degree, Neckel & Labs, Solar Physics 153, 91 (1994), table 2, at the middle of each
// bin; constant outside 0.303-1.099 um. Without limb darkening it is 1.
class SunDisk {
  public:
    SunDisk(const SpectralGrid& grid, bool limb_darkening);

    Spectrum relative_radiance(float mu) const {
        Spectrum out = power_[5];
        for (std::size_t k = 5; k-- > 0;)
            for (int b = 0; b < kMaxBins; ++b) out[b] = out[b] * mu + power_[k][b];
        return out;
    }

  private:
    std::array<Spectrum, 6> power_;
};

}  // namespace hilcam
