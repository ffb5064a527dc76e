#include "render/shading/glossy_lobe.h"

namespace hilcam {

// Rays are few: one that meets a glint says that a tenth of the lobe does, and a pixel further on, or a frame later, none meets
// it. Cached light is even, but blurred. So where rays find more than cached light has, the surplus is believed as far as they
// are many that bring it, against the directions that brought the other: both numbers are those of equal shares that would
// scatter as much (Kish, Survey Sampling, 1965, section 8.2). Where they find less they are right, as what a place sees past an
// edge is none of its neighbour's.
float GlossyLobe::believed() const {
    if (!(found > cached)) return found;
    float squares = 0;
    for (const float ray : by_ray) squares += ray * ray;
    // Light so faint that its square is nothing is believed as one ray's.
    const float rays = squares > 0 ? found * found / squares : 1.0f;
    return cached + rays / (rays + cached_directions) * (found - cached);
}

float found_over_believed(std::span<const GlossyLobe> lobes) {
    float found = 0, believed = 0;
    for (const GlossyLobe& lobe : lobes) found += lobe.found, believed += lobe.believed();
    return believed > 0 ? found / believed : 1.0f;
}

Spectrum GlossyLobe::sum(float light_believed) const {
    return found > 0 ? sky + (light_believed / found) * light : sky;
}

}  // namespace hilcam
