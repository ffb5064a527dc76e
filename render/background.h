#pragma once
// What a ray meets that meets no object: the Earth, the Sun's disk, or black sky. Stars are point sources,
// not here.

#include "render/color_bands.h"
#include "render/earth_rays.h"
#include "render/scene.h"

namespace hilcam {

class Background {
  public:
    // The Earth of the scene must outlive this.
    Background(const Earth& earth, const Spectrum& sun_irradiance_1au_w_m2_um, const SpectralGrid& grid);

    // Once per frame.
    void place(const WorldSnapshot& world);

    // Toward the Sun from the camera; the objects are so near that it serves them too.
    Vec3d sun_world_dir() const { return sun_world_dir_; }
    // At the camera's distance from the Sun [W m^-2 um^-1]; zero in the Earth's shadow, which is taken as
    // sharp: the middle of the Sun's disk decides.
    const Spectrum& sun_irradiance_w_m2_um() const { return sun_irradiance_; }

    bool earth_visible() const { return earth_.visible; }
    // The Earth's bounding cone from the camera: axis, and sine and cosine of its half angle. Inside the
    // Earth's largest sphere the cone is a half space.
    Vec3d earth_world_dir() const { return earth_world_dir_; }
    double earth_cone_cosine() const { return earth_cone_cosine_; }

    // Adds weight * radiance of the Earth along a ray (origin relative to the camera, world axes, direction
    // of any length). Gives whether the Earth was met. Radiance: albedo E_s cos(sigma) / pi (Lambert). Loop,
    // any thread.
    bool add_earth(Vec3f origin_m, Vec3d dir, const Spectrum& weight, Spectrum& radiance) const;
    // The same for many of the camera's own rays: directions corner + x right + y down in world axes, then a
    // radiance for each cosine of the Sun's zenith angle. Not for an Earth with a map.
    EarthRays earth_rays(Vec3d corner_dir, Vec3d right_dir, Vec3d down_dir) const;
    void add_earth_at(float sun_cosine, const Spectrum& weight, Spectrum& radiance) const {
        if (sun_cosine > 0) radiance += sun_cosine * (weight * earth_radiance_at_zenith_sun_);
    }
    bool earth_has_map() const { return !earth_.map.texels.empty(); }
    // Whether the Earth lies before `distance`, in lengths of the direction. Loop, any thread.
    bool earth_hides(Vec3f origin_m, Vec3d dir, double distance) const;
    // From the camera to the nearest that any of the Earth can be.
    double earth_nearest_m() const { return earth_nearest_m_; }
    // What add_earth does, for the Sun's disk, taken as uniform: E_s / (pi sin^2 rho) inside its angular
    // radius rho.
    void add_sun_disk(Vec3f dir, const Spectrum& weight, Spectrum& radiance) const;
    double sun_disk_cosine() const { return sun_disk_cosine_; }

  private:
    const Earth& earth_;
    Spectrum sun_irradiance_1au_;
    ColorBands bands_;
    int bins_;

    Spectrum sun_irradiance_;
    Spectrum earth_radiance_at_zenith_sun_;
    Vec3d camera_earth_fixed_m_;
    Mat3d earth_fixed_from_world_;
    Vec3d sun_earth_fixed_dir_;
    Vec3d sun_world_dir_{0, 0, 1};
    Vec3d earth_world_dir_{0, 0, 1};
    double earth_cone_cosine_ = 1;
    double earth_nearest_m_ = 0;
    double sun_disk_cosine_ = 1;
};

}  // namespace hilcam
