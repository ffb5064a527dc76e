#include "render/ground/terrain_patch.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <thread>

#include "tests/support/stage.h"

namespace hilcam {
namespace {

// Waves of 3 m over a kilometre or two: a map of any size that needs no memory.
class Waves final : public HeightMap {
  public:
    Waves(int side, double spacing_m, float amplitude_m)
        : side_(side), spacing_m_(spacing_m), amplitude_m_(amplitude_m) {}
    int columns() const override { return side_; }
    int rows() const override { return side_; }
    double spacing_m() const override { return spacing_m_; }
    float height_m(int column, int row) const override {
        ++reads;
        return amplitude_m_ * std::sin(0.01f * static_cast<float>(column)) *
               std::cos(0.013f * static_cast<float>(row));
    }
    mutable std::atomic<std::uint64_t> reads{0};

  private:
    int side_;
    double spacing_m_;
    float amplitude_m_;
};

// A million columns and rows, two terabytes as int16: only what is looked at is read, near fine and far
// coarse.
TEST(Terrain, AMapLargerThanMemoryIsReadWhereItIsLookedAt) {
    const Waves map(1'000'000, 1, 3);
    TerrainView view{
        .camera_m = {12'345, -54'321, 100}, .pixel_rad = 1e-3, .edge_px = 2, .max_triangles = 200'000};
    const TerrainMesh terrain = terrain_mesh(map, 0, view);
    EXPECT_LE(terrain.mesh.triangles.size(), 200'000u);
    EXPECT_GT(terrain.mesh.triangles.size(), 100'000u);
    EXPECT_LT(map.reads, 5'000'000u);
    // Under the camera triangles have the map's own spacing, and their heights.
    double nearest = 1e9;
    for (const Vec3f& v : terrain.mesh.vertices_m) {
        const Vec3d p = terrain.anchor_m + to_double(v);
        nearest = std::min(nearest, std::hypot(p.x - view.camera_m.x, p.y - view.camera_m.y));
        ASSERT_TRUE(std::isfinite(v.x + v.y + v.z));
    }
    EXPECT_LT(nearest, 1);
    // The whole map is covered: its corners are there.
    double farthest = 0;
    for (const Vec3f& v : terrain.mesh.vertices_m) {
        const Vec3d p = terrain.anchor_m + to_double(v);
        farthest = std::max(farthest, std::hypot(p.x, p.y));
    }
    EXPECT_NEAR(farthest, 999'999 / std::sqrt(2.0), 50);
}

// Between posts the ground is where a line from one to the next has it, not at the nearest post; on a sphere
// down is to its middle.
TEST(Terrain, HeightAboveGroundIsThatUnderThePoint) {
    class Slope final : public HeightMap {
      public:
        int columns() const override { return 101; }
        int rows() const override { return 101; }
        double spacing_m() const override { return 20; }
        float height_m(int column, int row) const override {
            return static_cast<float>(6 * column - 4 * row);
        }
    } map;
    // 0.3 m up a metre to the east, 0.2 m to the north; the middle is at 100 m.
    EXPECT_NEAR(*height_above_ground_m(map, 0, {13, -7, 150}), 150 - (100 + 0.3 * 13 - 0.2 * 7), 1e-9);
    EXPECT_NEAR(*height_above_ground_m(map, 0, {1000, 1000, 0}), -600, 1e-9);  // the map's corner
    EXPECT_FALSE(height_above_ground_m(map, 0, {1001, 0, 150}));
    EXPECT_FALSE(height_above_ground_m(map, 0, {std::nan(""), 0, 150}));
    constexpr double kMoon_m = 1737.4e3;
    const double angle = 500 / kMoon_m, r = kMoon_m + 100 + 0.3 * 500 + 42;
    EXPECT_NEAR(*height_above_ground_m(map, kMoon_m, {r * std::sin(angle), 0, r * std::cos(angle) - kMoon_m}),
                42, 1e-6);
}

// On a sphere, points of the map keep their distance along the ground and their height.
TEST(Terrain, OnASphereDistancesAlongTheGroundStay) {
    constexpr double kMoon_m = 1737.4e3;
    const Waves map(4097, 100, 0);
    const TerrainMesh terrain = terrain_mesh(
        map, kMoon_m, {.camera_m = {0, 0, 1e5}, .pixel_rad = 1e-3, .edge_px = 2, .max_triangles = 100'000});
    double farthest_rad = 0;
    std::size_t on_sphere = 0;
    for (const Vec3f& v : terrain.mesh.vertices_m) {
        const Vec3d from_center = terrain.anchor_m + to_double(v) + Vec3d{0, 0, kMoon_m};
        if (std::abs(length(from_center) - kMoon_m) < 1) ++on_sphere;  // the others hang in skirts
        farthest_rad =
            std::max(farthest_rad, std::atan2(std::hypot(from_center.x, from_center.y), from_center.z));
    }
    EXPECT_GT(on_sphere, terrain.mesh.vertices_m.size() / 2);
    EXPECT_NEAR(farthest_rad * kMoon_m, 2048 * 100 * std::sqrt(2.0), 100);
}

// No sky is seen through the ground between fine and coarse tiles, straight down and aslant, nor along the
// edges that a camera straight above a post looks along, whatever the quality says of objects.
TEST(Terrain, ThereAreNoGapsBetweenTiles) {
    for (const double slant : {0.0, 1.0}) {
        Stage s;
        s.quality.watertight = false;
        s.camera(256, 0.5);
        s.quality.path_model = "direct";
        s.quality.max_depth = 1;
        s.scene.terrain = std::make_unique<SceneTerrain>();
        s.scene.terrain->ground = std::make_unique<TerrainPatch>(std::make_unique<Waves>(20'001, 2, 30), 0);
        s.scene.terrain->material = make_material(lambert(0.5), s.grid);
        s.scene.terrain->max_triangles = 60'000;
        s.scene.terrain->edge_px = 4;
        // The camera looks along +z; the ground's up is -z: east x, north -y.
        s.scene.terrain->pose = {{0, 0, 500}, from_rotation_vector({kPi + slant, 0, 0})};
        s.sun({0.3, 0.2, -1});
        s.render();
        int dark = 0;
        for (int y = 0; y < 256; ++y)
            for (int x = 0; x < 256; ++x)
                if (s.radiance.row(y)[static_cast<std::size_t>(x)] == 0) ++dark;
        EXPECT_EQ(dark, 0) << slant;
    }
}

struct OverWaves : Stage {
    OverWaves() {
        camera(64, 0.5);
        quality.path_model = "direct";
        scene.terrain = std::make_unique<SceneTerrain>();
        auto map = std::make_unique<Waves>(200'001, 1, 30.0f);
        waves = map.get();
        scene.terrain->ground = std::make_unique<TerrainPatch>(std::move(map), 0);
        scene.terrain->material = make_material(lambert(0.5), grid);
        scene.terrain->max_triangles = 50'000;
        scene.terrain->pose = {{0, 0, 500}, from_rotation_vector({kPi, 0, 0})};
        sun({0.3, 0.2, -1});
    }
    const Waves* waves;
};

// While frames go on, a thread makes what a camera that moves needs; nothing waits for it.
TEST(Terrain, FollowsTheCameraBesideTheFrames) {
    OverWaves s;
    s.build();
    s.render_again();
    const auto description = [&] {
        std::string text;
        for (const std::string& line : s.renderer->explain_plan(s.world))
            if (line.find("object 1") != std::string::npos) text = line;
        return text;
    };
    const std::string before = description();
    EXPECT_NE(before, "");
    s.world.camera.position_world_m = {30'000, 20'000, 200};
    bool changed = false;
    for (int frame = 0; frame < 200 && !changed; ++frame) {
        s.render_again();
        for (const float value : s.radiance.plane(0)) ASSERT_GT(value, 0);
        changed = description() != before;
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    EXPECT_TRUE(changed);
}

// The first frame does not wait for the mesh, unless it is to be that frame's own.
TEST(Terrain, TheFirstMeshIsMadeAhead) {
    for (const bool wait : {false, true}) {
        OverWaves s;
        s.scene.terrain->wait = wait;
        s.build();
        s.renderer->make_ground_ahead(s.world);
        EXPECT_EQ(s.waves->reads.load() > 0, !wait);
        s.render_again();
        for (const float value : s.radiance.plane(0)) ASSERT_GT(value, 0);
    }
}

}  // namespace
}  // namespace hilcam
