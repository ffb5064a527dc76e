#pragma once
// The light that a body sends: its ground by reflection law, map and relief, Saturn's rings, and its total as
// a point.

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

    // Called once per frame. pixel_rad: cone over which maps and reliefs are averaged.
    void place(double pixel_rad) { pixel_rad_ = pixel_rad; }
    void show(const SceneBodies& scene) { scene_ = scene; }

    // Returns where a ray meets a body's ground, in lengths of its direction; negative: it does not. Body
    // axes. Loop, any thread.
    double met(const PlacedBody& body, Vec3d origin_m, Vec3d dir) const;
    // Returns the radiance of a place on the ground (body axes) towards a viewer [W m^-2 sr^-1 um^-1]. Loop,
    // any thread.
    Spectrum surface(const PlacedBody& body, Vec3d point_m, Vec3d to_viewer_dir,
                     const Eclipses& eclipses) const;
    // The way in which a ray sees rings: up to `until`, in lengths of its direction; dark if their light is
    // drawn as points.
    struct RingSight {
        double until, width_rad;
        bool lit;
    };
    // Adds the rings that a ray meets, and dims `weight` by them. Loop, any thread.
    void add_rings(const PlacedBody& body, Vec3d origin_m, Vec3d dir, const RingSight& sight,
                   Spectrum& weight, Spectrum& radiance) const;
    // Returns the irradiance of a body as a point at the camera [W m^-2 um^-1].
    Spectrum point_irradiance(const PlacedBody& body) const;
    // Sets the factors that give the whole body the light of its magnitude.
    void set_brightness(PlacedBody& body) const;
    // Returns the mean colour of a body's map; 1 without a map.
    const Spectrum& map_mean(std::size_t body) const { return map_mean_[body]; }
    // Describes what makes a body's look cost more than its reflection law; empty: nothing does. Not for the
    // loop.
    std::string describe(const PlacedBody& body) const;

  private:
    Spectrum point_reflected(const PlacedBody& body) const;

    SceneBodies scene_;
    ColorBands bands_;
    SaturnRings rings_;
    std::optional<SaturnLight> saturn_light_;  // none: Saturn's brightness is not tied to a magnitude
    int bins_;
    std::array<Spectrum, kMaxBodies> map_factor_;  // factor on texel colours
    std::array<Spectrum, kMaxBodies> map_mean_;    // mean colour after that; 1 without a map
    double pixel_rad_ = 0;
};

}  // namespace hilcam
