// How deep light paths are followed.

#include "render/units.h"
#include "tests/extremes/groups.h"
#include "tests/support/stage.h"

namespace hilcam::extremes {

// Inside a closed box whose walls send eps L_T and reflect rho = 1 - eps, a path of n surfaces brings
// L_T (1 - rho + rho - rho^2 + ... - rho^n), every path the same.
Group depth_of_paths() {
    Group group{
        "DepthOfPaths",
        "Depth: a closed box of walls that glow",
        "path model, depth, reflectance",
        {"mean radiance [W m^-2 sr^-1 um^-1]"},
        "L_T (1 - rho^depth), L_T by Planck's law: a geometric series.",
        "4 roundings to single precision a surface, and 60 where the hemisphere's 60 directions are summed.",
        {}};
    struct Box {
        const char* model;
        int depth;
        double reflectance;
    };
    for (const Box box : {Box{"direct", 64, 0.9},
                          {"hemisphere", 1, 0.3},
                          {"hemisphere", 2, 0.3},
                          {"hemisphere", 4, 0.3},
                          {"path", 1, 0.9},
                          {"path", 2, 0.9},
                          {"path", 4, 0.9},
                          {"path", 16, 0.9},
                          {"path", 64, 0.9},
                          {"path", 64, 0.99},
                          {"path", 64, 0}}) {
        const bool direct = std::string(box.model) == "direct",
                   fixed = std::string(box.model) == "hemisphere";
        const int surfaces = direct ? 1 : box.depth;
        // Sums of sixty parts, of what comes from behind each surface: rho + rho^2 + ...
        const double directions = fixed ? 60 : 0;
        double behind = 0;
        for (int k = 1; k < surfaces; ++k) behind += std::pow(box.reflectance, k);
        group.cases.push_back(
            {std::string(box.model) + ", " + std::to_string(box.depth) + ", " + text(box.reflectance),
             {4 * kFloatGrain * (surfaces + 1) + directions * kFloatGrain * behind},
             [box, fixed, surfaces] {
                 Stage s;
                 s.models.radiance = "emissive";
                 s.quality.path_model = box.model;
                 s.quality.max_depth = box.depth;
                 s.quality.contribution_threshold = 0;
                 // 60^depth rays want few pixels.
                 s.camera(fixed ? 2 : 32, 0.3);
                 s.quality.samples_per_axis = fixed ? 1 : 2;
                 MaterialConfig grey = lambert(box.reflectance);
                 grey.temperature_k = 3000;
                 s.add(cube(grey, s.grid, 4), {0.2, 0.1, 0.3}, {0.1, 0.2, 0.3});
                 s.sun({0, 0, -1});  // outside
                 s.render();
                 double sum = 0;
                 for (const float value : s.radiance.plane(0)) sum += value;
                 const double mean = sum / static_cast<double>(s.radiance.plane(0).size());
                 const double truth =
                     planck_w_m2_sr_um(s.grid.center_um(0), 3000) * (1 - std::pow(box.reflectance, surfaces));
                 return std::vector<Found>{{truth, relative(mean, truth)}};
             },
             std::string(box.model) == "hemisphere" && box.depth > 2});
    }
    return group;
}

}  // namespace hilcam::extremes
