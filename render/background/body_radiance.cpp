#include "render/background/body_radiance.h"

#include <algorithm>
#include <cmath>

#include "render/earth/earth_model.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

// Returns the mean colour of a map over the sphere.
Vec3f mean_texel(const MipTexture& map) {
    return map.mean([](double v) { return std::cos(kPi * (v - 0.5)); });
}

// Returns the place with that level normal, in body axes.
BodyHeat::Place place_of(Vec3d level, Vec3d sun_dir, double mu0) {
    const double hour_rad =
        std::atan2(sun_dir.x * level.y - sun_dir.y * level.x, sun_dir.x * level.x + sun_dir.y * level.y);
    return {static_cast<float>(mu0), static_cast<float>(level.z), static_cast<float>(hour_rad)};
}

}  // namespace

BodyRadiance::BodyRadiance(const SceneBodies& scene, const SpectralGrid& grid)
    : scene_(scene), bands_(grid), rings_(grid), bins_(grid.size()) {
    if (const SceneBody& saturn = scene_[BodyId::kSaturn]; saturn.visible && saturn.look.is_measured())
        saturn_light_.emplace(saturn.look);
    for (std::size_t i = 0; i < kMaxBodies; ++i) {
        map_factor_[i].bin.fill(1);
        map_mean_[i].bin.fill(1);
        if ((*scene_.all)[i].map.empty()) continue;
        const Spectrum mean = bands_.spectrum(mean_texel((*scene_.all)[i].map));
        if ((*scene_.all)[i].map_reference > 0) {
            const auto one = static_cast<float>(1 / (*scene_.all)[i].map_reference);
            for (int b = 0; b < grid.solar_bins(); ++b) map_factor_[i][b] = one;
            map_mean_[i] = map_factor_[i] * mean;
            continue;
        }
        if ((*scene_.all)[i].look.plain_lambert()) {
            map_mean_[i] = mean;
            continue;
        }
        // A look scaled to a magnitude keeps its total light: the map is relative to its mean.
        for (int b = 0; b < bins_; ++b) map_factor_[i][b] = mean[b] > 0 ? 1 / mean[b] : 0.0f;
    }
}

// Bodies with a measured magnitude get its total light; for others shape and poles make no difference.
void BodyRadiance::set_brightness(PlacedBody& body) const {
    const BodyLook& look = scene_[body.id].look;
    if (!look.is_measured() || !(body.distance_m > 0)) return;
    const DiskView view{body.camera_m / body.distance_m, body.sun_dir};
    if (scene_.has_rings(body.id) && saturn_light_) {
        const SaturnLight::Factor by = saturn_light_->factor(view);
        body.globe_factor = static_cast<float>(by.globe), body.ring_factor = static_cast<float>(by.rings);
        return;
    }
    body.globe_factor = static_cast<float>(shape_factor(body.figure, look.law(), view) *
                                           latitude_factor(body.id, body.figure, view));
}

double BodyRadiance::met(const PlacedBody& body, Vec3d origin_m, Vec3d dir) const {
    const BodyRelief& relief = scene_[body.id].relief;
    if (relief.empty()) return intersect_ellipsoid(body.figure, origin_m, dir);
    const double per_length = length(dir);
    const double distance_m = relief.intersect(origin_m, dir / per_length);
    return distance_m < 0 ? distance_m : distance_m / per_length;
}

Spectrum BodyRadiance::surface(const PlacedBody& body, Vec3d point_m, Vec3d to_viewer_dir,
                               const Eclipses& eclipses) const {
    const SceneBody& scene = scene_[body.id];
    const Figure& figure = body.figure;
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
    if (scene_.has_air(body.id)) {
        // tau_1 dims the Sun; the sky adds its light on the ground, which is treated as Lambertian.
        const Vec3d p = stretched(figure, point_m), s = normalized(stretched(figure, body.sun_dir));
        light = light * scene_.air->sun_transmittance(p, s);
        light += static_cast<float>(1 / kPi) * (scene.look.albedo() * scene_.air->sky_irradiance(p, s));
    } else if (mu0 <= 0 && body.shine_count == 0) {
        return scene.look.heat().none() ? Spectrum{}
                                        : scene.look.heat().radiance(place_of(level, body.sun_dir, 0));
    }
    if (mu0 > 0 && scene_.has_rings(body.id))
        light = static_cast<float>(SaturnRings::transmittance(point_m, body.sun_dir)) * light;
    if (mu0 > 0 && !scene.relief.empty())
        light =
            static_cast<float>(scene.relief.sun_share(point_m, body.sun_dir, body.sun_radius_rad)) * light;
    Spectrum texel;
    texel.bin.fill(1);
    if (!scene.map.empty()) {
        // Longitude increases with u from 180 W. Latitude is that of the normal, or flatter (Snyder, USGS
        // Professional Paper 1395, 1987, eq. 3-28).
        const auto u = static_cast<float>(std::atan2(level.y, level.x) / (2 * kPi) + 0.5);
        const double latitude_rad =
            scene.map_latitude_factor == 1
                ? std::asin(std::clamp(level.z, -1.0, 1.0))
                : std::atan2(scene.map_latitude_factor * level.z, std::hypot(level.x, level.y));
        const auto v = static_cast<float>(0.5 - latitude_rad / kPi);
        // Relative to the equator's length.
        const double slant = std::max(0.25, dot(level, to_viewer_dir));
        const double footprint = pixel_rad_ * length(point_m - body.camera_m) /
                                 (std::sqrt(slant) * 2 * kPi * figure.equatorial_radius_m);
        texel = bands_.spectrum(scene.map.sample(u, v, static_cast<float>(footprint))) *
                map_factor_[index_of(body.id)];
        light = light * texel;
    }
    if (body.may_be_eclipsed)
        light = light * eclipses.sun_seen_from(body.id, transposed(body.fixed_from_world) * point_m);
    Spectrum out = body.irradiance_w_m2_um * light;
    if (!scene.look.heat().none()) out += scene.look.heat().radiance(place_of(level, body.sun_dir, mu0));
    for (std::size_t k = 0; k < body.shine_count; ++k) {
        const PlacedBody::Shine& shine = body.shine[k];
        out += shine.irradiance_w_m2_um * texel *
               scene.look.reflectance_sr(static_cast<float>(dot(normal, shine.dir)),
                                         static_cast<float>(dot(normal, to_viewer_dir)),
                                         static_cast<float>(dot(shine.dir, to_viewer_dir)));
    }
    return out;
}

