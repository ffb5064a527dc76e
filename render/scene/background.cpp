#include "render/scene/background.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "render/earth/earth_model.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Mean colour of a map over the sphere.
Vec3f mean_texel(const MipTexture& map) {
    return map.mean([](double v) { return std::cos(kPi * (v - 0.5)); });
}

}  // namespace

Background::Background(const std::array<SceneBody, kMaxBodies>& bodies, const Atmosphere* air,
                       const EarthModel* earth, const Spectrum& sun_irradiance_1au_w_m2_um,
                       bool limb_darkening, const SpectralGrid& grid)
    : scene_(&bodies),
      air_(air),
      earth_(earth),
      sun_irradiance_1au_(sun_irradiance_1au_w_m2_um),
      disk_(grid, limb_darkening),
      bands_(grid),
      rings_(grid),
      bins_(grid.size()) {
    if (const SceneBody& saturn = bodies[index_of(BodyId::kSaturn)];
        saturn.visible && saturn.look.is_measured())
        saturn_light_.emplace(saturn.look);
    for (std::size_t i = 0; i < kMaxBodies; ++i) {
        map_factor_[i].bin.fill(1);
        map_mean_[i].bin.fill(1);
        if ((*scene_)[i].map.empty()) continue;
        const Spectrum mean = bands_.spectrum(mean_texel((*scene_)[i].map));
        if ((*scene_)[i].map_reference > 0) {
            const auto one = static_cast<float>(1 / (*scene_)[i].map_reference);
            map_factor_[i].bin.fill(one);
            map_mean_[i] = one * mean;
            continue;
        }
        if ((*scene_)[i].look.plain_lambert()) {
            map_mean_[i] = mean;
            continue;
        }
        // A look tied to a magnitude keeps its light under a map: the map is relative to its mean.
        for (int b = 0; b < bins_; ++b) map_factor_[i][b] = mean[b] > 0 ? 1 / mean[b] : 0.0f;
    }
}

void Background::place(const WorldSnapshot& world, Vec3d objects_world_m, double pixel_rad,
                       std::optional<BodyId> ground) {
    bodies_ = world.bodies;
    pixel_rad_ = pixel_rad;
    earth_moment_ = {earth_ ? earth_->numbers_at(world.time) : MapNumbers{}, nullptr};
    objects_from_camera_m_ = objects_world_m - world.camera.position_world_m;
    const Vec3d to_sun_m = world.bodies.sun_world_m - objects_world_m;
    const double sun_distance_m = length(to_sun_m);
    // The objects are taken to fly with the camera.
    const Vec3d velocity_m_s = world.shifting_velocity_m_s();
    sun_world_dir_ = normalized(seen_in_motion(to_sun_m, kSunRadius_m, velocity_m_s));
    sun_camera_dir_ = normalized(
        seen_in_motion(world.bodies.sun_world_m - world.camera.position_world_m, kSunRadius_m, velocity_m_s));
    sun_disk_cosine_ = cone_cosine_of(kSunRadius_m, sun_distance_m);

    disk_count_ = point_count_ = body_light_count_ = 0;
    nearest_m_ = kInfinity;
    camera_in_air_ = false;
    for (std::size_t i = 0; i < kMaxBodies; ++i) {
        if (!(*scene_)[i].visible) continue;
        const PlacedBody body = placed(static_cast<BodyId>(i), world, static_cast<BodyId>(i) == ground);
        const double radius_m = this->figure(i).equatorial_radius_m;
        if (2 * radius_m < pixel_rad * body.distance_m) {
            points_[point_count_++] = body;
            continue;
        }
        disks_[disk_count_] = body;
        disks_[disk_count_].in_points = is_seen_in_points(body, pixel_rad);
        set_brightness(disks_[disk_count_++]);
        const bool reaches = !(*scene_)[i].relief.empty() || has_rings(body.id);
        const double reach_m = reaches ? outer_radius_m(body.id) : radius_m;
        nearest_m_ = std::min(nearest_m_, std::max(0.0, body.distance_m - reach_m));
        if (has_air(body.id) && body.distance_m < radius_m + air_->top_m()) camera_in_air_ = true;
    }
    std::sort(disks_.begin(), disks_.begin() + static_cast<std::ptrdiff_t>(disk_count_),
              [](const PlacedBody& a, const PlacedBody& b) { return a.distance_m < b.distance_m; });
    for (const PlacedBody& body : disks()) {
        // Lambert's radiance is at most albedo / pi; Lommel-Seeliger's w / 4 pi at the bright limb.
        Spectrum most = (*scene_)[index_of(body.id)].look.max_sr();
        if (is_modelled(body.id)) most.bin.fill(EarthModel::kMaxOverSun);
        const float sun_share = body.irradiance_w_m2_um[0] / std::max(1e-30f, sun_irradiance_1au_[0]);
        const Vec3d to_body_m = world.bodies[body.id].world_m - objects_world_m;
        const double radius_m = this->figure(index_of(body.id)).equatorial_radius_m + top_m(body.id);
        const double sine = std::min(1.0, radius_m / length(to_body_m));
        body_lights_[body_light_count_++] = {
            normalized(to_body_m), static_cast<float>(sine * sine),
            static_cast<float>(sine * sine / (1 + std::sqrt(1 - sine * sine))),
            body.globe_factor * sun_share * most};
    }

    const double au = kAstronomicalUnit_m / sun_distance_m;
    sun_clear_irradiance_ = static_cast<float>(au * au) * sun_irradiance_1au_;
    sun_irradiance_ = sun_clear_irradiance_ * sun_seen_from(objects_world_m, kNoBody);

    earth_in_patches_ =
        disk_count_ > 0 && is_modelled(disks_[0].id) && !disks_[0].may_be_eclipsed && !camera_in_air_;
    plain_ = nullptr;
    if (disk_count_ > 0 && !air_) {
        const PlacedBody& body = disks_[0];
        const SceneBody& scene = (*scene_)[index_of(body.id)];
        if (scene.look.plain_lambert() && scene.map.empty() && !body.may_be_eclipsed && !body.in_points &&
            !is_modelled(body.id)) {
            plain_ = &disks_[0];
            plain_radiance_ = static_cast<float>(1 / kPi) * (scene.look.albedo() * body.irradiance_w_m2_um);
        }
    }
}

