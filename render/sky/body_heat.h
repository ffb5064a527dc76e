#pragma once
// The heat of a body, in the thermal bins (spectrum.h): it emits as a grey surface in equilibrium with the
// sunlight that falls on it now, and no colder than its night,
//
//     T^4 = T_night^4 + (T_noon^4 - T_night^4) mu_0.
//
// So the ground cools at once behind the terminator. Clouds, latitudes and the heat of the ground are not
// modelled.

#include <array>
#include <cstddef>
#include <vector>

#include "render/sky/bodies.h"
#include "render/vocabulary/config_field.h"
#include "render/vocabulary/spectrum.h"

namespace hilcam {

struct BodyHeatConfig {
    double noon_k = 250, night_k = 250;
    double emissivity = 0.95;
};
// The Moon: Hayne et al., J. Geophys. Res. Planets 122, 2371 (2017). Mercury: Vasavada et al., Icarus 141,
// 179 (1999), equator at 0.39 au. Mars: range of the equator (Kieffer et al., 1977). Others are even, at
// their effective temperature: Venus and Earth (NASA's planetary fact sheets, black-body temperature), giants
// (Pearl & Conrath, J. Geophys. Res. 96, 18921, 1991).
BodyHeatConfig default_heat(BodyId id);
Fields fields(BodyHeatConfig& config);
// Throws KeyError for a night that is hotter than noon.
void validate(const BodyHeatConfig& config);

class BodyHeat {
  public:
    BodyHeat() = default;  // emits nothing
    BodyHeat(const BodyHeatConfig& config, const SpectralGrid& grid);

    bool none() const { return by_root_.empty(); }
    // Returns the emitted radiance [W m^-2 sr^-1 um^-1] by the cosine of the Sun's zenith angle. Loop, any
    // thread.
    Spectrum radiance(float mu0) const;
    const Spectrum& most() const { return by_root_.back(); }
    // Returns the irradiance by the whole disk at distance d, over (R/d)^2 [W m^-2 um^-1].
    Spectrum disk_w_m2_um(double phase_rad) const;
    // Returns what is reflected of light from all directions; 0 in bins that are not thermal.
    const Spectrum& reflected() const { return reflected_; }
    bool is_thermal(int bin) const { return bin >= solar_bins_; }

  private:
    static constexpr std::size_t kSteps = 128;
    std::vector<Spectrum> by_root_;  // by the root of mu_0: T and Planck's law change most in the last light
    std::vector<Spectrum> disk_by_degree_;
    Spectrum reflected_;
    int solar_bins_ = 0;
};

}  // namespace hilcam
