#include "emulator/zoo/surface_words.h"

#include <gtest/gtest.h>

#include <filesystem>

namespace hilcam {
namespace {

std::string_view material_of(const std::string& name, float metallic = 0) {
    MeshSurface surface;
    surface.name = name, surface.metallic = metallic;
    return shipped_material_for(surface);
}

TEST(SurfaceWords, NamesOfSurfacesChooseTheirMaterials) {
    EXPECT_EQ(material_of("KeplerSolarPanels"), "solar_cell");
    EXPECT_EQ(material_of("panel_back"), "cfrp");
    EXPECT_EQ(material_of("KeplerGoldFoil"), "mli_kapton");
    EXPECT_EQ(material_of("SILVER_KAPTON"), "mli_silvered");
    EXPECT_EQ(material_of("BlackinKepler"), "black_paint");
    EXPECT_EQ(material_of("MAINTRUSS_MATL"), "anodised_clear");
    EXPECT_EQ(material_of("tube"), "aluminium_bare");
    EXPECT_EQ(material_of("HighGainAntenna"), "white_paint");
}

TEST(SurfaceWords, WithoutAWordTheFileDecides) {
    EXPECT_EQ(material_of("hbltel_1"), "white_paint");
    EXPECT_EQ(material_of("hbltel_1", 1), "aluminium_bare");
    EXPECT_EQ(material_of(""), "white_paint");
}

TEST(SurfaceWords, EveryMaterialIsShipped) {
    for (const char* name :
         {"panel_back", "baffle", "black", "osr", "silver", "kapton", "solar", "white", "truss", "carbon",
          "glass", "metal", "comet", "asteroid", "regolith", "anything"}) {
        const std::string file(material_of(name));
        EXPECT_TRUE(std::filesystem::exists(std::filesystem::path(HILCAM_SOURCE_DIR) / "configs/materials" /
                                            (file + ".yaml")))
            << file;
    }
}

}  // namespace
}  // namespace hilcam
