// How deep light paths are followed.

#include "render/vocabulary/units.h"
#include "tests/extremes/groups.h"
#include "tests/support/furnace.h"

namespace hilcam::extremes {

// Inside a closed box whose walls send eps L_T and reflect rho = 1 - eps, a path of n surfaces brings
// L_T (1 - rho + rho - rho^2 + ... - rho^n), every path the same.
Group depth_of_paths() {
    Group group{"DepthOfPaths",
                "Depth: a closed box of walls that glow",
                "path model, depth, reflectance",
                {"mean radiance [W m^-2 sr^-1 um^-1]"},
                "L_T (1 - rho^depth), L_T by Planck's law: a geometric series.",
                "4 roundings to single precision a surface.",
                {}};
    struct Box {
        const char* model;
        int depth;
        double reflectance;
    };
    for (const Box box : {Box{"direct", 64, 0.9},
                          {"path", 1, 0.9},
                          {"path", 2, 0.9},
                          {"path", 4, 0.9},
                          {"path", 16, 0.9},
                          {"path", 64, 0.9},
                          {"path", 64, 0.99},
                          {"path", 64, 0}}) {
        const int surfaces = std::string(box.model) == "direct" ? 1 : box.depth;
        group.cases.push_back(
            {std::string(box.model) + ", " + std::to_string(box.depth) + ", " + text(box.reflectance),
             {4 * kFloatGrain * (surfaces + 1)},
             [box, surfaces] {
                 const double mean = furnace_mean(box.model, box.depth, box.reflectance, 2);
                 const double truth = furnace_black() * (1 - std::pow(box.reflectance, surfaces));
                 return std::vector<Found>{{truth, relative(mean, truth)}};
             }});
    }
    return group;
}

}  // namespace hilcam::extremes
