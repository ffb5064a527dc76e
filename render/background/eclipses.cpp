#include "render/background/eclipses.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "render/sky/air_refraction.h"
#include "render/vocabulary/units.h"

namespace hilcam {

// Returns the share of the light from a direction that a body and its air let through to a place, per bin;
// body axes. Light that the air bends arrives from another direction, and spread.
Spectrum Eclipses::passed_by(BodyId body, const Figure& figure, Vec3d origin_m, Vec3d dir) const {
    Spectrum whole;
    whole.bin.fill(1);
    Vec3d from_m = origin_m, way = dir;
    if (const AirRefraction* air = scene_.refraction(body)) {
        const AirRefraction::Seen seen =
            seen_through(*air, figure, origin_m, dir, std::numeric_limits<double>::infinity());
        const AirRefraction::Line line = line_within(*air, figure, origin_m, seen.dir);
        from_m = line.origin_m, way = line.dir;
        whole.bin.fill(static_cast<float>(seen.light));
    }
    if (intersect_ellipsoid(figure, from_m, way) >= 0) return {};
    if (!scene_.has_air(body)) return whole;
    return whole *
           scene_.air->sun_transmittance(stretched(figure, from_m), normalized(stretched(figure, way)));
}

Spectrum Eclipses::sun_seen_from(Vec3d place_world_m, BodyId standing_on) const {
    Spectrum whole;
    whole.bin.fill(1);
    const Vec3d to_sun_m = bodies_.sun_world_m - place_world_m;
    const double sun_m = length(to_sun_m);
    const Vec3d sun_dir = to_sun_m / sun_m;
    const double disk_cosine = cone_cosine_of(kSunRadius_m, sun_m);
    std::array<std::size_t, kMaxBodies> before{};
    std::size_t count = 0;
    for (std::size_t i = 0; i < kMaxBodies; ++i) {
        if (!(*scene_.all)[i].visible || i == index_of(standing_on)) continue;
        const Vec3d to_body = bodies_.body[i].world_m - place_world_m;
        const double body_m = length(to_body);
        const double radius_m = bodies_.figure(static_cast<BodyId>(i)).equatorial_radius_m +
                                (scene_.has_air(static_cast<BodyId>(i)) ? scene_.air->top_m() : 0);
        if (body_m - radius_m < sun_m &&
            can_cover(dot(to_body, sun_dir) / body_m, cone_cosine_of(radius_m, body_m), disk_cosine))
            before[count++] = i;
    }
    if (count == 0) return whole;

    // Divides the disk into rings of equal area and spokes, weighted by radiance. Each ring is rotated by the
    // golden section, so that no limb coincides with many points: the error is half a per cent of the whole,
    // rms, and 1.4 % at most, for limbs of any radius, place and direction.
    constexpr int kRings = 12, kSpokes = 24;
    constexpr double kGolden = 0.6180339887498949;
    const double sine = std::sqrt(std::max(0.0, 1 - disk_cosine * disk_cosine));
    const Vec3d side = normalized(std::abs(sun_dir.x) < 0.9 ? cross(sun_dir, Vec3d{1, 0, 0})
                                                            : cross(sun_dir, Vec3d{0, 1, 0}));
    const Vec3d up = cross(sun_dir, side);
    Spectrum seen, all;
    for (int ring = 0; ring < kRings; ++ring) {
        const double r = std::sqrt((ring + 0.5) / kRings);
        const Spectrum radiance = disk_.relative_radiance(static_cast<float>(std::sqrt(1 - r * r)));
        for (int spoke = 0; spoke < kSpokes; ++spoke) {
            const double phi = 2 * kPi * (spoke + kGolden * ring) / kSpokes;
            const Vec3d dir =
                normalized(sun_dir + (r * sine * std::cos(phi)) * side + (r * sine * std::sin(phi)) * up);
            Spectrum passed = radiance;
            for (std::size_t k = 0; k < count; ++k) {
                const std::size_t i = before[k];
                const Figure& figure = bodies_.figure(static_cast<BodyId>(i));
                const Mat3d& fixed = bodies_.body[i].fixed_from_world;
                const Vec3d origin = fixed * (place_world_m - bodies_.body[i].world_m);
                passed = passed * passed_by(static_cast<BodyId>(i), figure, origin, fixed * dir);
            }
            seen += passed;
            all += radiance;
        }
    }
    for (int b = 0; b < bins_; ++b) whole[b] = all[b] > 0 ? std::min(1.0f, seen[b] / all[b]) : 0.0f;
    return whole;
}

}  // namespace hilcam