Spectrum Background::sun_seen_from(Vec3d place_world_m, BodyId standing_on) const {
    Spectrum whole;
    whole.bin.fill(1);
    const Vec3d to_sun_m = bodies_.sun_world_m - place_world_m;
    const double sun_m = length(to_sun_m);
    const Vec3d sun_dir = to_sun_m / sun_m;
    const double disk_cosine = cone_cosine_of(kSunRadius_m, sun_m);
    std::array<std::size_t, kMaxBodies> before{};
    std::size_t count = 0;
    for (std::size_t i = 0; i < kMaxBodies; ++i) {
        if (!(*scene_)[i].visible || i == index_of(standing_on)) continue;
        const Vec3d to_body = bodies_.body[i].world_m - place_world_m;
        const double body_m = length(to_body);
        const double radius_m =
            this->figure(i).equatorial_radius_m + (has_air(static_cast<BodyId>(i)) ? air_->top_m() : 0);
        if (body_m - radius_m < sun_m &&
            can_cover(dot(to_body, sun_dir) / body_m, cone_cosine_of(radius_m, body_m), disk_cosine))
            before[count++] = i;
    }
    if (count == 0) return whole;

    // The disk in rings of equal area and spokes, weighted by its own radiance. Each ring is turned by the
    // golden section, so that no limb runs along many of its points: half a per cent of the whole, rms, 1.4 %
    // at most, for limbs of any radius, place and direction.
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
                const Figure& figure = this->figure(i);
                const Mat3d& fixed = bodies_.body[i].fixed_from_world;
                const Vec3d origin = fixed * (place_world_m - bodies_.body[i].world_m);
                const Vec3d body_dir = fixed * dir;
                if (intersect_ellipsoid(figure, origin, body_dir) >= 0)
                    passed = {};
                else if (has_air(static_cast<BodyId>(i)))
                    passed = passed * air_->sun_transmittance(stretched(figure, origin),
                                                              normalized(stretched(figure, body_dir)));
            }
            seen += passed;
            all += radiance;
        }
    }
    for (int b = 0; b < bins_; ++b) whole[b] = all[b] > 0 ? std::min(1.0f, seen[b] / all[b]) : 0.0f;
    return whole;
}

