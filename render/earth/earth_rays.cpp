#include "render/earth/earth_rays.h"

#include <cmath>

#include "render/vocabulary/clones.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

Vec3d stretched(double stretch, Vec3d v) { return {v.x, v.y, v.z * stretch}; }

// The closest-approach form of the quadratic (see intersect_ellipsoid), then the gradient of the ellipsoid:
// (x, y, z / (1-f)^2) is (x, y, z_stretched / (1-f)).
HILCAM_CLONES void cosines_of(const EarthRays& e, const float* x, const float* y, float* cosine) {
    const Vec3d o = e.origin_m, c = e.corner, r = e.right, w = e.down, s = e.sun;
    const double a = e.radius_m, stretch = e.stretch;
    for (std::size_t i = 0; i < EarthRays::kCount; ++i) {
        const auto u = static_cast<double>(x[i]), v = static_cast<double>(y[i]);
        const double dx = c.x + u * r.x + v * w.x;
        const double dy = c.y + u * r.y + v * w.y;
        const double dz = c.z + u * r.z + v * w.z;
        const double d_squared = dx * dx + dy * dy + dz * dz;
        const double to_closest = -(o.x * dx + o.y * dy + o.z * dz) / d_squared;
        const double cx = o.x + to_closest * dx, cy = o.y + to_closest * dy, cz = o.z + to_closest * dz;
        const double rest = a * a - (cx * cx + cy * cy + cz * cz);
        const double distance = to_closest - std::sqrt((rest > 0 ? rest : 0.0) / d_squared);
        const double px = o.x + distance * dx, py = o.y + distance * dy, pz = o.z + distance * dz;
        const double nz = pz * stretch;
        const double value = (px * s.x + py * s.y + pz * s.z) / std::sqrt(px * px + py * py + nz * nz);
        const bool met = (rest >= 0) & (to_closest >= 0);
        cosine[i] = met ? static_cast<float>(value) : EarthRays::kMiss;
    }
}

}  // namespace

EarthRays::EarthRays(const Figure& figure, Vec3d camera_m, Vec3d sun_dir, Vec3d corner_dir, Vec3d right_dir,
                     Vec3d down_dir)
    : radius_m(figure.equatorial_radius_m),
      stretch(figure.equatorial_radius_m / figure.polar_radius_m),
      origin_m(stretched(stretch, camera_m)),
      corner(stretched(stretch, corner_dir)),
      right(stretched(stretch, right_dir)),
      down(stretched(stretch, down_dir)),
      sun(stretched(stretch, sun_dir)) {}

void EarthRays::sun_cosines(const Floats& x, const Floats& y, Floats& cosine) const {
    cosines_of(*this, x.data(), y.data(), cosine.data());
}

}  // namespace hilcam
