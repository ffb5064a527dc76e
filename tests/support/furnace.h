#pragma once
// A closed box that emits as a grey body of 3000 K and reflects the rest, seen from inside: everything is as
// bright as the black body, but for what lies deeper than a path may go.

#include "tests/support/stage.h"

namespace hilcam {

inline constexpr double kFurnace_k = 3000;

// Closes the box about the stage's camera; the Sun is outside.
inline void add_furnace(Stage& s, double reflectance) {
    s.models.radiance = "emissive";
    s.quality.contribution_threshold = 0;
    MaterialConfig grey = lambert(reflectance);
    grey.temperature_k = kFurnace_k;
    s.add(cube(grey, s.grid, 4), {0.2, 0.1, 0.3}, {0.1, 0.2, 0.3});
    s.sun({0, 0, -1});
}
// The mean radiance of a picture. `samples_per_axis`: of random paths.
inline double furnace_mean(const std::string& path_model, int depth, double reflectance,
                           int samples_per_axis) {
    Stage s;
    s.quality.path_model = path_model;
    s.quality.max_depth = depth;
    s.quality.samples_per_axis = samples_per_axis;
    s.camera(32, 0.3);
    add_furnace(s, reflectance);
    s.render();
    return s.mean();
}
// Of the black body, in the picture's first bin.
inline double furnace_black() { return static_cast<double>(planck_w_m2_sr_um(Stage().grid, kFurnace_k)[0]); }

}  // namespace hilcam
