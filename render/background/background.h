#pragma once
// The background that a ray sees if it meets no object: the Moon and the planets with their air, the Sun's
// disk, or black sky. Stars are point sources and not included. placed_bodies.h has the positions of bodies,
// body_radiance.h their light, eclipses.h how they cover the Sun. The air bends the camera's rays
// (render/sky/air_refraction.h).

#include <array>
#include <optional>
#include <string>

#include "render/background/body_radiance.h"
#include "render/background/eclipses.h"
#include "render/background/placed_bodies.h"
#include "render/earth/earth_moment.h"
#include "render/earth/earth_rays.h"
#include "render/scene/scene.h"
#include "render/sky/air_refraction.h"
#include "render/sky/sun.h"
#include "render/vocabulary/pixel_box.h"

namespace hilcam {

class EarthPatch;

class Background {
  public:
    // Bodies, air and Earth of the scene must outlive this.
    Background(const std::array<SceneBody, kMaxBodies>& bodies, const Atmosphere* air,
               const EarthModel* earth, const Spectrum& sun_irradiance_1au_w_m2_um, bool limb_darkening,
               const SpectralGrid& grid);

    // Called once per frame. objects_world_m: position of the objects, and origin of rays (frame_context.h).
    // pixel_rad: bodies smaller than this are points and not drawn here. Bodies are where a moving camera
    // sees them, except the one whose ground is among the objects, which stays with it.
    void place(const WorldSnapshot& world, Vec3d objects_world_m, double pixel_rad,
               std::optional<BodyId> ground = {});

    // The Sun for the objects: direction, and irradiance with eclipses and air [W m^-2 um^-1].
    Vec3d sun_world_dir() const { return sun_world_dir_; }
    const Spectrum& sun_irradiance_w_m2_um() const { return sun_irradiance_; }
    // The same without eclipses and air.
    const Spectrum& sun_clear_irradiance_w_m2_um() const { return sun_clear_irradiance_; }
    double sun_disk_cosine() const { return sun_disk_cosine_; }
    // Returns the cosine of the cone around the Sun's direction that contains its disk as seen through the
    // air.
    double sun_seen_cosine() const { return sun_seen_cosine_; }
    const SunDisk& sun_disk() const { return disk_; }
    // Returns the Sun's direction as the camera sees it.
    Vec3d sun_camera_dir() const { return sun_camera_dir_; }

    // Bodies with a disk, nearest first; and bodies that are points.
    std::span<const PlacedBody> disks() const { return placed_.disks(); }
    std::span<const PlacedBody> points() const { return placed_.points(); }
    std::span<const PlanetshineSource> planetshine_sources() const { return placed_.lights(); }
    // Returns the irradiance of a point body at the camera [W m^-2 um^-1].
    Spectrum point_irradiance(const PlacedBody& body) const { return light_.point_irradiance(body); }
    // Returns the radiance of a body's ground and rings in a direction (any length) from the camera, ignoring
    // everything in front of it; 0 outside it [W m^-2 sr^-1 um^-1]. width_rad: cone over which rings are
    // averaged; 0: a pixel's. Loop.
    Spectrum ground_radiance(const PlacedBody& body, Vec3d dir, double width_rad = 0) const;
    const Atmosphere* air() const { return scene_.air; }
    const EarthModel* earth() const { return scene_.earth; }
    // Returns this frame's position between the Earth's maps in time.
    MapNumbers map_numbers() const { return earth_moment_.number; }
    // Lets this frame's rays to the Earth use finer levels, which must outlive it. Loop, after place().
    void show_detail(const DetailTiles& tiles) { earth_moment_.detail = &tiles; }
    bool shows_detail() const { return earth_moment_.detail != nullptr; }
    std::string name_of(BodyId id) const { return scene_.name_of(id); }
    // Returns how high above its ground a body is visible [m].
    double top_m(BodyId id) const { return scene_.top_m(id); }
    // True when the camera is in air, so that objects are seen through it.
    bool camera_in_air() const { return placed_.camera_in_air(); }

