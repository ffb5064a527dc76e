// hilcam-make-spacecraft: a detailed satellite as a mesh of any size, for scenarios that need one, or a small spacecraft of
// another kind with a scenario.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <fstream>
#include <set>

#include "render/vocabulary/units.h"
#include "tools/make_spacecraft/design.h"
#include "tools/make_spacecraft/glb.h"
#include "tools/make_spacecraft/kinds.h"

namespace {

// Writes patches as a mesh, with so many triangles where its shape does not need more.
void write_mesh(const std::vector<spacecraft::Patch>& patches, std::size_t triangles,
                const std::filesystem::path& out) {
    const double scale = spacecraft::scale_for(patches, triangles);
    spacecraft::Parts parts;
    for (const spacecraft::Patch& patch : patches)
        spacecraft::append(patch, scale, parts[patch.part][patch.material]);
    spacecraft::write_glb(out, parts);
}

// Returns the longest side of a box that holds the patches, by places on them.
double size_m(const std::vector<spacecraft::Patch>& patches) {
    spacecraft::Vec3d low = patches.front().at(0, 0), high = low;
    for (const spacecraft::Patch& patch : patches)
        for (const double u : {0.0, 0.25, 0.5, 0.75, 1.0})
            for (const double v : {0.0, 0.5, 1.0}) {
                const spacecraft::Vec3d p = patch.at(u, v);
                low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
                high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
            }
    return std::max({high.x - low.x, high.y - low.y, high.z - low.z});
}

// Writes the mesh and its scenario, which has the mesh's name with the ending .yaml.
void write_kind(const std::string& kind, std::uint32_t seed, std::size_t triangles,
                const std::filesystem::path& out) {
    const std::vector<spacecraft::Patch> patches = spacecraft::kind_of_spacecraft(kind, seed);
    std::set<std::string> materials;
    for (const spacecraft::Patch& patch : patches) materials.insert(patch.material);
    write_mesh(patches, triangles, out);
    std::filesystem::path scenario = out;
    scenario.replace_extension(".yaml");
    std::ofstream text(scenario);
    text << spacecraft::kind_scenario(kind, out.filename().string(), materials, size_m(patches));
    if (!text.flush()) throw std::runtime_error(scenario.string() + ": cannot be written");
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app{
        "Makes a geostationary satellite as a binary glTF mesh.\n"
        "Body axes: +z to the Earth (antenna deck), +y along the wings, +x in flight direction; metres.\n"
        "With --kind a smaller spacecraft of another kind, and a scenario of it beside the mesh."};
    spacecraft::DesignOptions options;
    double wing_angle_deg = 0;
    std::string out, kind;
    CLI::Option* triangles =
        app.add_option("--triangles", options.triangles,
                       "how many, met within 1 %; of a kind 8000, or what its shape needs")
            ->check(CLI::Range(5000, 20000000));
    app.add_option("--seed", options.seed, "of the wrinkles and the cells' tilts");
    CLI::Option* wing =
        app.add_option("--wing-angle-deg", wing_angle_deg, "cells look along +z at 0, along +x at 90");
    app.add_option("--kind", kind, "another spacecraft, whose surfaces have the names of shipped materials")
        ->check(CLI::IsMember(spacecraft::kind_names()))
        ->excludes(wing);
    app.add_option("--out", out, "file.glb")->required();
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : 2;
    }
    try {
        if (!kind.empty()) {
            constexpr std::size_t kTrianglesOfKind = 8000;
            write_kind(kind, options.seed, triangles->count() > 0 ? options.triangles : kTrianglesOfKind,
                       out);
            return 0;
        }
        options.wing_angle_rad = wing_angle_deg * hilcam::kDegree_rad;
        write_mesh(spacecraft::design(options), options.triangles, out);
        return 0;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "hilcam-make-spacecraft: %s\n", error.what());
        return 1;
    }
}