// Adds the rings on a ray before `until`, with Saturn's shadow on them.
void BodyRadiance::add_rings(const PlacedBody& body, Vec3d origin_m, Vec3d dir, const RingSight& sight,
                             Spectrum& weight, Spectrum& radiance) const {
    const SaturnRings::Met there = SaturnRings::meet(origin_m, dir);
    if (there.distance < 0 || there.distance >= sight.until) return;
    const Vec3d to_viewer = normalized(-dir);
    const double slant = std::max(0.1, std::abs(to_viewer.z));
    const double footprint_m = sight.width_rad * there.distance * length(dir) / std::sqrt(slant);
    const SaturnRings::Look look = rings_.look(there.point_m, footprint_m, to_viewer, body.sun_dir);
    if (sight.lit && intersect_ellipsoid(body.figure, there.point_m, body.sun_dir) < 0)
        radiance += body.ring_factor * (weight * body.irradiance_w_m2_um * look.radiance_sr);
    weight = look.transmittance * weight;
}

std::string BodyRadiance::describe(const PlacedBody& body) const {
    const SceneBody& scene = scene_[body.id];
    std::string out;
    const auto add = [&](const std::string& part) { out += (out.empty() ? "" : ", ") + part; };
    if (scene.look.is_hapke()) add("Hapke's law at each ray");
    if (!scene.relief.empty()) {
        const long tenths = std::lround(scene.relief.spacing_m() * 1e-2);
        add("relief with posts " + std::to_string(tenths / 10) + "." + std::to_string(tenths % 10) +
            " km apart: rays are followed to the ground, and to the Sun where it stands low");
    }
    if (scene_.has_rings(body.id)) add("its rings at each ray, with the shadows of each on the other");
    for (std::size_t k = 0; k < body.shine_count; ++k)
        if (max_component(body.shine[k].irradiance_w_m2_um) > 0 && k == 0) add("light of other bodies on it");
    return out;
}

namespace {

// Returns the ellipse that a body shows, over pi and the square of its distance. Its semi-axes are a and
// sqrt(a^2 sin^2 + b^2 cos^2) of the camera's latitude.
double outline_over_distance(const PlacedBody& body) {
    const double a = body.figure.equatorial_radius_m, b = body.figure.polar_radius_m;
    const double sine = body.camera_m.z / body.distance_m, distance2 = body.distance_m * body.distance_m;
    return a * std::sqrt(a * a * sine * sine + b * b * (1 - sine * sine)) / distance2;
}

}  // namespace

Spectrum BodyRadiance::point_reflected(const PlacedBody& body) const {
    const Figure& figure = body.figure;
    const double a = figure.equatorial_radius_m;
    const Vec3d to_camera = body.camera_m / body.distance_m;
    if (scene_.is_modelled(body.id))
        return static_cast<float>(a * a / (body.distance_m * body.distance_m)) *
               (body.irradiance_w_m2_um * scene_.earth->disk_albedo(to_camera, body.sun_dir, 400));
    const DiskView view{to_camera, body.sun_dir};
    const BodyLook& look = scene_[body.id].look;
    const double distance2 = body.distance_m * body.distance_m;
    Spectrum out =
        static_cast<float>(outline_over_distance(body)) *
        (body.irradiance_w_m2_um * look.disk_albedo(view.phase_rad()) * map_mean_[index_of(body.id)]);
    if (!look.is_measured()) return out;
    if (body.id == BodyId::kSaturn && saturn_light_) {
        // The magnitude includes its rings, whether they are drawn or not.
        const SaturnLight::Parts parts = saturn_light_->parts(view);
        return static_cast<float>(parts.globe_share) * out +
               static_cast<float>(parts.rings_m2 / distance2) * (body.irradiance_w_m2_um * rings_.color());
    }
    return static_cast<float>(latitude_factor(body.id, figure, view)) * out;
}

Spectrum BodyRadiance::point_irradiance(const PlacedBody& body) const {
    const Spectrum reflected = point_reflected(body);
    const BodyHeat& heat = scene_[body.id].look.heat();
    if (heat.none()) return reflected;
    const DiskView view{body.camera_m / body.distance_m, body.sun_dir};
    return reflected + static_cast<float>(outline_over_distance(body)) * heat.disk_w_m2_um(view.phase_rad());
}

}  // namespace hilcam
