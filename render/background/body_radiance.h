#pragma once
// The light that a body sends: its ground by its law, map and relief, Saturn's rings, and all of it as a point.

#include <array>
#include <optional>
#include <string>

#include "render/background/eclipses.h"
#include "render/background/placed_body.h"
#include "render/background/scene_bodies.h"
#include "render/scene/color_bands.h"
#include "render/sky/disk_light.h"
#include "render/sky/saturn_rings.h"

namespace hilcam {

class BodyRadiance {
  public:
    BodyRadiance(const SceneBodies& scene, const SpectralGrid& grid);

    // Once per frame. pixel_rad: width of the cone of which maps and reliefs show the mean.
    void place(double pixel_rad) { pixel_rad_ = pixel_rad; }
    void show(const SceneBodies& scene) { scene_ = scene; }

    // Returns where a ray meets a body's ground, in lengths of its direction; negative: it does not. Body axes. Loop, any thread.
    double met(const PlacedBody& body, Vec3d origin_m, Vec3d dir) const;
    // Returns the radiance of a place of the ground, in body axes, towards a viewer [W m^-2 sr^-1 um^-1]. Loop, any thread.
    Spectrum surface(const PlacedBody& body, Vec3d point_m, Vec3d to_viewer_dir,
                     const Eclipses& eclipses) const;
    // A ray sees rings up to `until`, in lengths of its direction; dark where their light comes by points.
    struct RingSight {
        double until, width_rad;
        bool lit;
    };
    // Adds the rings that a ray meets before that, and dims `weight` by them. Loop, any thread.
    void add_rings(const PlacedBody& body, Vec3d origin_m, Vec3d dir, const RingSight& sight,
                   Spectrum& weight, Spectrum& radiance) const;
    // Returns the irradiance of a body at the camera as a point [W m^-2 um^-1].
    Spectrum point_irradiance(const PlacedBody& body) const;
    // Sets the factors by which the whole of a body has the light of its magnitude.
    void set_brightness(PlacedBody& body) const;
    // Returns a body's mean colour by its map; 1 without.
    const Spectrum& map_mean(std::size_t body) const { return map_mean_[body]; }
    // Says in words what makes a body's look cost more than its law; empty: nothing does. Not for the loop.
    std::string describe(const PlacedBody& body) const;

  private:
    SceneBodies scene_;
    ColorBands bands_;
    SaturnRings rings_;
    std::optional<SaturnLight> saturn_light_;  // none: no magnitude says how bright Saturn is
    int bins_;
    std::array<Spectrum, kMaxBodies> map_factor_;  // on texel colours
    std::array<Spectrum, kMaxBodies> map_mean_;    // mean colour after that; 1 without a map
    double pixel_rad_ = 0;
};

}  // namespace hilcam