    // Adds weight * radiance of the nearest body along a ray (origin relative to the objects, world axes,
    // direction of any length), with air. Returns true if a body was met; air alone does not count, but dims
    // `weight` for what is behind it. width_rad: cone of the ray, over which the Earth's maps are averaged;
    // 0: a pixel's. Loop, any thread.
    bool add_bodies(Vec3f origin_m, Vec3d dir, Spectrum& weight, Spectrum& radiance,
                    double width_rad = 0) const {
        return add_bodies_from(to_double(origin_m) + objects_from_camera_m_, dir, weight, radiance,
                               {width_rad > 0 ? width_rad : pixel_rad_, false});
    }
    // Tests cheaply whether add_bodies() could add anything. dir: unit.
    bool may_meet_body(Vec3f dir) const {
        for (const PlanetshineSource& lamp : planetshine_sources()) {
            const Vec3f axis = to_float(lamp.world_dir);
            const float cosine = dot(axis, dir);
            // The cone, with a margin for single precision and for the objects' own size.
            if (cosine > 0 && 1 - cosine * cosine <= lamp.cone_sine_squared + 1e-3f) return true;
            if (lamp.cone_sine_squared >= 1) return true;
        }
        return false;
    }
    // The same as add_bodies(), from the camera.
    bool add_bodies_seen(Vec3d dir, Spectrum& weight, Spectrum& radiance) const {
        return add_bodies_from({}, dir, weight, radiance, {pixel_rad_, true});
    }
    // Returns the direction in which the camera sees a point of the sky, and the share of its light that is
    // left after the air has spread it. distance_m: infinite for stars. add_bodies_seen() dims the light
    // further. Loop, any thread.
    AirRefraction::Seen seen_through_air(Vec3d dir, double distance_m) const;
    // Returns the largest angle between a point and the direction in which it is seen, in any frame [rad].
    double max_turn_rad() const { return scene_.max_turn_rad(); }
    // Adds the radiance of the Sun's disk in the same way: mean radiance E_s / (pi sin^2 rho) inside its
    // angular radius rho, darker towards the edge. Without eclipses: what covers the Sun blocks the ray
    // itself.
    void add_sun_disk(Vec3d dir, const Spectrum& weight, Spectrum& radiance) const;
    // Does the same for a ray of the camera, which the air may bend.
    void add_sun_disk_seen(Vec3d dir, const Spectrum& weight, Spectrum& radiance) const {
        add_sun_disk(beyond_air(dir), weight, radiance);
    }
    // True when a body is nearer than `distance`, in lengths of the direction. Loop, any thread.
    bool hides(Vec3f origin_m, Vec3d dir, double distance) const {
        return hides_from(to_double(origin_m) + objects_from_camera_m_, dir, distance);
    }
    bool hides_seen(Vec3d dir, double distance) const { return hides_from({}, dir, distance); }
    // The body that add_bodies_seen() finds along a camera ray, without its air. Loop, any thread.
    struct BodyMet {
        const PlacedBody* body = nullptr;  // null: none
        double distance = 0;               // in lengths of the direction
        Vec3d normal_world_dir;            // normal of its ground, unit
    };
    BodyMet first_body_seen(Vec3d dir) const;
    // True when a camera ray that meets nothing else meets the Sun's disk.
    bool sees_sun_disk(Vec3d dir) const { return meets_sun_disk(beyond_air(dir)); }
    // Returns the distance from the camera to the nearest place of any body.
    double nearest_m() const { return placed_.nearest_m(); }
    // Returns light and transmittance of the air in front of an object at a distance; only if
    // camera_in_air().
    Atmosphere::Sight air_before(Vec3d dir, double distance_m) const;

    const SceneBody& scene_of(const PlacedBody& body) const { return scene_[body.id]; }
    // Returns a copy with the same positions that shows bodies and an Earth with fewer parts (sky_cost.h);
    // these must outlive it. Not for the loop.
    Background with(const std::array<SceneBody, kMaxBodies>& bodies, const EarthModel* earth) const;
    const std::array<SceneBody, kMaxBodies>& bodies() const { return *scene_.all; }