bool Background::add_bodies_from(Vec3d origin_m, Vec3d dir, Spectrum& weight, Spectrum& radiance,
                                 Cone cone) const {
    for (const PlacedBody& body : disks()) {
        const Figure& figure = this->figure(index_of(body.id));
        const Vec3d origin = body.camera_m + body.fixed_from_world * origin_m;
        const Vec3d d = body.fixed_from_world * dir;
        if (is_modelled(body.id)) {
            if (add_earth(body, origin, d, cone, weight, radiance)) return true;
            continue;
        }
        const double distance = met(body, origin, d);
        const bool hit = distance >= 0;
        if (has_air(body.id)) {
            const Vec3d o = stretched(figure, origin), sd = stretched(figure, d);
            const double top_m = figure.equatorial_radius_m + air_->top_m();
            const double to_closest = -dot(o, sd) / dot(sd, sd);
            const Vec3d closest = o + std::max(0.0, to_closest) * sd;
            if (dot(closest, closest) < top_m * top_m) {
                const double per_length = length(sd);
                const Atmosphere::Sight sight =
                    air_->look(o, sd / per_length, hit ? distance * per_length : kInfinity,
                               normalized(stretched(figure, body.sun_dir)));
                radiance += weight * body.irradiance_w_m2_um * sight.radiance_sr;
                weight = weight * sight.transmittance;
            }
        }
        const bool lit = !(body.in_points && cone.of_pixel);
        if (has_rings(body.id))
            add_rings(body, origin, d, {hit ? distance : kInfinity, pixel_rad_, lit}, weight, radiance);
        if (!hit) continue;
        if (lit) radiance += weight * surface_radiance(body, origin + distance * d, -normalized(d));
        return true;
    }
    return false;
}

Spectrum Background::ground_radiance(const PlacedBody& body, Vec3d dir, double width_rad) const {
    const Vec3d d = body.fixed_from_world * dir;
    const double distance = met(body, body.camera_m, d);
    Spectrum weight, radiance;
    weight.bin.fill(1);
    if (has_rings(body.id))
        add_rings(body, body.camera_m, d,
                  {distance < 0 ? kInfinity : distance, width_rad > 0 ? width_rad : pixel_rad_, true}, weight,
                  radiance);
    if (distance < 0) return radiance;
    const Spectrum ground = surface_radiance(body, body.camera_m + distance * d, -normalized(d));
    return has_rings(body.id) ? radiance + weight * ground : ground;
}

Atmosphere::Sight Background::air_before(Vec3d dir, double distance_m) const {
    const PlacedBody& earth = *std::find_if(disks().begin(), disks().end(),
                                            [](const PlacedBody& body) { return body.id == BodyId::kEarth; });
    const Figure& figure = this->figure(index_of(earth.id));
    const Vec3d d = stretched(figure, earth.fixed_from_world * normalized(dir));
    Atmosphere::Sight sight =
        air_->look(stretched(figure, earth.camera_m), normalized(d), distance_m * length(d),
                   normalized(stretched(figure, earth.sun_dir)));
    sight.radiance_sr = sight.radiance_sr * earth.irradiance_w_m2_um;
    return sight;
}

std::string Background::air_missing(Vec3d dir) const {
    for (const PlacedBody& body : disks()) {
        const Figure& figure = this->figure(index_of(body.id));
        const Vec3d d = body.fixed_from_world * dir;
        const double distance = intersect_ellipsoid(figure, body.camera_m, d);
        if (distance < 0) continue;
        if (!has_air(body.id)) return {};
        const Vec3d sd = stretched(figure, d);
        return air_->missing(stretched(figure, body.camera_m), normalized(sd), distance * length(sd),
                             normalized(stretched(figure, body.sun_dir)));
    }
    return {};
}

EarthRays Background::plain_rays(Vec3d corner_dir, Vec3d right_dir, Vec3d down_dir) const {
    const Mat3d& fixed = plain_->fixed_from_world;
    return {this->figure(index_of(plain_->id)),
            plain_->camera_m,
            plain_->sun_dir,
            fixed * corner_dir,
            fixed * right_dir,
            fixed * down_dir};
}

bool Background::hides_from(Vec3d origin_m, Vec3d dir, double distance) const {
    for (const PlacedBody& body : disks()) {
        const double there =
            met(body, body.camera_m + body.fixed_from_world * origin_m, body.fixed_from_world * dir);
        if (there >= 0 && there < distance) return true;
    }
    return false;
}

Background::BodyMet Background::first_body_seen(Vec3d dir) const {
    for (const PlacedBody& body : disks()) {
        const Figure& figure = this->figure(index_of(body.id));
        const Vec3d d = body.fixed_from_world * dir;
        const double distance = met(body, body.camera_m, d);
        if (distance < 0) continue;
        return {&body, distance,
                transposed(body.fixed_from_world) * ellipsoid_normal(figure, body.camera_m + distance * d)};
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
