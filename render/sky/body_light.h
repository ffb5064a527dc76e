#pragma once
// The brightness of the Moon and the planets: a reflection law for the surface, tied to the measured
// magnitude of the whole disk.
//
// A surface element sends L = E_s c(g) law(mu_0, mu): Lambert mu_0 / pi, or Lommel-Seeliger mu_0 / (4 pi
// (mu_0 + mu)). c(g), a function of the phase angle g at the element, makes the disk of a distant body as
// bright as its V magnitude says: Mallama & Hilton, Astronomy and Computing 25 (2018), without the terms of
// rotation and season; Saturn without its rings; the Moon by Allen (Krisciunas & Schaefer, PASP 103, 1991,
// eq. 9). The Earth has no such law: its albedo and map say all. V of the Sun at 1 au: -26.76 (Willmer, ApJS
// 236, 2018). Colour: the ratio of reflectances at B (0.44 um) and V (0.55 um) from the B-V index
// (Explanatory Supplement to the Astronomical Almanac, 1992, table 15.8; Sun 0.653, Ramirez et al., ApJ 752,
// 2012), straight on to 0.65 um and flat beyond. What is not in it: bands of methane, which make Uranus and
// Neptune several times darker beyond 0.7 um.

#include <array>
#include <filesystem>

#include "render/sky/bodies.h"
#include "render/vocabulary/config_field.h"
#include "render/vocabulary/spectrum.h"

namespace hilcam {

enum class SurfaceLaw { kLambert, kLommelSeeliger };

struct BodyConfig {
    bool visible = true;
    bool has_visible = false;  // given: in free space nothing is shown that is not asked for
    SurfaceLaw law = SurfaceLaw::kLambert;
    bool measured_magnitude = false;    // c(g) from the measured magnitude; `albedo` is then a factor
    Curve albedo = Curve::constant(1);  // Lambert: albedo; Lommel-Seeliger: w, 8 times the normal reflectance
    std::filesystem::path albedo_map;   // equirectangular, left edge 180 W, top 90 N
};
// The keys of a body's section; defaults are the body's own.
BodyConfig default_body(BodyId id);
Fields fields(BodyConfig& config);

// The look of a body on the run's spectral grid.
class BodyLook {
  public:
    BodyLook() = default;  // black
    BodyLook(BodyId id, const BodyConfig& config, const SpectralGrid& grid);

    // law(mu_0, mu) c(g) per unit of solar irradiance at the body [sr^-1]; zero for mu_0 <= 0. cos_phase:
    // between the directions to Sun and viewer.
    Spectrum reflectance_sr(float mu0, float mu, float cos_phase) const;
    // Irradiance of the whole disk at distance d, over (R/d)^2 and the solar irradiance at the body:
    // geometric albedo times phase function.
    Spectrum disk_albedo(double phase_rad) const;
    bool plain_lambert() const { return law_ == SurfaceLaw::kLambert && !measured_; }
    const Spectrum& albedo() const { return albedo_; }

  private:
    float coefficient(double phase_rad) const;

    SurfaceLaw law_ = SurfaceLaw::kLambert;
    bool measured_ = false;
    Spectrum albedo_;
    std::array<float, 182> by_degree_{};  // c at 0, 1, ... 180 degrees
};

// Disk-integrated phase functions of a sphere, 1 at zero phase: Lambert 1760; Seeliger 1887 (Hapke
// 2012, 6.6).
double lambert_phase(double phase_rad);
double lommel_seeliger_phase(double phase_rad);
// V magnitude at 1 au from Sun and observer. HILCAM_CHECK: not for the Earth.
double magnitude_v_1au(BodyId id, double phase_rad);

}  // namespace hilcam
