#include "render/background/placed_bodies.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "render/earth/earth_model.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

// Returns the body's middle as a moving camera sees it: exact for its limb. The ground below the camera is
// nearer than the limb and its light arrives earlier; the body's rotation is corrected for that.
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

void PlacedBodies::place(const WorldSnapshot& world, Vec3d objects_world_m, double pixel_rad,
                         std::optional<BodyId> ground, const BodyRadiance& light) {
    disk_count_ = point_count_ = 0;
    nearest_m_ = std::numeric_limits<double>::infinity();
    camera_in_air_ = false;
    for (std::size_t i = 0; i < kMaxBodies; ++i) {
        const auto id = static_cast<BodyId>(i);
        if (!scene_[id].visible) continue;
        const PlacedBody body = placed(id, world, light, id == ground);
        const double radius_m = body.figure.equatorial_radius_m;
        if (2 * radius_m < pixel_rad * body.distance_m) {
            points_[point_count_++] = body;
            continue;
        }
        disks_[disk_count_] = body;
        disks_[disk_count_].in_points = is_seen_in_points(body, pixel_rad);
        light.set_brightness(disks_[disk_count_++]);
        const bool reaches = !scene_[id].relief.empty() || scene_.has_rings(id);
        const double reach_m = reaches ? outer_radius_m(id, body.figure) : radius_m;
        nearest_m_ = std::min(nearest_m_, std::max(0.0, body.distance_m - reach_m));
        if (scene_.has_air(id) && body.distance_m < radius_m + scene_.air->top_m()) camera_in_air_ = true;
    }
    std::sort(disks_.begin(), disks_.begin() + static_cast<std::ptrdiff_t>(disk_count_),
              [](const PlacedBody& a, const PlacedBody& b) { return a.distance_m < b.distance_m; });
    for (std::size_t i = 0; i < disk_count_; ++i)
        lights_[i] = light_of(disks_[i], world.bodies[disks_[i].id].world_m - objects_world_m);
}

PlanetshineSource PlacedBodies::light_of(const PlacedBody& body, Vec3d to_body_m) const {
    // Lambert's radiance is at most albedo / pi; Lommel-Seeliger's w / 4 pi at the bright limb.
    Spectrum most = scene_[body.id].look.max_sr();
    if (scene_.is_modelled(body.id)) most.bin.fill(EarthModel::kMaxOverSun);
    const float sun_share = body.irradiance_w_m2_um[0] / std::max(1e-30f, sun_irradiance_1au_[0]);
    Spectrum emitted;
    if (const BodyHeat& heat = scene_[body.id].look.heat(); !heat.none())
        for (int b = 0; b < kMaxBins; ++b)
            if (sun_irradiance_1au_[b] > 0) emitted[b] = heat.most()[b] / sun_irradiance_1au_[b];
    const double radius_m = body.figure.equatorial_radius_m + scene_.top_m(body.id);
    const double sine = std::min(1.0, radius_m / length(to_body_m));
    return {normalized(to_body_m), static_cast<float>(sine * sine),
            static_cast<float>(sine * sine / (1 + std::sqrt(1 - sine * sine))),
            body.globe_factor * sun_share * most + emitted};
}

void PlacedBodies::show(const SceneBodies& scene) {
    scene_ = scene;
    for (PlacedBody& body : disks_)
        if (!scene[body.id].planetshine) body.shine_count = 0;
}

PlacedBody PlacedBodies::placed(BodyId id, const WorldSnapshot& world, const BodyRadiance& light,
                                bool stays) const {
    const BodyState& state = world.bodies[id];
    const Figure& figure = world.bodies.figure(id);
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
    out.cone_cosine = scene_.top_m(id) > 0 || scene_.has_rings(id) || !scene_[id].relief.empty()
                          ? cone_cosine_of(outer_radius_m(id, figure), out.distance_m)
                          : out.disk_cosine;
    out.seen_cosine = std::cos(std::min(std::acos(out.cone_cosine) + scene_.max_turn_rad(), kPi));
    const Vec3d to_sun_m = world.bodies.sun_world_m - state.world_m;
    const double sun_m = length(to_sun_m);
    out.sun_dir = out.fixed_from_world * (to_sun_m / sun_m);
    const double au = kAstronomicalUnit_m / sun_m;
    out.irradiance_w_m2_um = static_cast<float>(au * au) * sun_irradiance_1au_;
    out.sun_radius_rad = kSunRadius_m / sun_m;
    if (scene_[id].planetshine) add_planetshine(world, light, out);
    for (std::size_t i = 0; i < kMaxBodies; ++i) {
        if (!(*scene_.all)[i].visible || i == index_of(id)) continue;
        const Vec3d to_other = world.bodies.body[i].world_m - state.world_m;
        const double other_m = length(to_other);
        // The shadow cone grows by the body's own radius over the distance.
        const double reach =
            (world.bodies.figure(static_cast<BodyId>(i)).equatorial_radius_m + figure.equatorial_radius_m) /
            other_m;
        if (other_m < sun_m && reach < 1 &&
            can_cover(dot(to_other, to_sun_m) / (other_m * sun_m), std::sqrt(1 - reach * reach),
                      cone_cosine_of(kSunRadius_m, sun_m)))
            out.may_be_eclipsed = true;
    }
    return out;
}

