// The path models of tests/plugin/hemisphere_plugin.cpp and random_plugin.cpp, loaded as a user's would be: what has a closed form,
// and the program's own random paths beside it where there is none.

#include <gtest/gtest.h>

#include <cmath>

#include "render/frame/plugin.h"
#include "tests/support/furnace.h"

namespace hilcam {
namespace {

const Modules& modules() {
    static const Modules loaded = [] {
        Modules all;
        const std::vector<std::filesystem::path> files = {HILCAM_PLUGIN_HEMISPHERE, HILCAM_PLUGIN_RANDOM};
        load_plugins(files, all);
        return all;
    }();
    return loaded;
}

// A stage whose path model is the plug-in's, or one of the program's own.
class PlugInStage : public Stage {
  public:
    PlugInStage(const std::string& model, int depth) {
        quality.path_model = model;
        quality.max_depth = depth;
        quality.contribution_threshold = 0;
        quality.rays_across = 0;
    }
    void render() {
        renderer = std::make_unique<Renderer>(copy_of(scene), grid, geometry, quality, models, modules());
        render_again();
    }
};

// What is deeper than the directions go is a geometric series, every direction's the same; sums of sixty parts
// in single precision.
TEST(PathPlugIns, AFurnaceIsWhiteInside) {
    for (const char* model : {"hemisphere", "random"})
        for (const int depth : {1, 2, 3}) {
            PlugInStage s(model, depth);
            s.camera(2, 0.3);
            s.quality.samples_per_axis = 1;
            add_furnace(s, 0.3);
            s.render();
            EXPECT_NEAR(s.mean() / (furnace_black() * (1 - std::pow(0.3, depth))), 1, 1e-5)
                << model << " " << depth;
        }
}

MaterialConfig mirror() {
    MaterialConfig config;
    config.model = kModel<brdf::Mirror>;
    config.reflectance = Curve::constant(1);
    return config;
}

// Three perpendicular mirrors show the Sun where the camera is, after three reflections and not before.
class PathPlugInsBy : public testing::TestWithParam<const char*> {};
TEST_P(PathPlugInsBy, MirrorsAreFollowedInTheirOwnDirection) {
    for (const int depth : {2, 3}) {
        PlugInStage s(GetParam(), depth);
        // Faces x = 0, y = 0 and z = 0 of the first octant, turned so that (1, 1, 1) is towards the camera.
        s.add(object_of({{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0, 0, 2}, {2, 2, 0}, {2, 0, 2}, {0, 2, 2}},
                        {{0, 1, 4}, {0, 4, 2}, {0, 1, 5}, {0, 5, 3}, {0, 2, 6}, {0, 6, 3}}, mirror(), s.grid),
              {0, 0, 6}, {});
        const Vec3d axis = cross(normalized(Vec3d{1, 1, 1}), Vec3d{0, 0, -1});
        s.world.objects[0].world_from_body =
            from_rotation_vector(std::acos(-1 / std::sqrt(3.0)) * normalized(axis));
        s.sun({0.04, 0.03, -1});
        s.camera(64, 0.1);
        s.render();
        const float most = *std::max_element(s.radiance.plane(0).begin(), s.radiance.plane(0).end());
        // The disk's middle is brighter than its mean.
        const double disk =
            static_cast<double>(kSun_w_m2_um) / (kPi * std::pow(kSunRadius_m / kAstronomicalUnit_m, 2));
        if (depth < 3) {
            EXPECT_EQ(most, 0);
        } else {
            EXPECT_GT(static_cast<double>(most), disk);
            EXPECT_LT(most, 1.4 * disk);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Models, PathPlugInsBy, testing::Values("hemisphere", "random"));

// A floor beside a sunlit wall, where 60 directions resolve what the wall throws on it.
TEST(HemispherePlugIn, AgreesWithRandomPathsOnDiffusePlates) {
    const auto light_of = [](const char* model, int depth) {
        PlugInStage s(model, depth);
        s.quality.samples_per_axis = 4;
        s.camera(32, 0.4);
        s.add(plate(lambert(0.7), s.grid), {0, 0, 3});
        s.add(plate(lambert(0.7), s.grid), {-1, 0, 2}, {0, kPi / 2, 0});
        s.sun({0.5, 0.2, -1});
        s.render();
        return s.light().irradiance;
    };
    EXPECT_NEAR(light_of("hemisphere", 1) / light_of("direct", 1), 1, 1e-5);
    const double random = light_of("path", 3);
    EXPECT_GT(random, 1.02 * light_of("path", 1));
    EXPECT_NEAR(light_of("hemisphere", 3) / random, 1, 0.01);
}

// A plate that only the Earth lights, as wide as 0.13 rad: its own 64 directions against random ones.
TEST(HemispherePlugIn, AgreesWithRandomPathsOnTheLightOfTheEarth) {
    const auto light_of = [](const char* model) {
        PlugInStage s(model, 1);
        s.quality.samples_per_axis = 8;
        s.camera(32, 0.2);
        s.earth(0.3);
        s.world.bodies[BodyId::kEarth].world_m = {0, 0, -1e8};
        s.sun({0.3, 0, 1});  // behind the plate, on half of the Earth
        s.add(plate(lambert(0.5), s.grid), {0, 0, 6});
        s.render();
        return s.light().irradiance;
    };
    const double random = light_of("path");
    EXPECT_GT(random, 0);
    EXPECT_NEAR(light_of("hemisphere") / random, 1, 0.02);
}

}  // namespace
}  // namespace hilcam
