// Kept light of several objects and of what moves (kept_links.h, kept_updates.h), against one mesh, random
// paths and a renderer that has not seen what came before.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/stage.h"

namespace hilcam {
namespace {

std::vector<float> picture(const Stage& s) {
    return {s.radiance.plane(0).begin(), s.radiance.plane(0).end()};
}

SceneObject floor_of(const MaterialConfig& material, const SpectralGrid& grid) {
    return object_of({{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}, material,
                     grid);
}
SceneObject wall_of(const MaterialConfig& material, const SpectralGrid& grid) {
    return object_of({{1, -1, 0}, {1, 1, 0}, {1, -1, 2}, {1, 1, 2}}, {{0, 2, 3}, {0, 3, 1}}, material, grid);
}

// A floor and a wall on its edge as two objects, seen from above with the wall to the right; the Sun from the
// left.
Stage two_objects(const char* model) {
    Stage s;
    s.quality.path_model = model;
    s.quality.max_depth = 12;
    s.quality.contribution_threshold = 0;
    s.quality.samples_per_axis = model == std::string("path") ? 8 : 2;
    s.quality.rays_across = 0;
    s.camera(48, 0.4);
    s.add(floor_of(lambert(0.8), s.grid), {0, 0, 4});
    s.add(wall_of(lambert(0.8), s.grid), {0, 0, 4});
    s.sun({-2, 0.3, -1});
    return s;
}

TEST(KeptMotion, LightGoesFromOneObjectToAnotherAsRandomPathsHaveIt) {
    Stage direct = two_objects("direct"), paths = two_objects("path"), kept = two_objects("kept");
    for (Stage* s : {&direct, &paths, &kept}) s->render();
    const double between = paths.mean() - direct.mean();
    EXPECT_GT(between, 0.05 * direct.mean());
    EXPECT_NEAR((kept.mean() - direct.mean()) / between, 1, 0.02);
}

// The wall turns away and comes back: what is shown depends on where it stands, and on nothing before.
TEST(KeptMotion, AFrameIsAFunctionOfWhereTheObjectsStand) {
    Stage s = two_objects("kept");
    s.render();
    const std::vector<float> first = picture(s);
    s.world.objects[1].world_from_body = from_rotation_vector({kPi, 0, 0.5});
    s.render_again();
    EXPECT_NE(picture(s), first);
    s.world.objects[1].world_from_body = from_rotation_vector({kPi, 0, 0});
    s.render_again();
    EXPECT_EQ(picture(s), first);
}

// While it turns, light is made ahead of time on a thread; a renderer that starts there has the same.
TEST(KeptMotion, WhatIsMadeAheadIsWhatIsMadeAtOnce) {
    Stage s = two_objects("kept");
    s.build();
    int compared = 0;
    for (int frame = 0; frame < 160; ++frame) {
        const double turn = 0.0015 * frame;
        s.world.objects[1].world_from_body = from_rotation_vector({kPi, 0, turn});
        s.sun({-2, 0.3 + turn, -1});
        s.render_again();
        if (frame % 53 != 52) continue;
        Stage fresh = two_objects("kept");
        fresh.world = s.world;
        fresh.render();
        EXPECT_EQ(picture(s), picture(fresh)) << frame;
        ++compared;
    }
    EXPECT_EQ(compared, 3);
}

// Two objects far from each other are lit as each alone is.
TEST(KeptMotion, ObjectsFarApartGiveEachOtherNothing) {
    const auto stage = [](bool both) {
        Stage s;
        s.quality.path_model = "kept";
        s.camera(32, 0.4);
        s.add(cube(lambert(0.8), s.grid), {0, 0, 4}, {0.3, 0.2, 0});
        if (both) s.add(cube(lambert(0.8), s.grid), {200, 0, 4});
        s.sun({-2, 0.3, -1});
        s.render();
        return picture(s);
    };
    EXPECT_EQ(stage(true), stage(false));
}

}  // namespace
}  // namespace hilcam
