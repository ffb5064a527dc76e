// The background's Earth where a model says what it looks like (render/earth).

#include "render/earth/earth_patch.h"
#include "render/scene/background.h"

namespace hilcam {

double Background::top_m(BodyId id) const {
    return has_air(id) ? air_->top_m() : (is_modelled(id) ? EarthModel::kHighest_m : 0);
}

bool Background::add_earth(const PlacedBody& body, Vec3d origin_m, Vec3d dir, Cone cone, Spectrum& weight,
                           Spectrum& radiance) const {
    EarthModel::Ray ray{origin_m,
                        normalized(dir),
                        body.sun_dir,
                        cone.width_rad,
                        body.irradiance_w_m2_um,
                        earth_moment_,
                        cone.of_pixel ? EarthModel::kLooksOfPixel : 1};
    if (body.may_be_eclipsed) {
        const double distance_m = intersect_ellipsoid(kFigures[index_of(body.id)], origin_m, ray.dir);
        if (distance_m >= 0)
            ray.irradiance_w_m2_um =
                ray.irradiance_w_m2_um *
                sun_seen_from(bodies_[body.id].world_m +
                                  transposed(body.fixed_from_world) * (origin_m + distance_m * ray.dir),
                              body.id);
    }
    return earth_->add(ray, weight, radiance);
}

void Background::place_earth_patch(const PixelBox& box, Vec3d corner_dir, Vec3d right_dir, Vec3d down_dir,
                                   EarthPatch& patch) const {
    const PlacedBody& earth = disks_[0];
    const Mat3d& fixed = earth.fixed_from_world;
    const Vec3d corner = fixed * corner_dir, right = fixed * right_dir, down = fixed * down_dir;
    // Small where the whole disk is seen.
    const bool small = earth.distance_m > 3 * kFigures[index_of(earth.id)].equatorial_radius_m;
    patch.place(*earth_, box, small ? EarthPatch::kFinePitch_px : EarthPatch::kWidePitch_px,
                [&](double x, double y) {
                    const Vec3d dir = corner + (x - box.x0) * right + (y - box.y0) * down;
                    return EarthModel::Ray{earth.camera_m, normalized(dir),          earth.sun_dir,
                                           pixel_rad_,     earth.irradiance_w_m2_um, earth_moment_};
                });
}

}  // namespace hilcam
