// Ground that is alone, seen sixteen pixels at a time: it is what a ray a pixel finds, whatever it is made of and from wherever
// it is seen; what is not for it is left to rays.

#include "render/ground_shading/ground_light.h"

#include <gtest/gtest.h>

#include <cmath>
#include <tuple>

#include "render/ground/crater_field.h"
#include "render/ground/globe_terrain.h"
#include "tests/support/ground_maps.h"
#include "tests/support/stage.h"
#include "tests/support/vector_widths.h"

namespace hilcam {
namespace {

constexpr Figure kBody = kFigures[index_of(BodyId::kMoon)];
const Vec3d kUp = place_on_sphere(20, 5);

MaterialConfig regolith(double slope_rad) {
    MaterialConfig m = lambert(0.4);
    m.model = kModel<brdf::Hapke>;
    m.surge_amplitude = 1;
    m.slope_rad = slope_rad;
    return m;
}

struct View {
    double height_m = 3000;
    double slant_rad = 0;   // of the boresight against straight down
    double sun_rad = 0.17;  // of the Sun above the horizon
    int width_px = 150;     // with the guard band not a whole number of blocks of 4
    double half_field_rad = 0.3;
};

// One ground for all stages: its tiles are made once.
class CrateredGround final : public Terrain {
  public:
    TerrainMesh mesh(const TerrainView& view) override { return ground().mesh(view); }
    bool depends_on_boresight() const override { return true; }
    Vec3d up_at(Vec3d point_m) const override { return ground().up_at(point_m); }
    std::optional<double> height_above_ground_m(Vec3d) const override { return {}; }

