#pragma once
// The section `lamps`: light sources on the camera's body or on objects, with data from their data sheets.

#include <cstdint>
#include <string>

#include "render/vocabulary/config_field.h"
#include "render/vocabulary/spectrum.h"
#include "render/vocabulary/table.h"

namespace hilcam {

struct LampConfig {
    std::string name;
    std::string on = "camera";  // name of an object, or "camera" for the first camera's body
    std::int64_t joint = 0;     // joint of that object, from 1; 0: the object itself
    Vec3d position_m;
    Vec3d axis{0, 0, 1};
    Curve spectral_intensity_w_sr_um;
    double intensity_w_sr = 0;
    Curve spectrum;
    double beam_angle_rad = 0;
    Table beam;
    bool lit = true;
    double level = 1;
    bool has_spectral_intensity = false, has_intensity = false, has_spectrum = false, has_beam_angle = false,
         has_beam = false;
};
Fields fields(LampConfig& lamp);
void validate(const LampConfig& lamp);

}  // namespace hilcam
