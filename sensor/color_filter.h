#pragma once
// A colour filter array: a pattern of filters that repeats over the sensor.

#include <string>
#include <vector>

#include "render/vocabulary/config_field.h"

namespace hilcam {

struct ColorFilterConfig {
    std::string name;  // one letter, used in the pattern
    Curve transmission = Curve::constant(1);
};
Fields fields(ColorFilterConfig& config);

struct ColorFilterArrayConfig {
    std::string pattern;  // letters of each row, rows separated by a space: "RG GB"; empty: no array
    std::vector<ColorFilterConfig> filters;
};
Fields fields(ColorFilterArrayConfig& config);
void validate(const ColorFilterArrayConfig& config);

}  // namespace hilcam
