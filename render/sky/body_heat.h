#pragma once
// The heat of a body, in the thermal bins (spectrum.h), by one of two models.
//
// Grey: a surface in equilibrium with the sunlight that falls on it now, and no colder than its night,
//
//     T^4 = T_night^4 + (T_noon^4 - T_night^4) mu_0.
//
// So the ground cools at once behind the terminator; latitudes and the heat of the ground are not modelled.
//
// Regolith (regolith.h): by latitude and local time, with the heat that the ground keeps; for the Moon.
// Slopes of a relief do not change it.

#include <array>
#include <cstddef>
#include <vector>

#include "render/sky/bodies.h"
#include "render/vocabulary/config_field.h"
#include "render/vocabulary/spectrum.h"

namespace hilcam {

struct BodyHeatConfig {
    enum class Model { kGrey, kRegolith };
    double noon_k = 250, night_k = 250;  // grey
    double emissivity = 0.95;
    Model model = Model::kGrey;
    double albedo = 0.12;       // regolith, of sunlight from the zenith
    bool has_regolith = false;  // true for the Moon, whose ground regolith.h describes
};
// The Moon: Hayne et al., J. Geophys. Res. Planets 122, 2371 (2017). Mercury: Vasavada et al., Icarus 141,
// 179 (1999), equator at 0.39 au. Mars: range of the equator (Kieffer et al., 1977). Others are even, at
// their effective temperature: Venus and Earth (NASA's planetary fact sheets, black-body temperature), giants
// (Pearl & Conrath, J. Geophys. Res. 96, 18921, 1991).
BodyHeatConfig default_heat(BodyId id);
Fields fields(BodyHeatConfig& config);
// Throws KeyError for a night that is hotter than noon, and for regolith on another body than the Moon or
// with an emissivity below 0.5.
void validate(const BodyHeatConfig& config);

class BodyHeat {
  public:
    BodyHeat() = default;  // emits nothing
    BodyHeat(const BodyHeatConfig& config, const SpectralGrid& grid);

    // A place on the body: cosine of the Sun's zenith angle, sine of the latitude, and local time as the
    // angle since noon, positive in the afternoon.
    struct Place {
        float mu0 = 0, sine_latitude = 0, hour_rad = 0;
    };

    bool none() const { return disk_by_degree_.empty(); }
    // Returns the emitted radiance [W m^-2 sr^-1 um^-1]. Loop, any thread.
    Spectrum radiance(const Place& place) const;
    const Spectrum& most() const { return most_; }
    // Returns the irradiance by the whole disk at distance d, over (R/d)^2 [W m^-2 um^-1]: for regolith the
    // mean of a waxing and a waning disk.
    Spectrum disk_w_m2_um(double phase_rad) const;
    // Returns what is reflected of light from all directions; 0 in bins that are not thermal.
    const Spectrum& reflected() const { return reflected_; }
    bool is_thermal(int bin) const { return bin >= solar_bins_; }

  private:
    static constexpr std::size_t kSteps = 128;
    static constexpr std::size_t kLatitudes = 19, kHours = 192;  // each 5 degrees; each an eighth of an hour

    void make_grey(const BodyHeatConfig& config, const SpectralGrid& grid);
    void make_regolith(const BodyHeatConfig& config, const SpectralGrid& grid);
    Spectrum regolith(const Place& place) const;

    std::vector<Spectrum> by_root_;   // by the root of mu_0: T and Planck's law change most in the last light
    std::vector<Spectrum> by_place_;  // by latitude, then by local time from noon on
    Spectrum most_;
    std::vector<Spectrum> disk_by_degree_;
    Spectrum reflected_;
    int solar_bins_ = 0;
};

}  // namespace hilcam
