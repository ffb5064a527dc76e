// The last guard before the acceleration structure, which ends the program at what is no number: an object that is nowhere is left out, a
// camera that is nowhere stays where it was, a ray from nowhere meets nothing.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "render/scene/embree_scene.h"
#include "tests/support/stage.h"

namespace hilcam {
namespace {

constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

std::vector<float> picture_of(Stage& s) {
    s.render_again();
    return {s.radiance.all().begin(), s.radiance.all().end()};
}

const std::vector<Pose> kNowhere = {{{kNoNumber, 0, 0}, {}},
                                    {{0, 1e21, 0}, {}},
                                    {{0, 0, std::numeric_limits<double>::infinity()}, {}},
                                    {{0, 0, 6}, {kNoNumber, 0, 0, 0}},
                                    {{0, 0, 6}, {0, 0, 0, 0}}};

// By paths, and with light that is cached.
TEST(LeftOut, AnObjectThatIsNowhereIsNotInThePicture) {
    for (const char* model : {"path", "cached"}) {
        Stage alone;
        alone.quality.path_model = model;
        alone.add(plate(lambert(0.5), alone.grid), {0, 0, 9});
        alone.render();
        const std::vector<float> expected = picture_of(alone);
        ASSERT_GT(*std::max_element(expected.begin(), expected.end()), 1);
        Stage s;
        s.quality.path_model = model;
        s.add(plate(lambert(0.5), s.grid), {0, 0, 9});
        s.add(cube(lambert(0.2), s.grid), {0, 0, 6});
        s.render();
        const std::vector<float> both = picture_of(s);
        EXPECT_NE(both, expected) << model;
        for (const Pose& nowhere : kNowhere) {
            s.world.objects[1] = nowhere;
            const std::vector<float> found = picture_of(s);
            for (std::size_t i = 0; i < found.size(); ++i)
                ASSERT_NEAR(found[i], expected[i], 1e-3f * expected[i] + 1e-6f) << model << ' ' << i;
        }
        s.world.objects[1] = {{0, 0, 6}, from_rotation_vector({kPi, 0, 0})};
        EXPECT_EQ(picture_of(s), both) << model;
        EXPECT_NE(s.renderer->fault().find("5 times a place or an attitude could not be"), std::string::npos);
    }
}

TEST(LeftOut, ACameraOrASunThatIsNowhereStaysWhereItWas) {
    Stage s;
    s.add(cube(lambert(0.5), s.grid), {0.3, 0, 6});
    s.render();
    const std::vector<float> before = picture_of(s);
    const WorldSnapshot good = s.world;
    for (const Pose& nowhere : kNowhere) {
        s.world.camera = nowhere;
        EXPECT_EQ(picture_of(s), before);
    }
    s.world = good;
    s.world.bodies.sun_world_m = {kNoNumber, 0, 0};
    s.world.bodies[BodyId::kEarth].fixed_from_world.y = {0, kNoNumber, 0};
    s.world.camera_rate_rad_s = s.world.camera_velocity_m_s = {0, kNoNumber, 0};
    EXPECT_EQ(picture_of(s), before);
}

TEST(EmbreeScene, ARayThatIsNoNumberMeetsNothing) {
    const SpectralGrid grid({0.5, 0.6});
    const SceneObject object = plate(lambert(0.5), grid);
    const std::vector<std::vector<const Mesh*>> meshes = {{&object.mesh}};
    EmbreeScene scene(meshes, true);
    const Pose pose{{0, 0, 5}, {}};
    const std::size_t level = 0;
    scene.place({&pose, 1}, {&level, 1}, {});
    const float bad = std::numeric_limits<float>::quiet_NaN(), far = 1e30f,
                endless = std::numeric_limits<float>::infinity();
    RayPacket rays;
    rays.count = kPacketSize;
    for (int i = 0; i < kPacketSize; ++i) rays.set(i, {0.1f, 0.2f, 0}, {0, 0, 1}, 0, endless);
    rays.set(1, {bad, 0, 0}, {0, 0, 1}, 0, endless);
    rays.set(3, {0, far, 0}, {0, 0, 1}, 0, endless);
    rays.set(5, {0, 0, endless}, {0, 0, 1}, 0, endless);
    rays.set(7, {0, 0, 0}, {0, bad, 1}, 0, endless);
    rays.set(9, {0, 0, 0}, {0, 0, far}, 0, endless);
    rays.set(11, {0, 0, 0}, {0, 0, 1}, bad, endless);
    rays.set(13, {0, 0, 0}, {0, 0, 1}, 0, bad);
    for (const Coherence coherence : {Coherence::kCoherent, Coherence::kIncoherent}) {
        HitPacket hits;
        scene.intersect(rays, coherence, hits);
        for (std::size_t i = 0; i < kPacketSize; ++i)
            EXPECT_EQ(hits.object[i], i % 2 == 1 && i < 15 ? HitPacket::kMiss : 0u) << i;
    }
    EXPECT_EQ(scene.occluded(rays), 0b1101'0101'0101'0101u);
}

}  // namespace
}  // namespace hilcam
