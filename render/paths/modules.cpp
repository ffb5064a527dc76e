#include "render/paths/modules.h"

#include "render/paths/path_models.h"
#include "render/shading/ray_generators.h"
#include "render/sky/atmosphere_models.h"
#include "render/sunlight/radiance_equation.h"

namespace hilcam {

Fields fields(RayConfig& c) {
    return {
        text("model", c.model, "ray model: pinhole | rolling | pushbroom, or a plug-in's"),
        number("line_time_us", c.line_time_s, 1e-6, {0, 1e6},
               "rolling, pushbroom: time from one row to the next"),
    };
}

Modules::Modules() {
    rays.add("pinhole", [](const RayConfig&) { return make_pinhole_rays(); });
    rays.add("rolling", [](const RayConfig& c) { return make_rolling_rays(c.line_time_s); });
    rays.add("pushbroom", [](const RayConfig& c) { return make_pushbroom_rays(c.line_time_s); });
    paths.add("direct", make_direct_paths);
    paths.add("hemisphere", make_hemisphere_paths);
    paths.add("kept", make_kept_paths);
    paths.add("path", make_traced_paths);
    radiance.add("reflected", [] { return make_radiance_equation(false); });
    radiance.add("emissive", [] { return make_radiance_equation(true); });
    atmospheres.add("none", [](const AtmosphereRequest&) { return std::unique_ptr<Atmosphere>(); });
    atmospheres.add("precomputed", make_precomputed_atmosphere);
    atmospheres.add("table", make_table_atmosphere);
}

}  // namespace hilcam
