#include "emulator/ground/globe_loader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "io/images/image_file.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/units.h"
#include "tests/support/files.h"

namespace hilcam {
namespace {

using testing::HasSubstr;

const MappedBody kMoonBody{"moon", kFigures[index_of(BodyId::kMoon)]};

class GlobeLoaderTest : public FilesTest {
  protected:
    // A picture of the whole body with one number in the west and another in the east.
    GroundMapConfig map_of(GroundKind kind, std::uint16_t west, std::uint16_t east, double scale) {
        DnImage numbers(64, 32);
        for (int y = 0; y < 32; ++y)
            for (std::size_t x = 0; x < 64; ++x) numbers.row(y)[x] = x < 32 ? west : east;
        GroundMapConfig map;
        map.file = folder_ / "map.png";
        write_numbers(map.file, numbers);
        map.where = "terrain.globe.maps.0";
        map.kind = kind, map.scale = scale, map.blend_posts = 0;
        map.bounds_deg = {-180, -90, 180, 90};
        return map;
    }
    static Material material(std::size_t model) {
        MaterialConfig config;
        config.model = model;
        config.lobe_width = 0.35;
        return make_material(config, SpectralGrid({0.5, 0.6}));
    }
};

std::string why(const GlobeConfig& globe, const Material& material) {
    try {
        load_globe(globe, kMoonBody, material);
    } catch (const InputError& error) {
        return error.what();
    }
    return "nothing";
}

TEST_F(GlobeLoaderTest, MapsThatDoNotFitAreNamed) {
    GlobeConfig globe;
    globe.maps = {map_of(GroundKind::kRockAbundance, 10, 20, 0.001)};
    EXPECT_THAT(why(globe, material(kModel<brdf::Hapke>)),
                HasSubstr("terrain.globe.maps.0: kind: found rock_abundance without boulders"));
    globe.boulders.emplace();
    EXPECT_EQ(why(globe, material(kModel<brdf::Hapke>)), "nothing");
    globe.maps = {map_of(GroundKind::kRockAbundance, 10, 750, 0.001)};
    EXPECT_THAT(why(globe, material(kModel<brdf::Hapke>)),
                HasSubstr("map.png: found 0.75 at column 32, row 0; accepted: 0 to 0.5"));
    globe.maps = {map_of(GroundKind::kLobeWidth, 20, 30, 0.01)};
    EXPECT_EQ(why(globe, material(kModel<brdf::Hapke>)), "nothing");
    EXPECT_THAT(
        why(globe, material(kModel<brdf::Lambert>)),
        HasSubstr("terrain.globe.maps.0: kind: found a parameter of Hapke's law; accepted: with a material"));
    globe.maps = {map_of(GroundKind::kSlope, 20, 70, 1)};
    EXPECT_THAT(why(globe, material(kModel<brdf::Hapke>)),
                HasSubstr("found 70 at column 32, row 0; accepted: 0 to 60"));
}

// Boulders are listed by the map, also where the scenario itself has none.
TEST_F(GlobeLoaderTest, BouldersAreTheMaps) {
    GlobeConfig globe;
    globe.boulders.emplace().abundance = 0;
    EXPECT_EQ(boulders_of(globe, kMoonBody), nullptr);
    globe.maps = {map_of(GroundKind::kRockAbundance, 0, 100, 0.001)};
    const auto field = boulders_of(globe, kMoonBody);
    ASSERT_NE(field, nullptr);
    const auto at = [&](double longitude_rad) {
        return field->per_m2_at({std::cos(longitude_rad), std::sin(longitude_rad), 0}, 1);
    };
    EXPECT_EQ(at(-1), 0);
    EXPECT_NEAR(at(1) / field->per_m2(1), 0.1 / 0.02, 1e-5);
}

// The mesh has the map's parameter in the east and the material's own where the map ends.
TEST_F(GlobeLoaderTest, TheMaterialsOwnParametersCountBesideAMap) {
    GlobeConfig globe;
    globe.maps = {map_of(GroundKind::kLobeBackward, 25, 25, 0.01)};
    globe.maps[0].bounds_deg = {0, -90, 90, 90};
    const auto ground = load_globe(globe, kMoonBody, material(kModel<brdf::Hapke>));
    for (const auto& [longitude_rad, backward] : {std::pair{0.8, 0.25f}, {-1.7, 0.5f}}) {
        const Vec3d up{std::cos(longitude_rad), std::sin(longitude_rad), 0};
        TerrainView view;
        view.camera_m = (kMoonBody.figure.equatorial_radius_m + 200e3) * up;
        view.boresight = -up;
        const TerrainMesh made = ground->mesh(view);
        ASSERT_EQ(made.mesh.hapke.size(), made.mesh.vertices_m.size());
        int compared = 0;
        for (std::size_t i = 0; i < made.mesh.hapke.size(); ++i) {
            if (length(normalized(made.anchor_m + to_double(made.mesh.vertices_m[i])) - up) > 0.05) continue;
            EXPECT_FLOAT_EQ(made.mesh.hapke[i].b, 0.35f);
            EXPECT_FLOAT_EQ(made.mesh.hapke[i].c, backward);
            ++compared;
        }
        EXPECT_GT(compared, 1000);
    }
}

}  // namespace
}  // namespace hilcam