double PlacedBodies::outer_radius_m(BodyId id, const Figure& figure) const {
    if (scene_.has_rings(id)) return SaturnRings::kOuter_m;
    const BodyRelief& relief = scene_[id].relief;
    const double mountains_m = relief.empty() ? 0 : std::max(0.0, relief.highest_m());
    return figure.equatorial_radius_m + std::max(scene_.top_m(id), mountains_m);
}

bool PlacedBodies::is_seen_in_points(const PlacedBody& body, double pixel_rad) const {
    constexpr double kFar = 8;  // in radii: nearer, a few pixels are a large part of the sky
    // For a ringed body the globe counts: a grid of rays would meet its rings by chance.
    const double radius_m =
        scene_.has_rings(body.id) ? body.figure.equatorial_radius_m : outer_radius_m(body.id, body.figure);
    return !scene_.is_modelled(body.id) && !scene_.has_air(body.id) &&
           body.distance_m > kFar * outer_radius_m(body.id, body.figure) &&
           2 * radius_m < kBodyPoints_px * pixel_rad * body.distance_m;
}

// Adds each of the others as a disk at its phase seen from this body, without its air.
void PlacedBodies::add_planetshine(const WorldSnapshot& world, const BodyRadiance& light,
                                   PlacedBody& out) const {
    const Vec3d here_m = world.bodies[out.id].world_m;
    for (std::size_t i = 0; i < kMaxBodies; ++i) {
        if (!(*scene_.all)[i].visible || i == index_of(out.id)) continue;
        const Vec3d to_other_m = world.bodies.body[i].world_m - here_m;
        const Vec3d to_sun_m = world.bodies.sun_world_m - world.bodies.body[i].world_m;
        const double other_m = length(to_other_m), sun_m = length(to_sun_m);
        const double radius_m = world.bodies.figure(static_cast<BodyId>(i)).equatorial_radius_m;
        if (other_m <= radius_m) continue;
        const double phase = std::acos(std::clamp(dot(to_other_m, to_sun_m) / (-other_m * sun_m), -1.0, 1.0));
        const double au = kAstronomicalUnit_m / sun_m, part = au * radius_m / other_m;
        // A magnitude belongs to the outline seen from the equator.
        const double outline = (*scene_.all)[i].look.is_measured()
                                   ? world.bodies.figure(static_cast<BodyId>(i)).polar_radius_m /
                                         world.bodies.figure(static_cast<BodyId>(i)).equatorial_radius_m
                                   : 1;
        const PlacedBody::Shine shine{
            out.fixed_from_world * (to_other_m / other_m),
            static_cast<float>(part * part * outline) *
                (sun_irradiance_1au_ * (*scene_.all)[i].look.disk_albedo(phase) * light.map_mean(i))};
        // Keeps the strongest two.
        std::size_t at = out.shine_count;
        while (at > 0 &&
               max_component(out.shine[at - 1].irradiance_w_m2_um) < max_component(shine.irradiance_w_m2_um))
            --at;
        if (at == out.shine.size()) continue;
        out.shine_count = std::min(out.shine_count + 1, out.shine.size());
        for (std::size_t k = out.shine_count - 1; k > at; --k) out.shine[k] = out.shine[k - 1];
        out.shine[at] = shine;
    }
    // A second one that is invisible beside the first is not worth a ray.
    constexpr float kSeen = 1e-3f;
    if (out.shine_count == 2 && max_component(out.shine[1].irradiance_w_m2_um) <
                                    kSeen * max_component(out.shine[0].irradiance_w_m2_um))
        out.shine_count = 1;
}

}  // namespace hilcam
