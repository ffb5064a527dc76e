#include "render/paths/modules.h"

#include <algorithm>
#include <vector>

#include "render/paths/path_models.h"
#include "render/shading/ray_generators.h"
#include "render/sky/atmosphere_models.h"
#include "render/sunlight/radiance_equation.h"

namespace hilcam {

Fields fields(RayConfig& c) {
    return {
        text("model", c.model, "ray model: pinhole, rolling, pushbroom, or a plug-in's"),
        number("line_time_us", c.line_time_s, 1e-6, {0, 1e6},
               "rolling, pushbroom: time from one row to the next"),
    };
}

Modules::Modules() {
    rays.add("pinhole", [](const RayConfig&) { return make_pinhole_rays(); });
    rays.add("rolling", [](const RayConfig& c) { return make_rolling_rays(c.line_time_s); });
    rays.add("pushbroom", [](const RayConfig& c) { return make_pushbroom_rays(c.line_time_s); });
    paths.add("direct", make_direct_paths);
    paths.add("cached", make_cached_paths);
    paths.add("path", make_traced_paths);
    radiance.add("reflected", [] { return make_radiance_equation(false); });
    radiance.add("emissive", [] { return make_radiance_equation(true); });
    atmospheres.add("none", [](const AtmosphereRequest&) { return std::unique_ptr<Atmosphere>(); });
    atmospheres.add("precomputed", make_precomputed_atmosphere);
    atmospheres.add("table", make_table_atmosphere);
}

std::unique_ptr<PathModel> make_path_model(const Modules& modules, const std::string& name) {
    const std::vector<std::string> known = modules.paths.list();
    if (name == "hemisphere" && std::find(known.begin(), known.end(), name) == known.end())
        throw InputError(
            "quality.path_model: found 'hemisphere', which is the example of a plug-in now "
            "(tests/plugin/hemisphere_plugin.cpp, named under 'plugins'); accepted: " +
            modules.paths.names());
    return modules.paths.make(name);
}

}  // namespace hilcam
