#include "emulator/zoo/zoo_entries.h"

#include <gtest/gtest.h>

#include <map>

#include "tests/support/files.h"

namespace hilcam {
namespace {

constexpr const char* kTriangles =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nusemtl solar_panel\nf 1 2 3\nusemtl it's_gold\nf 1 2 4\n";

class ZooEntries : public FilesTest {
  protected:
    std::vector<ZooEntry> entries(const ZooEntriesOptions& options = {}) {
        return zoo_entries(folder_, options);
    }
};

TEST_F(ZooEntries, AMeshBecomesAScenarioWithMaterialsByItsSurfacesNames) {
    write("thing.obj", kTriangles);
    const auto found = entries();
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].name, "thing");
    const ScenarioConfig scenario = found[0].source.load();
    ASSERT_EQ(scenario.objects.size(), 1u);
    EXPECT_EQ(scenario.objects[0].mesh, folder_ / "thing.obj");
    // The importer may add a surface of its own that no triangle has.
    std::map<std::string, double> roughness;
    for (const SurfaceConfig& surface : scenario.objects[0].materials.surfaces)
        roughness[surface.name] = surface.material.roughness;
    EXPECT_EQ(roughness.at("solar_panel"), 0.12);  // solar_cell.yaml
    EXPECT_EQ(roughness.at("it's_gold"), 0.42);    // mli_kapton.yaml
}

TEST_F(ZooEntries, PicturesAreSmallerAndShowTheSame) {
    write("thing.obj", kTriangles);
    const CameraModel small = entries({.picture_px = 256, .overrides = {}})[0].source.load().camera;
    const CameraModel own = entries({.picture_px = 4096, .overrides = {}})[0].source.load().camera;
    EXPECT_EQ(own.width_px, 1024);
    EXPECT_EQ(small.width_px, 256);
    EXPECT_EQ(small.height_px, 256);
    EXPECT_DOUBLE_EQ(small.focal_length_m / 256, own.focal_length_m / 1024);
    // What the user sets comes after it.
    const ZooEntriesOptions set{.picture_px = 256, .overrides = {"camera.width_px=100", "quality=fast"}};
    const ScenarioConfig scenario = entries(set)[0].source.load();
    EXPECT_EQ(scenario.camera.width_px, 100);
    EXPECT_EQ(scenario.quality.render.lod_error_px, 0.5);
}

TEST_F(ZooEntries, AreByNameAndNothingElse) {
    write("b.obj", kTriangles), write("c.obj", kTriangles), write("notes.txt", "none"), write("a.mtl", "");
    std::filesystem::create_directories(folder_ / "d.obj");
    const auto found = entries();
    ASSERT_EQ(found.size(), 2u);
    EXPECT_EQ(found[0].name, "b");
    EXPECT_EQ(found[1].name, "c");
}

TEST_F(ZooEntries, AMeshBesideItsScenarioIsNoEntryOfItsOwn) {
    write("b.obj", kTriangles), write("c.obj", kTriangles);
    write("b.yaml",
          "name: b\ntime_utc: 2026-03-20T14:00:00Z\ncamera: inspector_1k\ncamera_pose: {position_m: [9, 0, "
          "0], look_at_m: [0, 0, "
          "0]}\nobjects: [{name: b, mesh: b.obj}]\n");
    const auto found = entries();
    ASSERT_EQ(found.size(), 2u);
    EXPECT_EQ(found[0].source.file, folder_ / "b.yaml");
    EXPECT_EQ(found[1].name, "c");
    EXPECT_NE(found[1].source.file, folder_ / "c.obj");
}

TEST_F(ZooEntries, AFolderWithoutAnyIsRefused) {
    write("notes.txt", "none");
    EXPECT_EQ(error_of([this] { entries(); }),
              "--zoo: found no scenario and no mesh in '" + folder_.string() +
                  "'; accepted: a folder with *.yaml, *.obj, *.glb, *.gltf, *.stl or *.ply");
    write("bad.obj", "v 0 0\n");
    EXPECT_NE(error_of([this] { entries(); }).find("bad.obj"), std::string::npos);
}

}  // namespace
}  // namespace hilcam
