// Cached light of several objects and of what moves (inter_object_links.h, solve_ahead.h), against one mesh, random
// paths and a renderer that has not seen what came before.

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <thread>

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

TEST(CachedMotion, LightGoesFromOneObjectToAnotherAsRandomPathsHaveIt) {
    Stage direct = two_objects("direct"), paths = two_objects("path"), kept = two_objects("cached");
    for (Stage* s : {&direct, &paths, &kept}) s->render();
    const double between = paths.mean() - direct.mean();
    EXPECT_GT(between, 0.05 * direct.mean());
    EXPECT_NEAR((kept.mean() - direct.mean()) / between, 1, 0.02);
}

// The wall turns away and comes back: what is shown depends on where it stands, and on nothing before.
TEST(CachedMotion, AFrameIsAFunctionOfWhereTheObjectsStand) {
    Stage s = two_objects("cached");
    s.render();
    const std::vector<float> first = picture(s);
    s.world.objects[1].world_from_body = from_rotation_vector({kPi, 0, 0.5});
    s.render_again();
    EXPECT_NE(picture(s), first);
    s.world.objects[1].world_from_body = from_rotation_vector({kPi, 0, 0});
    s.render_again();
    EXPECT_EQ(picture(s), first);
}

// A small thing that looks at floor and wall, and is too small for them to look at, leaves. What those have of each other
// is solved with it while it is there, and afterwards as if it had never been.
TEST(CachedMotion, AFrameIsAFunctionOfWhoStandsNear) {
    const auto stage = [](Vec3d third_m) {
        Stage s = two_objects("cached");
        s.add(cube(lambert(0.9), s.grid, 0.1f), third_m);
        return s;
    };
    const Vec3d near_m{-1.5, 1, 0.5}, far_m{-900, 1, 0.5};
    Stage s = stage(near_m), fresh = stage(far_m);
    s.render();
    const std::vector<float> with = picture(s);
    s.world.objects[2].position_world_m = far_m;
    s.render_again();
    fresh.render();
    EXPECT_EQ(picture(s), picture(fresh));
    s.world.objects[2].position_world_m = near_m;
    s.render_again();
    EXPECT_EQ(picture(s), with);
}

// While it turns, light is made ahead of time on a thread; a renderer that starts there has the same.
TEST(CachedMotion, WhatIsMadeAheadIsWhatIsMadeAtOnce) {
    Stage s = two_objects("cached");
    s.build();
    int compared = 0;
    for (int frame = 0; frame < 160; ++frame) {
        const double turn = 0.0015 * frame;
        s.world.objects[1].world_from_body = from_rotation_vector({kPi, 0, turn});
        s.sun({-2, 0.3 + turn, -1});
        s.render_again();
        if (frame % 53 != 52) continue;
        Stage fresh = two_objects("cached");
        fresh.world = s.world;
        fresh.render();
        EXPECT_EQ(picture(s), picture(fresh)) << frame;
        ++compared;
    }
    EXPECT_EQ(compared, 3);
}

// Tables that come while frames are made: until then random paths, from then on what a renderer shows that
// had them from the beginning. Nothing is waited for in between, and the frames are those of either.
TEST(CachedMotion, LightThatComesLaterIsWhatWouldHaveBeenThere) {
    Stage kept = two_objects("cached"), later = two_objects("cached"), paths = two_objects("path");
    std::vector<std::shared_ptr<const TransferTable>> tables;
    for (SceneObject& object : later.scene.objects) tables.push_back(std::move(object.transfer));
    later.scene.light_later = true;
    later.build();
    paths.quality = later.quality, paths.quality.path_model = "path";
    for (Stage* s : {&kept, &paths}) s->render();

    std::atomic<bool> go{false};
    std::thread maker([&] {
        while (!go) std::this_thread::yield();
        later.renderer->give_tables(tables);
    });
    int without = 0, with = 0;
    constexpr int kMax = 100'000;
    for (int frame = 0; with < 3 && without < kMax; ++frame) {
        if (frame == 2) go = true;
        const bool lit = later.renderer->take_light();
        EXPECT_FALSE(lit && frame < 2) << "before it was given";
        later.render_again();
        ++(lit ? with : without);
        ASSERT_EQ(picture(later), picture(lit ? kept : paths)) << frame;
    }
    maker.join();
    EXPECT_GE(without, 2);
    EXPECT_EQ(with, 3);
}

// A renderer that ends before it has taken what was given lets go of it, and of what is being solved.
TEST(CachedMotion, LightThatIsNeverTakenIsLetGo) {
    for (const int calls : {0, 1}) {
        Stage later = two_objects("cached");
        std::vector<std::shared_ptr<const TransferTable>> tables;
        for (SceneObject& object : later.scene.objects) tables.push_back(std::move(object.transfer));
        const std::weak_ptr<const TransferTable> watched = tables.front();
        later.scene.light_later = true;
        later.render();
        later.renderer->give_tables(tables);
        for (int i = 0; i < calls; ++i) later.renderer->take_light();
        tables.clear();
        EXPECT_FALSE(watched.expired());
        later.renderer.reset();
        EXPECT_TRUE(watched.expired()) << calls;
    }
}

// Two objects far from each other are lit as each alone is.
TEST(CachedMotion, ObjectsFarApartGiveEachOtherNothing) {
    const auto stage = [](bool both) {
        Stage s;
        s.quality.path_model = "cached";
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