  private:
    static GlobeTerrain& ground() {
        static GlobeTerrain all(kBody, {}, craters(), {});
        return all;
    }
    static std::vector<std::unique_ptr<const GroundDetail>> craters() {
        std::vector<std::unique_ptr<const GroundDetail>> out;
        out.push_back(std::make_unique<CraterField>(kBody.equatorial_radius_m, CraterSettings{}));
        return out;
    }
};

// Cratered ground with the Sun low in the east. samples: of the buffer; 0: rays.
struct Landscape : Stage {
    Landscape(const MaterialConfig& material, const View& view, int samples) {
        camera(view.width_px, view.half_field_rad);
        quality.path_model = "direct";
        quality.max_depth = 1;
        quality.visibility = samples == 0 ? "rays" : "buffer";
        quality.buffer_samples = samples;
        scene.terrain = std::make_unique<SceneTerrain>();
        scene.terrain->ground = std::make_unique<CrateredGround>();
        scene.terrain->material = make_material(material, grid);
        scene.terrain->edge_px = 6;
        const Vec3d east = normalized(cross(Vec3d{0, 0, 1}, kUp));
        world.camera.position_world_m = (kBody.equatorial_radius_m + view.height_m) * kUp;
        world.camera.world_from_body =
            look_along(-std::cos(view.slant_rad) * kUp + std::sin(view.slant_rad) * east, east);
        sun(std::sin(view.sun_rad) * kUp + std::cos(view.sun_rad) * east);
    }
};

std::vector<float> values_of(const Stage& stage) {
    std::vector<float> out;
    for (int plane = 0; plane < stage.radiance.planes(); ++plane)
        out.insert(out.end(), stage.radiance.plane(plane).begin(), stage.radiance.plane(plane).end());
    return out;
}
// Shadows' edges are at a triangle's own, where a rounding decides.
void expect_alike(const std::vector<float>& a, const std::vector<float>& b, const char* what) {
    ASSERT_EQ(a.size(), b.size());
    std::size_t others = 0;
    double sum_a = 0, sum_b = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        sum_a += static_cast<double>(a[i]), sum_b += static_cast<double>(b[i]);
        others += std::abs(a[i] - b[i]) > 5e-3f * (a[i] + b[i]) ? 1u : 0u;
    }
    EXPECT_LT(others, a.size() / 2000) << what;
    EXPECT_NEAR(sum_b / sum_a, 1, 2e-4) << what;
}

TEST(GroundLight, IsThatOfARayAPixel) {
    const View from_above, aslant{.height_m = 3000, .slant_rad = 1.3}, touching{.height_m = 1.5},
        from_space{.height_m = 300e3, .slant_rad = 0.5};
    const std::tuple<const char*, MaterialConfig, View> cases[] = {
        {"from above", regolith(0), from_above}, {"aslant", regolith(0), aslant},
        {"touching", regolith(0), touching},     {"from space", regolith(0), from_space},
        {"rough", regolith(0.4), from_space},    {"paint", lambert(0.4), from_space}};
    for (const auto& [name, material, view] : cases) {
        Landscape by_rays(material, view, 0), at_once(material, view, 1);
        by_rays.render(), at_once.render();
        expect_alike(values_of(by_rays), values_of(at_once), name);
        EXPECT_NEAR(at_once.stats.coverage, by_rays.stats.coverage, 1e-4) << name;
        // It was not rays that found it; the sky above the horizon is theirs.
        EXPECT_LT(at_once.stats.primary_rays, 0.7 * static_cast<double>(by_rays.stats.primary_rays)) << name;
        if (view.slant_rad == 0) {
            EXPECT_EQ(at_once.stats.primary_rays, 0u) << name;
        }
    }
}

TEST(GroundLight, IsDarkInTheNight) {
    const View night{.sun_rad = -0.2};
    Landscape at_once(regolith(0), night, 1);
    at_once.render();
    for (const float value : values_of(at_once)) ASSERT_EQ(value, 0.0f);
    EXPECT_NEAR(at_once.stats.coverage, 1, 1e-6);
}

TEST(GroundLight, IsTheSameWithVectorsOfAnyWidth) {
    expect_same_by_any_width([] {
        Landscape stage(regolith(0), {}, 1);
        stage.render();
        return values_of(stage);
    });
}

// By every second pixel, under a high Sun, which throws no shadows: nearly the same light, and the sky where it was.
TEST(GroundLight, BetweenPlacesItIsNearlyThatOfAllPixels) {
    for (const double slant_rad : {0.0, 1.3}) {
        const View view{.slant_rad = slant_rad, .sun_rad = 1.2};
        Landscape by_rays(regolith(0), view, 0), all(regolith(0), view, 1),
            every_second(regolith(0), view, 1);
        every_second.quality.ground_step_px = 2;
        by_rays.render(), all.render(), every_second.render();
        const std::vector<float> rays = values_of(by_rays), a = values_of(all), b = values_of(every_second);
        double sum_a = 0, sum_b = 0, squares = 0, of_a = 0;
        std::size_t sky = 0;
        for (std::size_t i = 0; i < a.size(); ++i) {
            const auto x = static_cast<double>(a[i]), y = static_cast<double>(b[i]);
            sum_a += x, sum_b += y, squares += (x - y) * (x - y), of_a += x * x;
            sky += rays[i] == 0 && y == 0 ? 1u : 0u;
        }
        EXPECT_NEAR(sum_b / sum_a, 1, 1e-3) << slant_rad;
        EXPECT_LT(squares, 0.0009 * of_a) << slant_rad;  // 3 % rms: what is narrower than two pixels
        EXPECT_GT(squares, 0) << slant_rad;
        EXPECT_NEAR(every_second.stats.coverage, all.stats.coverage, 1e-4) << slant_rad;
        if (slant_rad > 1)
            EXPECT_GT(sky, a.size() / 10);
        else
            EXPECT_EQ(every_second.stats.primary_rays, 0u);
    }
}

TEST(GroundLight, BetweenPlacesItIsTheSameWithVectorsOfAnyWidth) {
    expect_same_by_any_width([] {
        Landscape stage(regolith(0), {.slant_rad = 1.2}, 1);
        stage.quality.ground_step_px = 2;
        stage.render();
        return values_of(stage);
    });
}

// What stands on the ground, or shines on it beside the Sun, is for rays.
TEST(GroundLight, IsLeftToRaysWhereItIsNotAlone) {
    const auto place = [](Landscape& stage, int what) {
        if (what == 0) {
            stage.scene.objects.push_back(cube(lambert(0.5), stage.grid, 100));
            stage.world.objects.push_back({(kBody.equatorial_radius_m + 1000) * kUp, {}});
        }
        if (what == 1) stage.quality.sun_disk = true;
    };
    for (const int what : {0, 1}) {
        Landscape by_rays(regolith(0), {}, 0), by_buffer(regolith(0), {}, 1);
        place(by_rays, what), place(by_buffer, what);
        by_rays.render(), by_buffer.render();
        EXPECT_EQ(values_of(by_rays), values_of(by_buffer)) << what;
        EXPECT_GT(by_buffer.stats.primary_rays, 0u) << what;
    }
}

}  // namespace
}  // namespace hilcam
