#pragma once
// Saturn's rings: a sheet of particles in the plane of its equator.
//
// Light is scattered once. With normal optical depth tau and the cosines mu_0, mu to the plane's normal
//     lit face    L / E = w P / 4 pi mu_0 / (mu_0 + mu) (1 - exp(-tau / mu_0 - tau / mu))
//     other face  L / E = w P / 4 pi mu_0 / (mu_0 - mu) (exp(-tau / mu_0) - exp(-tau / mu))
// which is the integral of what each depth sends, dimmed both ways. It is multiplied by 1.3 (1 + 0.35
// e^(-2.25 a)), with a the phase in degrees, for light between particles and their surge near full phase.
// This factor gives globe and rings, within a few per cent for tilts of 10 to 27 deg, the V magnitude of
// Mallama & Hilton, Astronomy and Computing 25 (2018), eq. 10, whose surge it is. disk_light.h does the rest.
//
// Radii of the rings and of Cassini's and Encke's divisions, and ranges of optical depth: Saturnian Rings
// Fact Sheet, NASA GSFC (NSSDC; C 0.05 to 0.35, B 0.4 to 2.5, Cassini's division 0 to 0.1, A 0.4 to 1.0). Its
// editions' radii differ by up to 170 km: another edition has B from 91 975 to 117 507 and A from 122 340 to
// 136 780 km. Both were read as others quote them; the albedos, from the same sheet, could not be checked.
// Depths between the ends of the ranges are set by hand to look like the rings.
//
// A particle scatters as P(alpha) = c (pi - alpha)^n with n = 3.09, the value that Salo & French (arXiv
// 1007.0349, 2010) use for the rings' particles as others quote them, after Dones, Cuzzi & Showalter, Icarus
// 105, 184, 1993. That paper itself was not at hand; a public ring code has 3.30 from it for Callisto, 7 %
// less at 90 deg of phase. Particles are darker in the blue: w falls by a third from 0.55 to 0.40 um,
// assumed. Not modelled: light from Saturn on the rings, spokes, waves, the D and outer rings.

#include "render/vocabulary/spectrum.h"
#include "render/vocabulary/vec.h"

namespace hilcam {

class SaturnRings {
  public:
    static constexpr double kInner_m = 74658e3, kOuter_m = 136775e3;

    explicit SaturnRings(const SpectralGrid& grid);

    // Where a ray meets the rings, in Saturn's axes.
    struct Met {
        double distance = -1;  // in lengths of the direction; negative: it does not
        Vec3d point_m;
    };
    static Met meet(Vec3d origin_m, Vec3d dir);

    // Radiance per unit of the Sun's irradiance [sr^-1] and transmittance, averaged over a footprint along
    // the radius. Directions are unit vectors from the rings.
    struct Look {
        Spectrum radiance_sr;
        float transmittance = 1;
    };
    Look look(Vec3d point_m, double footprint_m, Vec3d to_viewer, Vec3d to_sun) const;
    // Returns that radiance at one radius, without its colour.
    static double radiance_sr(double radius_m, Vec3d to_viewer, Vec3d to_sun);
    // Returns the transmittance of the rings along a ray that may cross them.
    static double transmittance(Vec3d origin_m, Vec3d dir);

    // Return the normal optical depth and single-scattering albedo by distance from Saturn's axis.
    static double depth(double radius_m);
    static double albedo(double radius_m);
    // Normalised: its mean over all directions is 1.
    static double phase_function(double phase_rad);
    // Returns the factor on single scattering.
    static double brightness(double phase_rad);
    // Returns the colour, 1 at the middle of V.
    const Spectrum& color() const { return color_; }

  private:
    Spectrum color_;
};

}  // namespace hilcam
