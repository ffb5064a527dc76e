#include "render/background.h"

#include <algorithm>
#include <cmath>

#include "render/units.h"

namespace hilcam {

Background::Background(const Earth& earth, const Spectrum& sun_irradiance_1au_w_m2_um,
                       const SpectralGrid& grid)
    : earth_(earth), sun_irradiance_1au_(sun_irradiance_1au_w_m2_um), bands_(grid), bins_(grid.size()) {}

void Background::place(const WorldSnapshot& world) {
    const Vec3d to_sun_m = world.bodies.sun_world_m - world.camera.position_world_m;
    const double sun_distance_m = length(to_sun_m);
    sun_world_dir_ = to_sun_m / sun_distance_m;
    const double sine = std::min(1.0, kSunRadius_m / sun_distance_m);
    sun_disk_cosine_ = std::sqrt(1 - sine * sine);

    earth_fixed_from_world_ = world.bodies.earth_fixed_from_world;
    const Vec3d camera_from_earth_m = world.camera.position_world_m - world.bodies.earth_world_m;
    camera_earth_fixed_m_ = earth_fixed_from_world_ * camera_from_earth_m;
    const double earth_distance_m = length(camera_from_earth_m);
    earth_world_dir_ = earth_distance_m > 0 ? -camera_from_earth_m / earth_distance_m : Vec3d{0, 0, 1};
    const double earth_sine = std::min(1.0, kEarthEquatorialRadius_m / earth_distance_m);
    earth_cone_cosine_ = std::sqrt(1 - earth_sine * earth_sine);
    earth_nearest_m_ = std::max(0.0, earth_distance_m - kEarthEquatorialRadius_m);

    // The inverse-square law from 1 au for the objects, and from the Earth's own distance for the Earth.
    const double au = kAstronomicalUnit_m / sun_distance_m;
    const Vec3d earth_to_sun_m = world.bodies.sun_world_m - world.bodies.earth_world_m;
    const double earth_au = kAstronomicalUnit_m / length(earth_to_sun_m);
    sun_earth_fixed_dir_ = earth_fixed_from_world_ * normalized(earth_to_sun_m);
    const bool eclipsed = earth_.visible && intersect_earth(camera_earth_fixed_m_,
                                                            earth_fixed_from_world_ * sun_world_dir_) >= 0;
    for (int b = 0; b < bins_; ++b) {
        const double at_1au = static_cast<double>(sun_irradiance_1au_[b]);
        sun_irradiance_[b] = eclipsed ? 0.0f : static_cast<float>(at_1au * au * au);
        earth_radiance_at_zenith_sun_[b] =
            static_cast<float>(static_cast<double>(earth_.albedo[b]) * at_1au * earth_au * earth_au / kPi);
    }
}

bool Background::add_earth(Vec3f origin_m, Vec3d dir, const Spectrum& weight, Spectrum& radiance) const {
    if (!earth_.visible) return false;
    const Vec3d origin = camera_earth_fixed_m_ + earth_fixed_from_world_ * to_double(origin_m);
    const Vec3d d = earth_fixed_from_world_ * dir;
    const double distance = intersect_earth(origin, d);
    if (distance < 0) return false;
    const Vec3d normal = earth_normal(origin + distance * d);
    const auto sun_cosine = static_cast<float>(dot(normal, sun_earth_fixed_dir_));
    if (sun_cosine <= 0) return true;
    if (earth_.map.texels.empty()) {
        for (int b = 0; b < bins_; ++b)
            radiance[b] += weight[b] * sun_cosine * earth_radiance_at_zenith_sun_[b];
        return true;
    }
    // Geodetic latitude is the normal's own; longitude runs with u from 180 W.
    const auto u = static_cast<float>(std::atan2(normal.y, normal.x) / (2 * kPi) + 0.5);
    const auto v = static_cast<float>(0.5 - std::asin(std::clamp(normal.z, -1.0, 1.0)) / kPi);
    const Spectrum reflectance = bands_.spectrum(sample(earth_.map, u, v));
    for (int b = 0; b < bins_; ++b)
        radiance[b] += weight[b] * sun_cosine * reflectance[b] * earth_radiance_at_zenith_sun_[b];
    return true;
}

EarthRays Background::earth_rays(Vec3d corner_dir, Vec3d right_dir, Vec3d down_dir) const {
    return {camera_earth_fixed_m_, sun_earth_fixed_dir_, earth_fixed_from_world_ * corner_dir,
            earth_fixed_from_world_ * right_dir, earth_fixed_from_world_ * down_dir};
}

bool Background::earth_hides(Vec3f origin_m, Vec3d dir, double distance) const {
    const double earth = intersect_earth(
        camera_earth_fixed_m_ + earth_fixed_from_world_ * to_double(origin_m), earth_fixed_from_world_ * dir);
    return earth >= 0 && earth < distance;
}

void Background::add_sun_disk(Vec3f dir, const Spectrum& weight, Spectrum& radiance) const {
    if (dot(to_double(dir), sun_world_dir_) < sun_disk_cosine_) return;
    const double solid_angle_projected = kPi * (1 - sun_disk_cosine_ * sun_disk_cosine_);
    for (int b = 0; b < bins_; ++b)
        radiance[b] += weight[b] * sun_irradiance_[b] / static_cast<float>(solid_angle_projected);
}

}  // namespace hilcam
