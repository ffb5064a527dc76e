#pragma once
// The exchangeable models of the renderer, by name: what a scenario may choose from.

#include <filesystem>
#include <string>

#include "render/atmosphere.h"
#include "render/config_field.h"
#include "render/path_model.h"
#include "render/radiance_model.h"
#include "render/ray_generator.h"
#include "render/registry.h"

namespace hilcam {

struct RayConfig {
    std::string model = "pinhole";
    double line_time_s = 20e-6;  // rolling, pushbroom
};
Fields fields(RayConfig& config);

struct Modules {
    Registry<RayGenerator, const RayConfig&> rays{"rays.model"};
    Registry<PathModel> paths{"quality.path_model"};
    Registry<RadianceModel> radiance{"radiance"};
    Registry<Atmosphere, const AtmosphereRequest&> atmospheres{"atmosphere.model"};

    // With the program's own.
    Modules();
};

}  // namespace hilcam
