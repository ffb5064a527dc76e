#include "render/background/background.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "render/earth/earth_model.h"
#include "render/earth/earth_patch.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace

Background::Background(const std::array<SceneBody, kMaxBodies>& bodies, const Atmosphere* air,
                       const EarthModel* earth, const Spectrum& sun_irradiance_1au_w_m2_um,
                       bool limb_darkening, const SpectralGrid& grid)
    : scene_{&bodies, air, earth},
      sun_irradiance_1au_(sun_irradiance_1au_w_m2_um),
      disk_(grid, limb_darkening),
      eclipses_(scene_, disk_, grid.size()),
      light_(scene_, grid),
      placed_(scene_, sun_irradiance_1au_w_m2_um) {}

void Background::place(const WorldSnapshot& world, Vec3d objects_world_m, double pixel_rad,
                       std::optional<BodyId> ground) {
    pixel_rad_ = pixel_rad;
    earth_moment_ = {scene_.earth ? scene_.earth->numbers_at(world.time) : MapNumbers{}, nullptr};
    objects_from_camera_m_ = objects_world_m - world.camera.position_world_m;
    eclipses_.place(world.bodies);
    light_.place(pixel_rad);
    placed_.place(world, objects_world_m, pixel_rad, ground, light_);
    place_sun(world, objects_world_m);
    choose_quick_ways();
}

void Background::place_sun(const WorldSnapshot& world, Vec3d objects_world_m) {
    const Vec3d to_sun_m = world.bodies.sun_world_m - objects_world_m;
    const double sun_distance_m = length(to_sun_m);
    // The objects are assumed to fly with the camera.
    const Vec3d velocity_m_s = world.shifting_velocity_m_s();
    sun_world_dir_ = normalized(seen_in_motion(to_sun_m, kSunRadius_m, velocity_m_s));
    sun_camera_dir_ = normalized(
        seen_in_motion(world.bodies.sun_world_m - world.camera.position_world_m, kSunRadius_m, velocity_m_s));
    sun_disk_cosine_ = cone_cosine_of(kSunRadius_m, sun_distance_m);
    sun_seen_cosine_ = sun_disk_cosine_;
    for (const PlacedBody& body : disks())
        if (scene_.refraction(body.id) && (camera_in_air() || can_cover(dot(body.world_dir, sun_camera_dir_),
                                                                        body.cone_cosine, sun_disk_cosine_)))
            sun_seen_cosine_ = std::cos(std::acos(sun_disk_cosine_) + max_turn_rad());
    const double au = kAstronomicalUnit_m / sun_distance_m;
    sun_clear_irradiance_ = static_cast<float>(au * au) * sun_irradiance_1au_;
    sun_irradiance_ = sun_clear_irradiance_ * sun_seen_from(objects_world_m, kNoBody);
}

// Chooses faster ways than single rays: patches of the Earth, sixteen rays at a time for a plain body.
void Background::choose_quick_ways() {
    earth_in_patches_ = !disks().empty() && scene_.is_modelled(disks()[0].id) &&
                        !disks()[0].may_be_eclipsed && !camera_in_air();
    plain_ = nullptr;
    if (disks().empty() || scene_.air) return;
    const PlacedBody& body = disks()[0];
    const SceneBody& scene = scene_[body.id];
    if (!scene.look.plain_lambert() || !scene.look.heat().none() || !scene.map.empty() ||
        body.may_be_eclipsed || body.in_points || scene_.is_modelled(body.id))
        return;
    plain_ = &body;
    plain_radiance_ = static_cast<float>(1 / kPi) * (scene.look.albedo() * body.irradiance_w_m2_um);
}

Background Background::with(const std::array<SceneBody, kMaxBodies>& bodies, const EarthModel* earth) const {
    Background out = *this;
    out.scene_.all = &bodies, out.scene_.earth = earth;
    out.eclipses_.show(out.scene_), out.light_.show(out.scene_), out.placed_.show(out.scene_);
    if (plain_) out.plain_ = out.disks().data() + (plain_ - disks().data());
    return out;
}

// Returns the straight ray, in a body's axes, that meets the body's ground and air where the bent one does.
Background::BodyRay Background::ray_to(const PlacedBody& body, Vec3d origin_m, Vec3d dir) const {
    const BodyRay straight{body.camera_m + body.fixed_from_world * origin_m, body.fixed_from_world * dir};
    const AirRefraction* air = scene_.refraction(body.id);
    if (!air) return straight;
    const AirRefraction::Line line = line_within(*air, body.figure, straight.origin_m, straight.dir);
    return {line.origin_m, line.dir};
}

// Replaces a ray from the camera's place by the same ray behind a body's air.
void Background::pass_air(const PlacedBody& body, Vec3d& origin_m, Vec3d& dir) const {
    const AirRefraction* air = scene_.refraction(body.id);
    if (!air) return;
    const Mat3d world_from_fixed = transposed(body.fixed_from_world);
    const AirRefraction::Line line = line_beyond(
        *air, body.figure, body.camera_m + body.fixed_from_world * origin_m, body.fixed_from_world * dir);
    origin_m = world_from_fixed * (line.origin_m - body.camera_m), dir = world_from_fixed * line.dir;
}

