// Spacecraft of other kinds: closed parts face outwards, surfaces have shipped materials, sizes are moderate.

#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <set>

#include "tools/make_spacecraft/kind_shapes.h"
#include "tools/make_spacecraft/kinds.h"

namespace spacecraft {
namespace {

// The volume that patches enclose (the divergence theorem over their triangles): below zero where they face inwards.
double volume_m3(const std::vector<Patch>& patches, double scale) {
    Surface surface;
    for (const Patch& patch : patches) append(patch, scale, surface);
    double six_fold = 0;
    for (const auto& [a, b, c] : surface.triangles)
        six_fold +=
            dot(hilcam::to_double(surface.positions[a]),
                cross(hilcam::to_double(surface.positions[b]), hilcam::to_double(surface.positions[c])));
    return six_fold / 6;
}

const Placement kAskew({0.2, -0.3, 0.1}, {0, 0.6, 0.8}, {1, 0, 0});

// A polygon of 32 corners has sin(2 pi / 32) / (2 pi / 32) of its circle's area.
constexpr double kOfCircle = 0.99359;

TEST(SpacecraftShapes, ATubeHasTheVolumeOfItsWall) {
    std::vector<Patch> patches;
    add_shell(patches, {"tube", "aluminium_bare", "black_anodised", kAskew, 1.0, 1.0, 5.0, 0.25, 0});
    EXPECT_NEAR(volume_m3(patches, 1), kOfCircle * 3.14159265 * (1 - 0.5625) * 5, 1e-3);
}

TEST(SpacecraftShapes, CylindersDishesPanelsAndTrussesFaceOutwards) {
    std::vector<Patch> cylinder, dish, panel, truss;
    add_cylinder(cylinder, "tank", "aluminium_bare", kAskew, 0.5, 2, 0);
    EXPECT_NEAR(volume_m3(cylinder, 1), kOfCircle * 3.14159265 * 0.25 * 2, 1e-3);
    // A plate of twelve thousandths of the radius, measured along the axis.
    add_dish(dish, {"dish", "gold", "cfrp", kAskew, 2, 1.5, 0});
    EXPECT_NEAR(volume_m3(dish, 1), kOfCircle * 3.14159265 * 4 * 0.024, 1e-3);
    add_panel(panel, "panel", {1, 2, 3}, {2, 0, 0}, {0, 1, 0}, 0.02);
    panel.pop_back();  // its cells, an open sheet
    EXPECT_NEAR(volume_m3(panel, 1), 2 * 1 * 0.02, 1e-6);
    add_truss(truss, {"truss", "anodised_clear", {0, 0, 0}, {4, 0, 0}, 0.3, 0.02, 4});
    EXPECT_EQ(truss.size(), 4u * (1 + 2 * 4 + 1));
}

TEST(SpacecraftShapes, CellsLookAlongTheirPanelsNormal) {
    std::vector<Patch> panel;
    add_panel(panel, "panel", {0, 0, 0}, {2, 0, 0}, {0, 1, 0}, 0.02);
    const Patch& cells = panel.back();
    EXPECT_EQ(cells.material, "solar_cell");
    EXPECT_GT(cells.at(0.5, 0.5).z, 0.01);
    EXPECT_GT(cross(cells.at(1, 0) - cells.at(0, 0), cells.at(0, 1) - cells.at(0, 0)).z, 0);
}

TEST(SpacecraftKinds, AreOfShippedMaterialsAndOfModerateSize) {
    EXPECT_EQ(kind_names().size(), 6u);
    for (const std::string& kind : kind_names()) {
        const std::vector<Patch> patches = kind_of_spacecraft(kind, 1);
        std::size_t least = 0;
        std::set<std::string> materials;
        for (const Patch& patch : patches) {
            least += triangles_of(patch, 0);
            materials.insert(patch.material);
        }
        EXPECT_LT(least, 8000u) << kind;
        EXPECT_TRUE(materials.contains("aluminium_bare") && materials.contains("solar_cell")) << kind;
        for (const std::string& material : materials)
            EXPECT_TRUE(std::filesystem::exists(std::filesystem::path(HILCAM_SOURCE_DIR) /
                                                "configs/materials" / (material + ".yaml")))
                << kind << ": " << material;
    }
    EXPECT_THROW(kind_of_spacecraft("teapot", 1), std::invalid_argument);
}

TEST(SpacecraftKinds, AScenarioNamesTheMeshAndEachSurface) {
    const std::string text = kind_scenario("bus", "a.glb", {"gold", "osr"}, 10);
    for (const char* line : {"mesh: a.glb\n", "{name: gold, material: gold}\n",
                             "{name: osr, material: osr}\n", "position_m: [18, -13.8, 10.5]"})
        EXPECT_NE(text.find(line), std::string::npos) << line;
}

}  // namespace
}  // namespace spacecraft
