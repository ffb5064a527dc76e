#pragma once
// Eclipses: the share of the Sun that bodies leave visible at a place, with the Sun's limb darkening and the
// Earth's air, which dims sunlight and bends it into the shadow.

#include "render/background/scene_bodies.h"
#include "render/sky/bodies.h"
#include "render/sky/sun.h"

namespace hilcam {

class Eclipses {
  public:
    Eclipses(const SceneBodies& scene, const SunDisk& disk, int bins)
        : scene_(scene), disk_(disk), bins_(bins) {}

    // Called once per frame.
    void place(const Bodies& bodies) { bodies_ = bodies; }
    void show(const SceneBodies& scene) { scene_ = scene; }

    // Returns the share of the Sun's irradiance that bodies leave at a place in the world [0..1], per bin.
    // standing_on: a body that is ignored. Loop, any thread.
    Spectrum sun_seen_from(Vec3d place_world_m, BodyId standing_on) const;
    // The same at a place on a body, in world axes from its centre.
    Spectrum sun_seen_from(BodyId body, Vec3d from_centre_world_m) const {
        return sun_seen_from(bodies_[body].world_m + from_centre_world_m, body);
    }

  private:
    SceneBodies scene_;
    SunDisk disk_;
    int bins_;
    Bodies bodies_;

    Spectrum passed_by(BodyId body, const Figure& figure, Vec3d origin_m, Vec3d dir) const;
};

}  // namespace hilcam
