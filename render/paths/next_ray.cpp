#include "render/paths/next_ray.h"

#include "render/indirect/kept_scene.h"
#include "render/sunlight/radiance_equation.h"

namespace hilcam {

void add_background(Tile& tile, const NextRay& ray) {
    Spectrum light;
    add_background_seen(tile.frame, ray, light);
    if (ray.from->depth == 1)
        tile.add(*ray.from, ray.part, light);
    else
        tile.add(*ray.from, ray.from->ray_part, light);
}

void add_background_seen(const FrameView& frame, const NextRay& ray, Spectrum& light) {
    const Background& background = *frame.background;
    if (ray.whole_lobe) {
        if (ray.sees_bodies) frame.kept->add_bodies_in_lobe(frame, *ray.from, ray.dir, ray.weight, light);
        if (ray.meets_sun) background.add_sun_disk(to_double(ray.dir), ray.weight, light);
        return;
    }
    const bool exact = ray.density == 0;
    const float lamps = exact ? 0 : body_light_density(frame, *ray.from, ray.dir);
    Spectrum weight = exact ? ray.weight : (ray.density / (ray.density + lamps)) * ray.weight;
    if (background.may_meet_body(ray.dir) &&
        background.add_bodies(ray.origin_m, to_double(ray.dir), weight, light))
        return;
    // The Sun is a point here, and it is added only where no lobe has counted its light.
    if (exact) {
        if (ray.meets_sun) background.add_sun_disk(to_double(ray.dir), weight, light);
        return;
    }
    const float sun = sun_density(frame, ray.dir);
    if (sun > 0) {
        weight = (ray.density / (ray.density + sun)) * ray.weight;
        background.add_sun_disk(to_double(ray.dir), weight, light);
    }
}

}  // namespace hilcam