    // Describes what makes a body's look cost more than its reflection law; empty: nothing does. Not for the
    // loop.
    std::string describe(const PlacedBody& body) const { return light_.describe(body); }

    // Says what data the air lacks for a camera ray (Atmosphere::missing).
    std::string air_missing(Vec3d dir) const;

    // The one body in view that EarthRays can compute sixteen rays at a time, or null.
    const PlacedBody* plain_body() const { return plain_; }
    EarthRays plain_rays(Vec3d corner_dir, Vec3d right_dir, Vec3d down_dir) const;
    void add_plain_at(float sun_cosine, const Spectrum& weight, Spectrum& radiance) const {
        if (sun_cosine > 0) radiance += sun_cosine * (weight * plain_radiance_);
    }

    // True when the Earth's model can be seen in patches (earth_patch.h): nothing is in front of it, it is
    // not eclipsed, and the camera is above its air.
    bool earth_in_patches() const { return earth_in_patches_; }
    // Rays have directions corner + (x - box.x0) right + (y - box.y0) down, any length, world axes. Loop, any
    // thread.
    void place_earth_patch(const PixelBox& box, Vec3d corner_dir, Vec3d right_dir, Vec3d down_dir,
                           EarthPatch& patch) const;

    // Returns the share of the Sun's irradiance that bodies leave at a place in the world [0..1], per bin.
    Spectrum sun_seen_from(Vec3d place_world_m, BodyId standing_on) const {
        return eclipses_.sun_seen_from(place_world_m, standing_on);
    }

  private:
    SceneBodies scene_;
    EarthMoment earth_moment_;
    Spectrum sun_irradiance_1au_;
    SunDisk disk_;
    Eclipses eclipses_;
    BodyRadiance light_;
    PlacedBodies placed_;

    const PlacedBody* plain_ = nullptr;
    Spectrum plain_radiance_;
    Vec3d objects_from_camera_m_;
    Spectrum sun_irradiance_, sun_clear_irradiance_;
    Vec3d sun_world_dir_{0, 0, 1}, sun_camera_dir_{0, 0, 1};
    double sun_disk_cosine_ = 1, sun_seen_cosine_ = 1;
    double pixel_rad_ = 0;
    bool earth_in_patches_ = false;

    // The cone of a ray.
    struct Cone {
        double width_rad;
        bool of_pixel;  // it is a pixel's, from the camera
    };
    // A ray in a body's axes; the origin is relative to its centre.
    struct BodyRay {
        Vec3d origin_m, dir;
    };
    bool meets_sun_disk(Vec3d dir) const {
        const Vec3d d = normalized(dir), across = cross(d, sun_camera_dir_);
        return dot(across, across) <= 1 - sun_disk_cosine_ * sun_disk_cosine_ && dot(d, sun_camera_dir_) >= 0;
    }
    BodyRay ray_to(const PlacedBody& body, Vec3d origin_m, Vec3d dir) const;
    void pass_air(const PlacedBody& body, Vec3d& origin_m, Vec3d& dir) const;
    Vec3d beyond_air(Vec3d dir) const;
    void place_sun(const WorldSnapshot& world, Vec3d objects_world_m);
    void choose_quick_ways();
    bool add_bodies_from(Vec3d origin_m, Vec3d dir, Spectrum& weight, Spectrum& radiance, Cone cone) const;
    bool add_earth(const PlacedBody& body, Vec3d origin_m, Vec3d dir, Cone cone, Spectrum& weight,
                   Spectrum& radiance) const;
    void add_air(const PlacedBody& body, Vec3d origin_m, Vec3d dir, double until, Spectrum& weight,
                 Spectrum& radiance) const;
    bool hides_from(Vec3d origin_m, Vec3d dir, double distance) const;
};

}  // namespace hilcam
