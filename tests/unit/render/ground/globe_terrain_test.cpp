#include "render/ground/globe_terrain.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "render/ground/crater_field.h"
#include "render/ground/cube_sphere.h"
#include "tests/support/ground_maps.h"
#include "tests/support/stage.h"

namespace hilcam {
namespace {

constexpr Figure kMoonFigure = kFigures[index_of(BodyId::kMoon)];

std::vector<GroundMap> relief(int columns, double amplitude_m) {
    std::vector<GroundMap> maps(1);
    maps[0].raster = std::make_unique<WaveMap>(columns, amplitude_m, kMoonFigure.equatorial_radius_m);
    return maps;
}

// The two faces of an edge have the same points there, and every direction is on one face.
TEST(CubeSphere, FacesMeetAtTheirEdges) {
    for (int face = 0; face < kCubeFaces; ++face) {
        EXPECT_EQ(
            cross(kCube[static_cast<std::size_t>(face)].right, kCube[static_cast<std::size_t>(face)].up),
            kCube[static_cast<std::size_t>(face)].axis);
        for (const double along : {-0.75, -0.5, 0.0, 0.25, 0.5})
            for (const Vec2d edge : {Vec2d{1, along}, Vec2d{-1, along}, Vec2d{along, 1}, Vec2d{along, -1}}) {
                const Vec3d dir = cube_direction(face, edge);
                int meeting = 0;
                for (int other = 0; other < kCubeFaces; ++other)
                    for (const double there : {along, -along})
                        for (const Vec2d at :
                             {Vec2d{1, there}, Vec2d{-1, there}, Vec2d{there, 1}, Vec2d{there, -1}})
                            if (other != face && length(cube_direction(other, at) - dir) < 1e-15) {
                                ++meeting;
                                if (along == 0) break;
                            }
                EXPECT_GE(meeting, 1) << face << ' ' << edge.x << ' ' << edge.y;
            }
        const CubePoint back = cube_point(7.0 * cube_direction(face, {0.3, -0.8}));
        EXPECT_EQ(back.face, face);
        EXPECT_NEAR(back.at.x, 0.3, 1e-15);
        EXPECT_NEAR(back.at.y, -0.8, 1e-15);
    }
}

// A mesh is as fine as is asked for below the camera, and rays that meet it meet the maps' bilinear heights, at the poles and the
// antimeridian, too: within a twentieth of what a pixel is wide there.
TEST(GlobeTerrain, RaysMeetTheHeightsOfTheMap) {
    constexpr double kAbove_m = 20'000;
    for (const auto& [lon, lat] :
         {std::pair{23.4, 0.7}, {179.99, -12.0}, {-180.0, 40.0}, {77.0, 89.9}, {0.0, 90.0}, {10.0, -90.0}}) {
        GlobeTerrain terrain(kMoonFigure, relief(1440, 3000), {}, {});
        GroundSurface surface(kMoonFigure, relief(1440, 3000), std::size_t{16} << 20);
        const Vec3d up = place_on_sphere(lon, lat);
        TerrainView view;
        view.camera_m = surface.point(up, kAbove_m);
        view.boresight = -up;
        view.half_field_rad = 0.4;
        view.max_triangles = 2'000'000;
        const TerrainMesh made = terrain.mesh(view);
        EXPECT_LE(made.mesh.triangles.size(), 2'000'000u);
        EXPECT_GT(made.mesh.triangles.size(), 200'000u);
        const TerrainRays rays(made);
        const Vec3d right = normalized(cross(Vec3d{0.1, 0.2, 0.97}, up)), ahead = cross(up, right);
        double max_m = 0, sum2_m2 = 0;
        constexpr int kRays = 4000;
        for (int i = 0; i < kRays; ++i) {
            const double off_rad = 0.39 * std::sqrt((i + 0.5) / kRays), turn_rad = 2.39996 * i;
            const Vec3d dir = -std::cos(off_rad) * up +
                              std::sin(off_rad) * (std::cos(turn_rad) * right + std::sin(turn_rad) * ahead);
            const Vec3d point_m = view.camera_m + rays.distance_m(view.camera_m, dir) * dir;
            const Vec3d place = normalized(point_m);
            double height_m = 0;
            surface.find_heights({&place, 1}, 0, {&height_m, 1});
            const double error_m = length(point_m) - kMoonFigure.equatorial_radius_m - height_m;
            ASSERT_TRUE(std::isfinite(error_m));
            max_m = std::max(max_m, std::abs(error_m)), sum2_m2 += error_m * error_m;
        }
        const double pixel_m = kAbove_m * view.pixel_rad;
        EXPECT_LT(max_m, 0.05 * pixel_m) << lon << ' ' << lat;
        std::printf("%8.2f E %6.2f N: root mean square %.4f m, most %.4f m, a pixel is %.0f m\n", lon, lat,
                    std::sqrt(sum2_m2 / kRays), max_m, pixel_m);
    }
}

// Kept maps and tiles stay below the limit while the camera goes around the body, and what was seen comes back bit by
// bit, whatever has been thrown away meanwhile.
TEST(GlobeTerrain, MemoryIsBoundedAndTheSameViewGivesTheSameMesh) {
    GlobeSettings settings;
    settings.max_bytes = std::size_t{48} << 20;
    GlobeTerrain terrain(kMoonFigure, relief(5760, 3000), {}, settings);
    const auto mesh_at = [&](double lon) {
        TerrainView view;
        view.camera_m = (kMoonFigure.equatorial_radius_m + 15'000) * place_on_sphere(lon, 5);
        view.boresight = -normalized(view.camera_m);
        view.half_field_rad = 0.2;
        view.max_triangles = 300'000;
        return terrain.mesh(view);
    };
    const TerrainMesh first = mesh_at(0);
    for (double lon = 60; lon < 360; lon += 60) {
        mesh_at(lon);
        ASSERT_LE(terrain.kept_bytes(), settings.max_bytes);
    }
    const TerrainMesh again = mesh_at(0);
    ASSERT_EQ(first.mesh.vertices_m.size(), again.mesh.vertices_m.size());
    EXPECT_EQ(first.anchor_m, again.anchor_m);
    EXPECT_TRUE(std::equal(first.mesh.vertices_m.begin(), first.mesh.vertices_m.end(),
                           again.mesh.vertices_m.begin()));
    EXPECT_TRUE(std::equal(first.mesh.normals.begin(), first.mesh.normals.end(), again.mesh.normals.begin()));
}

// Tiles are made a few at a time, all that a mesh needs in the end, and it is the mesh that it would have been.
TEST(GlobeTerrain, WhatIsMadeAheadIsWhatAMeshNeeds) {
    GlobeTerrain plain(kMoonFigure, relief(1440, 3000), {}, {}),
        ahead(kMoonFigure, relief(1440, 3000), {}, {});
    const Vec3d up = place_on_sphere(23.4, 0.7);
    TerrainView high, low;
    for (TerrainView* const view : {&high, &low}) view->boresight = -up, view->half_field_rad = 0.4;
    high.camera_m = (kMoonFigure.equatorial_radius_m + 20'000) * up;
    low.camera_m = (kMoonFigure.equatorial_radius_m + 9'000) * up;
    plain.mesh(high), ahead.mesh(high);
    const std::size_t before = ahead.kept_bytes();
    ASSERT_TRUE(ahead.make_ahead(low));
    const std::size_t some = ahead.kept_bytes();
    int calls = 1;
    while (ahead.make_ahead(low)) ASSERT_LT(++calls, 1000);
    EXPECT_GT(calls, 4);
    const std::size_t all = ahead.kept_bytes();
    EXPECT_GT(some, before);
    EXPECT_LT(some - before, (all - before) / 4);
    const TerrainMesh expected = plain.mesh(low), made = ahead.mesh(low);
    EXPECT_EQ(ahead.kept_bytes(), all);
    EXPECT_EQ(made.mesh.vertices_m, expected.mesh.vertices_m);
    EXPECT_EQ(made.mesh.normals, expected.mesh.normals);
}

// No sky comes through between tiles, over a corner of the cube and a pole, straight down
// and aslant.
TEST(GlobeTerrain, ThereAreNoGapsBetweenTiles) {
    const double corner_deg = std::atan(std::sqrt(0.5)) / kDegree_rad;
    for (const auto& [lon, lat] : {std::pair{45.0, corner_deg}, {180.0, 90.0}})
        for (const double slant_rad : {0.0, 0.7}) {
            Stage s;
            s.quality.watertight = false;
            s.camera(256, 0.25);
            s.quality.path_model = "direct";
            s.quality.max_depth = 1;
            s.scene.terrain = std::make_unique<SceneTerrain>();
            s.scene.terrain->ground = std::make_unique<GlobeTerrain>(
                kMoonFigure, relief(1440, 3000), std::vector<std::unique_ptr<const GroundDetail>>{},
                GlobeSettings{});
            s.scene.terrain->material = make_material(lambert(0.5), s.grid);
            s.scene.terrain->max_triangles = 1'000'000;
            s.scene.terrain->edge_px = 4;
            const Vec3d up = place_on_sphere(lon, lat);
            s.world.camera.position_world_m = (kMoonFigure.equatorial_radius_m + 20'000) * up;
            const Vec3d side = normalized(cross(up, Vec3d{0.3, -0.2, 0.1}));
            s.world.camera.world_from_body =
                look_along(-std::cos(slant_rad) * up + std::sin(slant_rad) * side, side);
            s.sun(up);
            s.render();
            int dark = 0;
            for (const float value : s.radiance.plane(0)) dark += value == 0 ? 1 : 0;
            EXPECT_EQ(dark, 0) << lon << ' ' << lat << ' ' << slant_rad;
        }
}

// What changes from one mesh to the next, where the camera has moved by a fiftieth of its height, is less than a quarter of a
// pixel.
TEST(GlobeTerrain, NothingStepsByAQuarterOfAPixelWhileTheCameraComesDown) {
    GlobeTerrain terrain(kMoonFigure, relief(1440, 3000), {}, {});
    const Vec3d up = place_on_sphere(45, 3);
    constexpr double kPixel_rad = 1.5e-3;
    const auto made_at = [&](double height_m) {
        TerrainView view;
        view.camera_m = (kMoonFigure.equatorial_radius_m + height_m) * up;
        view.boresight = -up;
        view.half_field_rad = 0.4;
        view.pixel_rad = kPixel_rad;
        return terrain.mesh(view);
    };
    double max_px = 0;
    auto before = std::make_unique<TerrainRays>(made_at(20'000));
    const Vec3d east = normalized(cross(Vec3d{0, 0, 1}, up)), north = cross(up, east);
    for (double height_m = 20'000 / 1.02; height_m > 16'000; height_m /= 1.02) {
        auto now = std::make_unique<TerrainRays>(made_at(height_m));
        for (int i = 0; i < 400; ++i) {
            // Equal areas of the picture by a golden-angle spiral (Vogel 1979).
            const double off_rad = 0.35 * std::sqrt((i + 0.5) / 400), turn_rad = 2.39996 * i;
            const double across_m = height_m * std::tan(off_rad);
            const Vec3d place =
                normalized(kMoonFigure.equatorial_radius_m * up + across_m * std::cos(turn_rad) * east +
                           across_m * std::sin(turn_rad) * north);
            const Vec3d above_m = (kMoonFigure.equatorial_radius_m + 10'000) * place;
            const double step_m =
                std::abs(before->distance_m(above_m, -place) - now->distance_m(above_m, -place));
            max_px = std::max(max_px, step_m * std::sin(off_rad) * std::cos(off_rad) / height_m / kPixel_rad);
        }
        before = std::move(now);
    }
    EXPECT_LT(max_px, 0.25);
    EXPECT_GT(max_px, 0);
}

// What a mesh knows of the Sun before rays ask is what they find: a second object, behind the camera, has them all asked. The Sun
// is 10 deg high over craters, which throw shadows.
TEST(GlobeTerrain, TheSunThatAMeshKnowsIsTheOneThatRaysFind) {
    std::vector<float> first;
    for (const bool asked : {false, true}) {
        Stage s;
        s.camera(256, 0.3);
        s.quality.path_model = "direct";
        s.quality.max_depth = 1;
        const Vec3d up = place_on_sphere(20, 5);
        if (asked) {
            s.scene.objects.push_back(cube(lambert(0.5), s.grid));
            s.world.objects.push_back({(kMoonFigure.equatorial_radius_m + 9'000) * up, {}});
        }
        std::vector<std::unique_ptr<const GroundDetail>> details;
        details.push_back(std::make_unique<CraterField>(kMoonFigure.equatorial_radius_m, CraterSettings{}));
        s.scene.terrain = std::make_unique<SceneTerrain>();
        s.scene.terrain->ground = std::make_unique<GlobeTerrain>(kMoonFigure, std::vector<GroundMap>{},
                                                                 std::move(details), GlobeSettings{});
        s.scene.terrain->material = make_material(lambert(0.5), s.grid);
        s.scene.terrain->edge_px = 4;
        const Vec3d east = normalized(cross(Vec3d{0, 0, 1}, up));
        s.world.camera.position_world_m = (kMoonFigure.equatorial_radius_m + 3'000) * up;
        s.world.camera.world_from_body = look_along(-1.0 * up, east);
        s.sun(std::sin(0.17) * up + std::cos(0.17) * east);
        s.render();
        const auto plane = s.radiance.plane(0);
        if (!asked) {
            first.assign(plane.begin(), plane.end());
            continue;
        }
        std::size_t others = 0, dark = 0;
        for (std::size_t i = 0; i < first.size(); ++i) {
            others += std::abs(first[i] - plane[i]) > 1e-3f * (first[i] + plane[i]) ? 1u : 0u;
            dark += plane[i] == 0 ? 1u : 0u;
        }
        EXPECT_GT(dark, 300u);
        EXPECT_LT(others, 10u);
    }
}

// A map of a parameter of Hapke's law whose values are the longitude.
class LongitudeMap final : public WholeMap {
  public:
    LongitudeMap() : WholeMap(1440, kMoonFigure.equatorial_radius_m) {}
    double height_m(int column, int) const override { return longitude_deg(column) / 90; }
    double longitude_deg(int column) const { return (column + 0.5) * 360 / shape_.columns - 180; }
};

// Each vertex of the mesh has the map's parameter of its place, at all levels and between them; skirts have their edges'.
TEST(GlobeTerrain, VerticesHaveThePlacesParameters) {
    std::vector<GroundMap> maps(1);
    maps[0].kind = GroundKind::kLobeBackward;
    maps[0].raster = std::make_unique<LongitudeMap>();
    GlobeSettings settings;
    settings.hapke.b = 0.33f;
    GlobeTerrain terrain(kMoonFigure, std::move(maps), {}, settings);
    TerrainView view;
    const Vec3d up = place_on_sphere(30, 10);
    view.camera_m = (kMoonFigure.equatorial_radius_m + 50e3) * up;
    view.boresight = -up;
    view.half_field_rad = 0.4;
    const TerrainMesh made = terrain.mesh(view);
    ASSERT_EQ(made.mesh.hapke.size(), made.mesh.vertices_m.size());
    int compared = 0;
    for (std::size_t i = 0; i < made.mesh.vertices_m.size(); ++i) {
        const Vec3d at = made.anchor_m + to_double(made.mesh.vertices_m[i]);
        EXPECT_EQ(made.mesh.hapke[i].b, 0.33f);
        const double longitude_deg = std::atan2(at.y, at.x) / kDegree_rad;
        // In view: tiles there are far finer than the map.
        if (length(normalized(at) - up) > 0.01) continue;
        ++compared;
        EXPECT_NEAR(made.mesh.hapke[i].c, longitude_deg / 90, 2e-4);
    }
    EXPECT_GT(compared, 10'000);
}

}  // namespace
}  // namespace hilcam
