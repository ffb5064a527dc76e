#pragma once
// The total light of a body for a distant viewer, if its V magnitude is measured: corrections to the laws of
// body_photometry.h for the body's shape, Uranus' poles and Saturn's rings.
//
// Shape: the magnitudes of Jupiter and Saturn are those of flattened disks near their equators. So a body
// seen from its equator has the law's light, and from elsewhere more in proportion to its outline. An
// ellipsoid as it is drawn, with Lambert's or Lommel-Seeliger's law at its own normals, sums up to 1 to 3 %
// less than a sphere's law times that outline. `shape_factor` corrects this, so that a disk and the point
// that it becomes have the same light.
//
// Uranus has bright poles: -8.4e-4 mag per degree of the mean of the planetographic latitudes of Sun and
// viewer, in either hemisphere (Mallama & Hilton, Astronomy and Computing 25, 2018, eq. 14). This includes
// its outline.
//
// Saturn with its rings, from the same paper, eq. 10, for phases a to 6.5 deg and ring tilts B to 27 deg:
//     V(1, a) = -8.914 - 1.825 sin B + 0.026 a - 0.378 sin B e^(-2.25 a),
// where sin^2 B is the product of the sines of the Saturnicentric latitudes of Sun and viewer, 0 if they are
// on opposite sides of the rings. The drawn rings (saturn_rings.h) and the globe between them sum up to that
// within 15 %, and the factor of `SaturnLight` corrects both. Beyond 27 deg the factor stays as for Sun and
// viewer at 27 deg. From 6.5 to 15 deg of phase it goes from its value at 6.5 deg to 1, because there only
// the globe alone was measured, by Cassini, and the rings are the model's.

#include <vector>

#include "render/sky/body_photometry.h"

namespace hilcam {

// Unit directions from a body, in its axes.
struct DiskView {
    Vec3d to_viewer, to_sun;

    double phase_rad() const;
};

// Returns the integral of a law over the lit and visible surface of an ellipsoid, times the cosine to the
// viewer [m^2 sr^-1]: its irradiance at a distance, over that of the Sun and times the squared distance, for
// c = 1.
double lit_disk_m2(const Figure& figure, SurfaceLaw law, const DiskView& view);
// Returns the same by a sphere's law and the outline of the ellipsoid.
double outline_disk_m2(const Figure& figure, SurfaceLaw law, const DiskView& view);
// Returns the second over the first; 1 for a sphere and for the thinnest crescents.
double shape_factor(const Figure& figure, SurfaceLaw law, const DiskView& view);
// Returns the factor on the light that the law at the equator and the outline give: Uranus by its poles; 1
// for others.
double latitude_factor(BodyId id, const Figure& figure, const DiskView& view);

// Returns the V magnitude of Saturn with its rings at 1 au from Sun and viewer. Arguments outside the law's
// range are clamped.
double saturn_magnitude_v_1au(double phase_rad, double tilt_sine);

class SaturnLight {
  public:
    // look: of the globe, scaled to its magnitude. Owner thread; takes some milliseconds.
    explicit SaturnLight(const BodyLook& look);

    // Returns the factors on the light of the globe, including its shape, and on that of the rings. Loop;
    // takes a third of a millisecond, like parts().
    struct Factor {
        double globe = 1, rings = 1;
    };
    Factor factor(const DiskView& view) const;
    // Returns the share of the globe's `outline_disk_m2` that remains behind the rings and in their shadow,
    // and the rings' own light without their colour [m^2]; both include the factor.
    struct Parts {
        double globe_share = 1, rings_m2 = 0;
    };
    Parts parts(const DiskView& view) const;

  private:
    // The drawn light without the factor [m^2].
    struct Drawn {
        double globe_m2, rings_m2;
    };
    BodyLook look_;
    std::vector<double> factors_;  // by phase, then tilt: for Sun and viewer at one latitude

    Drawn drawn(const DiskView& view) const;
    double law_factor(const DiskView& view, const Drawn& here) const;
};

}  // namespace hilcam
