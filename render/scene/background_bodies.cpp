// Bodies one by one: where a frame has them, what light their ground and rings send.

#include <algorithm>
#include <cmath>
#include <limits>

#include "render/earth/earth_model.h"
#include "render/scene/background.h"
#include "render/vocabulary/units.h"

namespace hilcam {

namespace {

// The body's middle from the camera as one in motion sees it: its limb exactly. The ground below the camera
// is nearer than the limb and seen later by less, which turning the body makes up for.
Vec3d place_seen(BodyId id, const WorldSnapshot& world, Mat3d& fixed_from_world) {
    const BodyState& state = world.bodies[id];
    const double radius_m = world.bodies.figure(id).equatorial_radius_m;
    const Vec3d to_body_m = state.world_m - world.camera.position_world_m;
    const double distance_m = length(to_body_m);
    if (distance_m <= radius_m) return to_body_m;
    const Vec3d velocity_m_s = world.shifting_velocity_m_s() - state.velocity_m_s;
    const double height_m = distance_m - radius_m;
    const double tangent_m = std::sqrt(height_m * (distance_m + radius_m));
    const Vec3d turn_rad = ((tangent_m - height_m) / (kSpeedOfLight_m_s * radius_m * distance_m)) *
                           cross(to_body_m, velocity_m_s);
    fixed_from_world = fixed_from_world * transposed(to_matrix(from_rotation_vector(turn_rad)));
    return seen_in_motion(to_body_m, radius_m, velocity_m_s);
}

}  // namespace

PlacedBody Background::placed(BodyId id, const WorldSnapshot& world, bool stays) const {
    const BodyState& state = world.bodies[id];
    const Figure& figure = this->figure(index_of(id));
    PlacedBody out;
    out.id = id;
    out.figure = figure;
    out.fixed_from_world = state.fixed_from_world;
    const Vec3d from_camera_m =
        stays ? state.world_m - world.camera.position_world_m : place_seen(id, world, out.fixed_from_world);
    out.camera_m = out.fixed_from_world * -from_camera_m;
    out.distance_m = length(from_camera_m);
    out.world_dir = out.distance_m > 0 ? from_camera_m / out.distance_m : Vec3d{0, 0, 1};
    out.disk_cosine = cone_cosine_of(figure.equatorial_radius_m, out.distance_m);
    out.cone_cosine = top_m(id) > 0 || has_rings(id) || !(*scene_)[index_of(id)].relief.empty()
                          ? cone_cosine_of(outer_radius_m(id), out.distance_m)
                          : out.disk_cosine;
    const Vec3d to_sun_m = world.bodies.sun_world_m - state.world_m;
    const double sun_m = length(to_sun_m);
    out.sun_dir = out.fixed_from_world * (to_sun_m / sun_m);
    const double au = kAstronomicalUnit_m / sun_m;
    out.irradiance_w_m2_um = static_cast<float>(au * au) * sun_irradiance_1au_;
    out.sun_radius_rad = kSunRadius_m / sun_m;
    if ((*scene_)[index_of(id)].planetshine) add_planetshine(world, out);
    for (std::size_t i = 0; i < kMaxBodies; ++i) {
        if (!(*scene_)[i].visible || i == index_of(id)) continue;
        const Vec3d to_other = world.bodies.body[i].world_m - state.world_m;
        const double other_m = length(to_other);
        // The shadow cone grows by the body's own radius over the distance.
        const double reach = (this->figure(i).equatorial_radius_m + figure.equatorial_radius_m) / other_m;
        if (other_m < sun_m && reach < 1 &&
            can_cover(dot(to_other, to_sun_m) / (other_m * sun_m), std::sqrt(1 - reach * reach),
                      cone_cosine_of(kSunRadius_m, sun_m)))
            out.may_be_eclipsed = true;
    }
    return out;
}

double Background::outer_radius_m(BodyId id) const {
    if (has_rings(id)) return SaturnRings::kOuter_m;
    const BodyRelief& relief = (*scene_)[index_of(id)].relief;
    const double mountains_m = relief.empty() ? 0 : std::max(0.0, relief.highest_m());
    return this->figure(index_of(id)).equatorial_radius_m + std::max(top_m(id), mountains_m);
}

bool Background::is_seen_in_points(const PlacedBody& body, double pixel_rad) const {
    constexpr double kFar = 8;  // in radii: nearer, a few pixels are a large part of the sky
    // Of a ringed body the globe counts: a grid of rays would meet its rings by chance.
    const double radius_m = has_rings(body.id) ? body.figure.equatorial_radius_m : outer_radius_m(body.id);
    return !is_modelled(body.id) && !has_air(body.id) && body.distance_m > kFar * outer_radius_m(body.id) &&
           2 * radius_m < kBodyPoints_px * pixel_rad * body.distance_m;
}

// Bodies whose magnitude is measured have its light whole; shape and poles make no difference to the others.
void Background::set_brightness(PlacedBody& body) const {
    const BodyLook& look = (*scene_)[index_of(body.id)].look;
    if (!look.is_measured() || !(body.distance_m > 0)) return;
    const DiskView view{body.camera_m / body.distance_m, body.sun_dir};
    if (has_rings(body.id) && saturn_light_) {
        const SaturnLight::Factor by = saturn_light_->factor(view);
        body.globe_factor = static_cast<float>(by.globe), body.ring_factor = static_cast<float>(by.rings);
        return;
    }
    body.globe_factor = static_cast<float>(shape_factor(body.figure, look.law(), view) *
                                           latitude_factor(body.id, body.figure, view));
}

// Each of the others as a disk of the phase at which this body sees it, its air apart.
void Background::add_planetshine(const WorldSnapshot& world, PlacedBody& out) const {
    const Vec3d here_m = world.bodies[out.id].world_m;
    for (std::size_t i = 0; i < kMaxBodies; ++i) {
        if (!(*scene_)[i].visible || i == index_of(out.id)) continue;
        const Vec3d to_other_m = world.bodies.body[i].world_m - here_m;
        const Vec3d to_sun_m = world.bodies.sun_world_m - world.bodies.body[i].world_m;
        const double other_m = length(to_other_m), sun_m = length(to_sun_m);
        const double radius_m = this->figure(i).equatorial_radius_m;
        if (other_m <= radius_m) continue;
        const double phase = std::acos(std::clamp(dot(to_other_m, to_sun_m) / (-other_m * sun_m), -1.0, 1.0));
        const double au = kAstronomicalUnit_m / sun_m, part = au * radius_m / other_m;
        // A magnitude is that of the outline from the equator.
        const double outline = (*scene_)[i].look.is_measured()
                                   ? this->figure(i).polar_radius_m / this->figure(i).equatorial_radius_m
                                   : 1;
        const PlacedBody::Shine shine{
            out.fixed_from_world * (to_other_m / other_m),
            static_cast<float>(part * part * outline) *
                (sun_irradiance_1au_ * (*scene_)[i].look.disk_albedo(phase) * map_mean_[i])};
        // The strongest two.
        std::size_t at = out.shine_count;
        while (at > 0 && largest(out.shine[at - 1].irradiance_w_m2_um) < largest(shine.irradiance_w_m2_um))
            --at;
        if (at == out.shine.size()) continue;
        out.shine_count = std::min(out.shine_count + 1, out.shine.size());
        for (std::size_t k = out.shine_count - 1; k > at; --k) out.shine[k] = out.shine[k - 1];
        out.shine[at] = shine;
    }
    // What nobody sees beside the first is not worth a ray's time.
    constexpr float kSeen = 1e-3f;
    if (out.shine_count == 2 &&
        largest(out.shine[1].irradiance_w_m2_um) < kSeen * largest(out.shine[0].irradiance_w_m2_um))
        out.shine_count = 1;
}

double Background::met(const PlacedBody& body, Vec3d origin_m, Vec3d dir) const {
    const BodyRelief& relief = (*scene_)[index_of(body.id)].relief;
    if (relief.empty()) return intersect_ellipsoid(this->figure(index_of(body.id)), origin_m, dir);
    const double per_length = length(dir);
    const double distance_m = relief.intersect(origin_m, dir / per_length);
    return distance_m < 0 ? distance_m : distance_m / per_length;
}

Spectrum Background::surface_radiance(const PlacedBody& body, Vec3d point_m, Vec3d to_viewer_dir) const {
    const std::size_t i = index_of(body.id);
    const SceneBody& scene = (*scene_)[i];
    const Figure& figure = this->figure(i);
    const Vec3d level = ellipsoid_normal(figure, point_m);
    // A pixel on the ground.
    const auto footprint_m = [&] {
        const double slant = std::max(0.25, dot(level, to_viewer_dir));
        return pixel_rad_ * length(point_m - body.camera_m) / std::sqrt(slant);
    };
    const Vec3d normal = scene.relief.empty() ? level : scene.relief.normal(level, footprint_m());
    const double mu0 = dot(normal, body.sun_dir);
    Spectrum light =
        scene.look.reflectance_sr(static_cast<float>(mu0), static_cast<float>(dot(normal, to_viewer_dir)),
                                  static_cast<float>(dot(body.sun_dir, to_viewer_dir)));
    if (body.globe_factor != 1) light = body.globe_factor * light;
    if (has_air(body.id)) {
        // tau_1 dims the Sun; the sky adds its own light on the ground, taken as Lambert.
        const Vec3d p = stretched(figure, point_m), s = normalized(stretched(figure, body.sun_dir));
        light = light * air_->sun_transmittance(p, s);
        light += static_cast<float>(1 / kPi) * (scene.look.albedo() * air_->sky_irradiance(p, s));
    } else if (mu0 <= 0 && body.shine_count == 0) {
        return {};
    }
    if (mu0 > 0 && has_rings(body.id))
        light = static_cast<float>(SaturnRings::transmittance(point_m, body.sun_dir)) * light;
    if (mu0 > 0 && !scene.relief.empty())
        light =
            static_cast<float>(scene.relief.sun_share(point_m, body.sun_dir, body.sun_radius_rad)) * light;
    Spectrum texel;
    texel.bin.fill(1);
    if (!scene.map.empty()) {
        // Longitude runs with u from 180 W. Latitude is the normal's own, or flatter (Snyder, USGS Professional Paper 1395, 1987, eq. 3-28).
        const auto u = static_cast<float>(std::atan2(level.y, level.x) / (2 * kPi) + 0.5);
        const double latitude_rad =
            scene.map_latitude_factor == 1
                ? std::asin(std::clamp(level.z, -1.0, 1.0))
                : std::atan2(scene.map_latitude_factor * level.z, std::hypot(level.x, level.y));
        const auto v = static_cast<float>(0.5 - latitude_rad / kPi);
        // Against the equator's length.
        const double slant = std::max(0.25, dot(level, to_viewer_dir));
        const double footprint = pixel_rad_ * length(point_m - body.camera_m) /
                                 (std::sqrt(slant) * 2 * kPi * figure.equatorial_radius_m);
        texel = bands_.spectrum(scene.map.sample(u, v, static_cast<float>(footprint))) * map_factor_[i];
        light = light * texel;
    }
    if (body.may_be_eclipsed)
        light = light *
                sun_seen_from(bodies_.body[i].world_m + transposed(body.fixed_from_world) * point_m, body.id);
    if (body.shine_count == 0) return body.irradiance_w_m2_um * light;
    Spectrum out = body.irradiance_w_m2_um * light;
    for (std::size_t k = 0; k < body.shine_count; ++k) {
        const PlacedBody::Shine& shine = body.shine[k];
        out += shine.irradiance_w_m2_um * texel *
               scene.look.reflectance_sr(static_cast<float>(dot(normal, shine.dir)),
                                         static_cast<float>(dot(normal, to_viewer_dir)),
                                         static_cast<float>(dot(shine.dir, to_viewer_dir)));
    }
    return out;
}

// Adds the rings that a ray meets before `until`; Saturn's shadow lies on them.
void Background::add_rings(const PlacedBody& body, Vec3d origin_m, Vec3d dir, const RingSight& sight,
                           Spectrum& weight, Spectrum& radiance) const {
    const SaturnRings::Met there = SaturnRings::meet(origin_m, dir);
    if (there.distance < 0 || there.distance >= sight.until) return;
    const Vec3d to_viewer = normalized(-dir);
    const double slant = std::max(0.1, std::abs(to_viewer.z));
    const double footprint_m = sight.width_rad * there.distance * length(dir) / std::sqrt(slant);
    const SaturnRings::Look look = rings_.look(there.point_m, footprint_m, to_viewer, body.sun_dir);
    if (sight.lit && intersect_ellipsoid(this->figure(index_of(body.id)), there.point_m, body.sun_dir) < 0)
        radiance += body.ring_factor * (weight * body.irradiance_w_m2_um * look.radiance_sr);
    weight = look.transmittance * weight;
}

std::string Background::name_of(BodyId id) const {
    const std::string& own = (*scene_)[index_of(id)].name;
    if (!own.empty()) return own;
    return index_of(id) < kBodyCount ? std::string(kBodyNames[index_of(id)]) : "body";
}

std::string Background::describe(const PlacedBody& body) const {
    const SceneBody& scene = (*scene_)[index_of(body.id)];
    std::string out;
    const auto add = [&](const std::string& part) { out += (out.empty() ? "" : ", ") + part; };
    if (scene.look.is_hapke()) add("Hapke's law at each ray");
    if (!scene.relief.empty()) {
        const long tenths = std::lround(scene.relief.spacing_m() * 1e-2);
        add("relief with posts " + std::to_string(tenths / 10) + "." + std::to_string(tenths % 10) +
            " km apart: rays are followed to the ground, and to the Sun where it stands low");
    }
    if (has_rings(body.id)) add("its rings at each ray, with the shadows of each on the other");
    for (std::size_t k = 0; k < body.shine_count; ++k)
        if (largest(body.shine[k].irradiance_w_m2_um) > 0 && k == 0) add("light of other bodies on it");
    return out;
}

Background Background::with(const std::array<SceneBody, kMaxBodies>& bodies, const EarthModel* earth) const {
    Background out = *this;
    out.scene_ = &bodies, out.earth_ = earth;
    if (plain_) out.plain_ = out.disks_.data() + (plain_ - disks_.data());
    for (PlacedBody& body : out.disks_)
        if (!bodies[index_of(body.id)].planetshine) body.shine_count = 0;
    return out;
}

Spectrum Background::point_irradiance(const PlacedBody& body) const {
    const std::size_t i = index_of(body.id);
    const Figure& figure = this->figure(i);
    const double a = figure.equatorial_radius_m, b = figure.polar_radius_m;
    const Vec3d to_camera = body.camera_m / body.distance_m;
    if (is_modelled(body.id))
        return static_cast<float>(a * a / (body.distance_m * body.distance_m)) *
               (body.irradiance_w_m2_um * earth_->disk_albedo(to_camera, body.sun_dir, 400));
    const DiskView view{to_camera, body.sun_dir};
    const BodyLook& look = (*scene_)[i].look;
    // These are the semi-axes of the ellipse that it shows: a and sqrt(a^2 sin^2 + b^2 cos^2) of the camera's
    // latitude.
    const double sine = to_camera.z, distance2 = body.distance_m * body.distance_m;
    const double area_ratio = a * std::sqrt(a * a * sine * sine + b * b * (1 - sine * sine)) / distance2;
    Spectrum out = static_cast<float>(area_ratio) *
                   (body.irradiance_w_m2_um * look.disk_albedo(view.phase_rad()) * map_mean_[i]);
    if (!look.is_measured()) return out;
    if (body.id == BodyId::kSaturn && saturn_light_) {
        // Its rings are in its magnitude, whether they are drawn from near by or not.
        const SaturnLight::Parts parts = saturn_light_->parts(view);
        return static_cast<float>(parts.globe_share) * out +
               static_cast<float>(parts.rings_m2 / distance2) * (body.irradiance_w_m2_um * rings_.color());
    }
    return static_cast<float>(latitude_factor(body.id, figure, view)) * out;
}

}  // namespace hilcam
