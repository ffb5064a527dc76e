#pragma once
// The exchangeable models of the renderer by name, from which a scenario chooses.

#include <filesystem>
#include <string>

#include "render/shading/path_model.h"
#include "render/shading/radiance_model.h"
#include "render/shading/ray_generator.h"
#include "render/sky/atmosphere.h"
#include "render/vocabulary/config_field.h"
#include "render/vocabulary/registry.h"

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

    // Registers the program's own models.
    Modules();
};

// Returns the path model of this name. Throws InputError with the list of names if there is none; for a model
// that the program used to have it says where that is. Owner thread.
std::unique_ptr<PathModel> make_path_model(const Modules& modules, const std::string& name);

}  // namespace hilcam