Vec3d Background::beyond_air(Vec3d dir) const {
    Vec3d origin_m{};
    for (const PlacedBody& body : disks()) pass_air(body, origin_m, dir);
    return dir;
}

AirRefraction::Seen Background::seen_through_air(Vec3d dir, double distance_m) const {
    for (const PlacedBody& body : disks()) {
        const AirRefraction* air = scene_.refraction(body.id);
        // The air moves nothing outside its cone, which is half the sky for a camera in the air.
        if (!air || (body.cone_cosine > 0 && dot(dir, body.world_dir) < body.cone_cosine)) continue;
        const AirRefraction::Seen seen =
            seen_through(*air, body.figure, body.camera_m, body.fixed_from_world * dir, distance_m);
        return {transposed(body.fixed_from_world) * seen.dir, seen.light};
    }
    return {dir, 1};
}

bool Background::add_bodies_from(Vec3d origin_m, Vec3d dir, Spectrum& weight, Spectrum& radiance,
                                 Cone cone) const {
    // Few rays go on to a farther body, so few are bent for it.
    const double dir_length = length(dir);
    const auto go_on_behind = [&](const PlacedBody& body) {
        const std::span<const PlacedBody> farther =
            disks().subspan(static_cast<std::size_t>(&body - disks().data()) + 1);
        if (std::any_of(farther.begin(), farther.end(), [&](const PlacedBody& other) {
                return dot(dir, other.world_dir) >= other.seen_cosine * dir_length;
            }))
            pass_air(body, origin_m, dir);
    };
    for (const PlacedBody& body : disks()) {
        if (scene_.is_modelled(body.id)) {
            const Vec3d origin = body.camera_m + body.fixed_from_world * origin_m;
            if (add_earth(body, origin, body.fixed_from_world * dir, cone, weight, radiance)) return true;
            go_on_behind(body);
            continue;
        }
        const auto [origin, d] = ray_to(body, origin_m, dir);
        const double distance = light_.met(body, origin, d);
        const bool hit = distance >= 0;
        if (scene_.has_air(body.id)) add_air(body, origin, d, hit ? distance : kInfinity, weight, radiance);
        const bool lit = !(body.in_points && cone.of_pixel);
        if (scene_.has_rings(body.id))
            light_.add_rings(body, origin, d, {hit ? distance : kInfinity, pixel_rad_, lit}, weight,
                             radiance);
        if (!hit) {
            go_on_behind(body);
            continue;
        }
        if (lit) radiance += weight * light_.surface(body, origin + distance * d, -normalized(d), eclipses_);
        return true;
    }
    return false;
}

// Adds the air on a ray before `until`, in lengths of its direction.
void Background::add_air(const PlacedBody& body, Vec3d origin_m, Vec3d dir, double until, Spectrum& weight,
                         Spectrum& radiance) const {
    const Figure& figure = body.figure;
    const Vec3d o = stretched(figure, origin_m), sd = stretched(figure, dir);
    const double top_m = figure.equatorial_radius_m + scene_.air->top_m();
    const double to_closest = -dot(o, sd) / dot(sd, sd);
    const Vec3d closest = o + std::max(0.0, to_closest) * sd;
    if (!(dot(closest, closest) < top_m * top_m)) return;
    const double per_length = length(sd);
    const Atmosphere::Sight sight =
        scene_.air->look(o, sd / per_length, until < kInfinity ? until * per_length : kInfinity,
                         normalized(stretched(figure, body.sun_dir)));
    radiance += weight * body.irradiance_w_m2_um * sight.radiance_sr;
    weight = weight * sight.transmittance;
}

bool Background::add_earth(const PlacedBody& body, Vec3d origin_m, Vec3d dir, Cone cone, Spectrum& weight,
                           Spectrum& radiance) const {
    EarthModel::Ray ray =
        scene_.earth->bent({origin_m, normalized(dir), body.sun_dir, cone.width_rad, body.irradiance_w_m2_um,
                            earth_moment_, cone.of_pixel ? EarthModel::kLooksOfPixel : 1});
    if (body.may_be_eclipsed) {
        const double distance_m = intersect_ellipsoid(kFigures[index_of(body.id)], ray.origin_m, ray.dir);
        if (distance_m >= 0)
            ray.irradiance_w_m2_um =
                ray.irradiance_w_m2_um *
                eclipses_.sun_seen_from(
                    body.id, transposed(body.fixed_from_world) * (ray.origin_m + distance_m * ray.dir));
    }
    return scene_.earth->add_bent(ray, weight, radiance);
}

