#pragma once
// The light of the whole of a body for a distant viewer, where its V magnitude is measured: what the laws of
// body_photometry.h leave to the body's shape, to Uranus' poles and to Saturn's rings.
//
// The magnitudes of Jupiter and Saturn are those of flattened disks near their equators. So a body that is seen from its
// equator has the law's light, and from elsewhere as much more as its outline is larger. What is drawn of an ellipsoid -
// Lambert's or Lommel-Seeliger's law at its own normals - sums up to 1 to 3 % less than a sphere's law says of that
// outline; `shape_factor` makes it up, so that a disk and the point that it becomes have the same light.
//
// Uranus has bright poles: - 8.4e-4 mag a degree of the mean of the planetographic latitudes of Sun and viewer, whatever
// their hemisphere (Mallama & Hilton, Astronomy and Computing 25, 2018, eq. 14). Its outline is in that.
//
// Saturn with its rings, from the same paper, eq. 10, for phases a to 6.5 deg and ring tilts B to 27 deg:
//     V(1, a) = -8.914 - 1.825 sin B + 0.026 a - 0.378 sin B e^(-2.25 a),
// where sin^2 B is the product of the sines of the Saturnicentric latitudes of Sun and viewer, 0 where these stand on two
// sides of the rings. Rings as they are drawn (saturn_rings.h) and the globe between them sum up to that within 15 %;
// `SaturnLight::factor` makes it up for both. Beyond 27 deg that factor stays as for Sun and viewer at 27 deg, from 6.5 to 15
// deg of phase it goes from what it is at 6.5 deg to 1: nothing was measured there but the globe alone, by Cassini, and the rings are the model's.

#include <vector>

#include "render/sky/body_photometry.h"

namespace hilcam {

// Unit directions from a body, in its axes.
struct DiskView {
    Vec3d to_viewer, to_sun;

    double phase_rad() const;
};

// Returns the integral of a law over the lit and seen surface of an ellipsoid, by the cosine to the viewer [m^2 sr^-1]: its
// irradiance at a distance, over that of the Sun and over the distance's square, for c = 1.
double lit_disk_m2(const Figure& figure, SurfaceLaw law, const DiskView& view);
// Returns the same by the law of a sphere and the outline that the ellipsoid shows.
double outline_disk_m2(const Figure& figure, SurfaceLaw law, const DiskView& view);
// Returns the second over the first; 1 for a sphere and for the thinnest crescents.
double shape_factor(const Figure& figure, SurfaceLaw law, const DiskView& view);
// Returns how much brighter a body is than the law for its equator and its outline say: Uranus by its poles; the others 1.
double latitude_factor(BodyId id, const Figure& figure, const DiskView& view);

// V magnitude of Saturn with its rings at 1 au from Sun and viewer. Sines and angles beyond the law's range are taken as its
// ends.
double saturn_magnitude_v_1au(double phase_rad, double tilt_sine);

class SaturnLight {
  public:
    // look: of the globe, tied to its magnitude. Owner thread; some milliseconds.
    explicit SaturnLight(const BodyLook& look);

    // Returns the factor on the light of the globe, shape and all, and on that of the rings. Loop; a third of a millisecond, as
    // the next.
    struct Factor {
        double globe = 1, rings = 1;
    };
    Factor factor(const DiskView& view) const;
    // Returns what is left of the globe's `outline_disk_m2` behind the rings and in their shadow, and the rings' own part but for
    // their colour [m^2]; both with the factor.
    struct Parts {
        double globe_share = 1, rings_m2 = 0;
    };
    Parts parts(const DiskView& view) const;

  private:
    // The light that is drawn, without the factor [m^2].
    struct Drawn {
        double globe_m2, rings_m2;
    };
    BodyLook look_;
    std::vector<double> factors_;  // by phase, then tilt: for Sun and viewer at one latitude

    Drawn drawn(const DiskView& view) const;
    double law_factor(const DiskView& view, const Drawn& here) const;
};

}  // namespace hilcam
