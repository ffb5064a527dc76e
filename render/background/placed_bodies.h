#pragma once
// Places the bodies of the scene in a frame: which are disks, which are points, and which light the objects.

#include <array>
#include <optional>
#include <span>

#include "render/background/body_radiance.h"
#include "render/background/placed_body.h"
#include "render/background/scene_bodies.h"

namespace hilcam {

class PlacedBodies {
  public:
    PlacedBodies(const SceneBodies& scene, const Spectrum& sun_irradiance_1au_w_m2_um)
        : scene_(scene), sun_irradiance_1au_(sun_irradiance_1au_w_m2_um) {}

    // Called once per frame; arguments as for Background::place().
    void place(const WorldSnapshot& world, Vec3d objects_world_m, double pixel_rad,
               std::optional<BodyId> ground, const BodyRadiance& light);
    // Shows other bodies in the same positions; those without planetshine get none.
    void show(const SceneBodies& scene);

    // Bodies with a disk, nearest first; and bodies that are points.
    std::span<const PlacedBody> disks() const { return {disks_.data(), disk_count_}; }
    std::span<const PlacedBody> points() const { return {points_.data(), point_count_}; }
    // Bodies with a disk as lights, in the same order.
    std::span<const PlanetshineSource> lights() const { return {lights_.data(), disk_count_}; }
    // Returns the distance from the camera to the nearest place of any body.
    double nearest_m() const { return nearest_m_; }
    bool camera_in_air() const { return camera_in_air_; }

  private:
    SceneBodies scene_;
    Spectrum sun_irradiance_1au_;
    std::array<PlacedBody, kMaxBodies> disks_, points_;
    std::array<PlanetshineSource, kMaxBodies> lights_;
    std::size_t disk_count_ = 0, point_count_ = 0;
    double nearest_m_ = 0;
    bool camera_in_air_ = false;

    PlacedBody placed(BodyId id, const WorldSnapshot& world, const BodyRadiance& light, bool stays) const;
    void add_planetshine(const WorldSnapshot& world, const BodyRadiance& light, PlacedBody& body) const;
    PlanetshineSource light_of(const PlacedBody& body, Vec3d to_body_m) const;
    // Returns the radius including air or mountains.
    double outer_radius_m(BodyId id, const Figure& figure) const;
    bool is_seen_in_points(const PlacedBody& body, double pixel_rad) const;
};

}  // namespace hilcam