void Background::place_earth_patch(const PixelBox& box, Vec3d corner_dir, Vec3d right_dir, Vec3d down_dir,
                                   EarthPatch& patch) const {
    const PlacedBody& earth = disks()[0];
    const Mat3d& fixed = earth.fixed_from_world;
    const Vec3d corner = fixed * corner_dir, right = fixed * right_dir, down = fixed * down_dir;
    // The pitch is fine if the whole disk is seen.
    const bool small = earth.distance_m > 3 * kFigures[index_of(earth.id)].equatorial_radius_m;
    patch.place(*scene_.earth, box, small ? EarthPatch::kFinePitch_px : EarthPatch::kWidePitch_px,
                [&](double x, double y) {
                    const Vec3d dir = corner + (x - box.x0) * right + (y - box.y0) * down;
                    return EarthModel::Ray{earth.camera_m, normalized(dir),          earth.sun_dir,
                                           pixel_rad_,     earth.irradiance_w_m2_um, earth_moment_};
                });
}

Spectrum Background::ground_radiance(const PlacedBody& body, Vec3d dir, double width_rad) const {
    const Vec3d d = body.fixed_from_world * dir;
    const double distance = light_.met(body, body.camera_m, d);
    Spectrum weight, radiance;
    weight.bin.fill(1);
    if (scene_.has_rings(body.id))
        light_.add_rings(body, body.camera_m, d,
                         {distance < 0 ? kInfinity : distance, width_rad > 0 ? width_rad : pixel_rad_, true},
                         weight, radiance);
    if (distance < 0) return radiance;
    const Spectrum ground = light_.surface(body, body.camera_m + distance * d, -normalized(d), eclipses_);
    return scene_.has_rings(body.id) ? radiance + weight * ground : ground;
}

Atmosphere::Sight Background::air_before(Vec3d dir, double distance_m) const {
    const PlacedBody& earth = *std::find_if(disks().begin(), disks().end(),
                                            [](const PlacedBody& body) { return body.id == BodyId::kEarth; });
    const Figure& figure = earth.figure;
    const Vec3d d = stretched(figure, earth.fixed_from_world * normalized(dir));
    Atmosphere::Sight sight =
        scene_.air->look(stretched(figure, earth.camera_m), normalized(d), distance_m * length(d),
                         normalized(stretched(figure, earth.sun_dir)));
    sight.radiance_sr = sight.radiance_sr * earth.irradiance_w_m2_um;
    return sight;
}

std::string Background::air_missing(Vec3d dir) const {
    for (const PlacedBody& body : disks()) {
        const Figure& figure = body.figure;
        const Vec3d d = body.fixed_from_world * dir;
        const double distance = intersect_ellipsoid(figure, body.camera_m, d);
        if (distance < 0) continue;
        if (!scene_.has_air(body.id)) return {};
        const Vec3d sd = stretched(figure, d);
        return scene_.air->missing(stretched(figure, body.camera_m), normalized(sd), distance * length(sd),
                                   normalized(stretched(figure, body.sun_dir)));
    }
    return {};
}

EarthRays Background::plain_rays(Vec3d corner_dir, Vec3d right_dir, Vec3d down_dir) const {
    const Mat3d& fixed = plain_->fixed_from_world;
    return {plain_->figure,     plain_->camera_m,  plain_->sun_dir,
            fixed * corner_dir, fixed * right_dir, fixed * down_dir};
}

bool Background::hides_from(Vec3d origin_m, Vec3d dir, double distance) const {
    for (const PlacedBody& body : disks()) {
        const BodyRay ray = ray_to(body, origin_m, dir);
        const double there = light_.met(body, ray.origin_m, ray.dir);
        if (there >= 0 && there < distance) return true;
        pass_air(body, origin_m, dir);
    }
    return false;
}

Background::BodyMet Background::first_body_seen(Vec3d dir) const {
    Vec3d origin_m{};
    for (const PlacedBody& body : disks()) {
        const BodyRay ray = ray_to(body, origin_m, dir);
        const double distance = light_.met(body, ray.origin_m, ray.dir);
        if (distance >= 0)
            return {&body, distance,
                    transposed(body.fixed_from_world) *
                        ellipsoid_normal(body.figure, ray.origin_m + distance * ray.dir)};
        pass_air(body, origin_m, dir);
    }
    return {};
}

void Background::add_sun_disk(Vec3d dir, const Spectrum& weight, Spectrum& radiance) const {
    if (!meets_sun_disk(dir)) return;
    const Vec3d d = normalized(dir);
    const Vec3d across = cross(d, sun_camera_dir_);
    const double sine_squared = dot(across, across),
                 disk_sine_squared = 1 - sun_disk_cosine_ * sun_disk_cosine_;
    const double mu = std::sqrt(std::max(0.0, 1 - sine_squared / disk_sine_squared));
    radiance += static_cast<float>(1 / (kPi * disk_sine_squared)) *
                (weight * sun_clear_irradiance_ * disk_.relative_radiance(static_cast<float>(mu)));
}

}  // namespace hilcam
