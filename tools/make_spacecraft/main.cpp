// hilcam-make-spacecraft: a detailed satellite as a mesh of any size, for scenarios that need one.

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>

#include "render/vocabulary/units.h"
#include "tools/make_spacecraft/design.h"
#include "tools/make_spacecraft/glb.h"

int main(int argc, char** argv) {
    CLI::App app{
        "Makes a geostationary satellite as a binary glTF mesh.\n"
        "Body axes: +z to the Earth (antenna deck), +y along the wings, +x in flight direction; metres."};
    spacecraft::DesignOptions options;
    double wing_angle_deg = 0;
    std::string out;
    app.add_option("--triangles", options.triangles, "how many, met within 1 %")
        ->check(CLI::Range(5000, 20000000));
    app.add_option("--seed", options.seed, "of the wrinkles and the cells' tilts");
    app.add_option("--wing-angle-deg", wing_angle_deg, "cells look along +z at 0, along +x at 90");
    app.add_option("--out", out, "file.glb")->required();
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : 2;
    }
    try {
        options.wing_angle_rad = wing_angle_deg * hilcam::kDegree_rad;
        const std::vector<spacecraft::Patch> patches = spacecraft::design(options);
        const double scale = spacecraft::scale_for(patches, options.triangles);
        spacecraft::Parts parts;
        for (const spacecraft::Patch& patch : patches)
            spacecraft::append(patch, scale, parts[patch.part][patch.material]);
        spacecraft::write_glb(out, parts);
        return 0;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "hilcam-make-spacecraft: %s\n", error.what());
        return 1;
    }
}
