#pragma once
// The brightness of the Moon and the planets: a reflection law for the surface, scaled to the measured
// magnitude of the whole disk. docs/bodies.md explains the choices.
//
// A surface element sends L = E_s c(g) law(mu_0, mu): Lambert mu_0 / pi, or Lommel-Seeliger mu_0 / (4 pi
// (mu_0 + mu)). The factor c(g), a function of the phase angle g at the element, gives the disk of a distant
// body its V magnitude:
// - Planets: Mallama & Hilton, Astronomy and Computing 25 (2018), without the terms of rotation and season. A
// flattened body has the law's light when seen from its equator; disk_light.h has the rest: its shape,
// Uranus' poles, Saturn's rings.
// - The Moon: Allen (Krisciunas & Schaefer, PASP 103, 1991, eq. 9).
// - The Earth has no such law: its albedo and map define it.
// - V of the Sun at 1 au: -26.76 (Willmer, ApJS 236, 2018).
//
// Colour: the ratio of reflectances at B (0.44 um) and V (0.55 um) from the B-V index (Explanatory Supplement
// to the Astronomical Almanac, 1992, table 15.8; Sun 0.653, Ramirez et al., ApJ 752, 2012), extrapolated
// linearly to 0.65 um and constant beyond. Bands of methane, which make Uranus and Neptune several times
// darker beyond 0.7 um, are missing. The Moon's colour is ROLO's at 30 deg of phase (below), relative to V.
//
// In thermal bins a body reflects as a Lambert surface what its emissivity leaves (body_heat.h).
//
// Alternatively Hapke's law (render/brdf/hapke.h), L = E_s mu_0 f, without a magnitude. The Moon is that of
// LROC's Wide Angle Camera, Sato et al., J. Geophys. Res. Planets 119, 1775 (2014), with the medians of their
// maps at 643 nm (archived as WAC_HAPKEPARAMMAP) between 30 S and 30 N: w 0.3854, b 0.2375, h_s 0.0672;
// roughness 23.657 deg and no coherent backscatter everywhere; c by their eq. 2 and the surge by their eq. 4
// from these, 0.3253 and 1.686; and, like theirs, a porosity factor of 1. The reflectance of these medians is
// about 10 % above the median of reflectances, which the map's scale corrects (tools/make_moon_map.py).
//
// Only the colour is from elsewhere: w at other wavelengths gives a sphere the ratio of reflectance to that
// at 643 nm which ROLO has at 30 deg of phase (Kieffer & Stone, Astron. J. 129, 2887, 2005, table 4, means of
// neighbouring bands and of waxing and waning). So the scale at 643 nm and the phase curve in all bands can
// be compared with ROLO independently; the colour at 30 deg cannot.

#include <array>
#include <filesystem>

#include "render/brdf/hapke.h"
#include "render/sky/bodies.h"
#include "render/sky/body_heat.h"
#include "render/vocabulary/config_field.h"
#include "render/vocabulary/spectrum.h"

namespace hilcam {

enum class SurfaceLaw { kLambert, kLommelSeeliger, kHapke };
// Latitudes of a map: angle of the ellipsoid's normal to the equator, or of the line from the body's middle.
enum class MapLatitude { kPlanetographic, kPlanetocentric };

// Hapke's law without w; the defaults are the Moon's.
struct RegolithConfig {
    double lobe_width = 0.2375, lobe_backward = 0.3253;
    double surge_amplitude = 1.686, surge_width = 0.0672;
    double slope_rad = 23.657 * kDegree_rad;
};
Fields fields(RegolithConfig& regolith);

struct BodyConfig {
    bool visible = true;
    bool has_visible = false;  // given: in free space bodies are shown only if asked for
    SurfaceLaw law = SurfaceLaw::kLambert;
    bool measured_magnitude = false;    // c(g) from the measured magnitude; `albedo` is then a factor
    Curve albedo = Curve::constant(1);  // Lambert: albedo; Lommel-Seeliger: w, 8 times the normal reflectance
    bool has_albedo = false, has_measured = false;
    RegolithConfig regolith;
    std::filesystem::path albedo_map;  // equirectangular, left edge 180 W, top 90 N
    MapLatitude albedo_map_latitudes = MapLatitude::kPlanetographic;
    double albedo_map_reference = 0;   // linear value of the map that has the law's light; 0: its mean
    std::filesystem::path height_map;  // same layout; height is value x step + zero
    double height_step_m = 1, height_zero_m = 0;
    bool planetshine = false;
    bool rings = false;
    BodyHeatConfig heat;
};
// Returns the body's own defaults, and the keys of its section.
BodyConfig default_body(BodyId id);
Fields fields(BodyConfig& config);
// Throws KeyError for keys that contradict each other.
void validate(const BodyConfig& config);

// A body's look on the run's spectral grid.
class BodyLook {
  public:
    BodyLook() = default;  // black
    BodyLook(BodyId id, const BodyConfig& config, const SpectralGrid& grid);

    // Returns law(mu_0, mu) c(g) per unit of solar irradiance at the body [sr^-1]; zero for mu_0 <= 0.
    // cos_phase: between the directions to Sun and viewer.
    Spectrum reflectance_sr(float mu0, float mu, float cos_phase) const;
    // Returns the irradiance of the whole disk at distance d, over (R/d)^2 and the solar irradiance at the
    // body: geometric albedo times phase function.
    Spectrum disk_albedo(double phase_rad) const;
    // The same for a colourless body, without the factor `albedo`.
    double disk_brightness(double phase_rad) const;
    bool is_measured() const { return measured_; }
    SurfaceLaw law() const { return law_; }
    bool plain_lambert() const { return law_ == SurfaceLaw::kLambert && !measured_; }
    bool is_hapke() const { return law_ == SurfaceLaw::kHapke; }
    const Spectrum& albedo() const { return albedo_; }
    const BodyHeat& heat() const { return heat_; }
    // Returns an upper bound of what an element sends per unit of irradiance [sr^-1].
    Spectrum max_sr() const;

  private:
    float coefficient(double phase_rad) const;
    Spectrum solar_reflectance_sr(float mu0, float mu, float cos_phase) const;
    void integrate_disk();

    SurfaceLaw law_ = SurfaceLaw::kLambert;
    bool measured_ = false;
    Spectrum albedo_;
    BodyHeat heat_;
    std::array<float, 182> by_degree_{};  // c at 0, 1, ... 180 degrees
    HapkeParameters hapke_;
    int bins_ = 0;
    std::vector<Spectrum> disk_by_degree_;  // for Hapke's law: disk_albedo() at 0, 1, ... 181 degrees
};

// Disk-integrated phase functions of a sphere, 1 at zero phase: Lambert 1760; Seeliger 1887 (Hapke 2012,
// 6.6).
double lambert_phase(double phase_rad);
double lommel_seeliger_phase(double phase_rad);
// Returns the geometric albedo of a sphere with c(0) = 1 (2/3 for Lambert, 1/8 for Lommel-Seeliger), times
// its phase function.
double sphere_brightness(SurfaceLaw law, double phase_rad);
// Returns the V magnitude at 1 au from Sun and observer; Saturn's is without rings. HILCAM_CHECK: not for the
// Earth.
double magnitude_v_1au(BodyId id, double phase_rad);
// Returns the flux of a V magnitude at 1 au over that of the Sun at 1 au, times au^2: a disk's area times its
// geometric albedo and phase function, over pi [m^2].
double disk_m2_of_magnitude(double magnitude_v_1au);

}  // namespace hilcam
