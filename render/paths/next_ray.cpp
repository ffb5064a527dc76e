#include "render/paths/next_ray.h"

#include "render/indirect/indirect_cache.h"
#include "render/sunlight/radiance_equation.h"

namespace hilcam {

void add_background(Tile& tile, const NextRay& ray) {
    Spectrum light;
    const bool meets_body = add_background_seen(tile.frame, ray, light);
    // Light from a source counts as direct, even if next-event estimation leaves it to a random path's own
    // direction.
    const LightPart direct = meets_body ? LightPart::kPlanetshine : LightPart::kSun;
    tile.add(*ray.from, ray.part == LightPart::kPath ? direct : ray.part, light);
}

bool add_background_seen(const FrameContext& frame, const NextRay& ray, Spectrum& light) {
    const Background& background = *frame.background;
    if (ray.whole_lobe) {
        if (ray.sees_bodies)
            frame.indirect->add_bodies_in_lobe(frame, *ray.from, ray.dir, ray.throughput, light);
        if (ray.meets_sun) background.add_sun_disk(to_double(ray.dir), ray.throughput, light);
        return false;
    }
    const bool exact = ray.density == 0;
    const float lamps = exact ? 0 : planetshine_density(frame, *ray.from, ray.dir);
    Spectrum weight = exact ? ray.throughput : (ray.density / (ray.density + lamps)) * ray.throughput;
    if (background.may_meet_body(ray.dir) &&
        background.add_bodies(ray.origin_m, to_double(ray.dir), weight, light))
        return true;
    // The Sun is a point here, and counts only if no lobe has included its light.
    if (exact) {
        if (ray.meets_sun) background.add_sun_disk(to_double(ray.dir), weight, light);
        return false;
    }
    const float sun = sun_density(frame, ray.dir);
    if (sun > 0) {
        weight = (ray.density / (ray.density + sun)) * ray.throughput;
        background.add_sun_disk(to_double(ray.dir), weight, light);
    }
    return false;
}

}  // namespace hilcam
