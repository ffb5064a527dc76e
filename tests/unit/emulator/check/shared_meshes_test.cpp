// Meshes and shapes in the dialects of public files, with their right values: sizes, areas and counts by the script that made them
// (`make.py` beside the files), or by what the format says. They lie in the shared data, and the test skips without these.
#include <gmock/gmock.h>

#include <cstdlib>

#include "emulator/check/mesh_survey.h"
#include "tests/support/files.h"

namespace hilcam {
namespace {

struct SharedMesh {
    const char* file;  // below cases/
    double x_m, y_m, z_m;
    std::uint64_t triangles;
    double area_m2;
    bool textured = false;
    std::size_t remarks = 0;
    std::uint64_t opposed = 0, leaning = 0;
};

// A quad of 2 m, unless it is something else.
constexpr SharedMesh quad(const char* file, bool textured = false, std::size_t remarks = 0) {
    return {file, 2, 2, 0, 2, 4, textured, remarks};
}
constexpr SharedMesh quad_of_stl(const char* file, std::uint64_t opposed, std::uint64_t leaning) {
    return {file, 2, 2, 0, 2, 4, false, 0, opposed, leaning};
}
// Half axes of 2, 1 and 1: each of eight facets has half the length of (0.5, 1, 1) x 2 for its area.
constexpr SharedMesh octahedron(const char* file) { return {file, 4, 2, 2, 8, 12}; }

constexpr SharedMesh kMeshes[] = {
    quad("obj/backslash.obj", true),
    quad("obj/case_differs.obj", true, 1),
    quad("obj/absolute_windows.obj", true, 1),
    quad("obj/spaces.obj", true),
    quad("obj/map_options.obj", true),
    quad("obj/beside_mtl.obj", true),
    quad("obj/texture_beside_mtl.obj", true),
    quad("obj/ppm.obj", true),
    quad("obj/tga.obj", true),
    quad("obj/unused_bad_texture.obj"),
    quad("obj/two_libs.obj"),
    quad("obj/negative_indices.obj"),
    quad("obj/continued_lines.obj"),
    quad("obj/mac_cr.obj"),
    quad("obj/bom.obj"),
    quad("obj/line_and_faces.obj"),
    {"obj/bom_shift.obj", 1, 1, 0, 1, 0.5},
    {"obj/concave.obj", 4, 4, 0, 3, 10},
    {"obj/normals_opposed.obj", 2, 2, 0, 2, 4, false, 0, 2, 0},
    {"obj/winding_reversed.obj", 2, 2, 0, 2, 4, false, 0, 2, 0},
    {"obj/empty_solid.stl", 1, 1, 0, 1, 0.5},
    {"obj/two_solids.stl", 2, 1, 0, 2, 1.5},
    {"obj/binary_header_solid.stl", 1, 1, 0, 2, 1},
    {"obj/binary_trailing.stl", 1, 1, 0, 1, 0.5, false, 1},
    quad_of_stl("obj/normals_right.stl", 0, 0),
    quad_of_stl("obj/normals_zero.stl", 0, 0),
    quad_of_stl("obj/normals_long.stl", 0, 0),
    quad_of_stl("obj/normals_opposed.stl", 2, 0),
    quad_of_stl("obj/normals_sideways.stl", 0, 2),
    quad("obj/coloured.ply"),
    quad("obj/tristrips.ply"),
    {"obj/double_big_endian.ply", 1, 1, 0, 1, 0.5},
    quad("gltf/percent_encoded_uri.gltf"),
    octahedron("shape/damit_plain.tab"),
    octahedron("shape/damit_three.tab"),
    octahedron("shape/plates.plt"),
    octahedron("shape/plates_d.plt"),
    octahedron("shape/vf_commas.tab"),
    octahedron("shape/vf_trailing.tab"),
};

class SharedMeshes : public FilesTest {
  protected:
    std::filesystem::path cases_;
    void SetUp() override {
        FilesTest::SetUp();
        const char* const shared = std::getenv("HILCAM_SHARED");
        cases_ = std::filesystem::path(shared ? shared : HILCAM_SOURCE_DIR "/../shared") / "cases";
        if (!std::filesystem::exists(cases_)) GTEST_SKIP() << "needs the shared data, " << cases_;
    }
    MeshSurvey survey(const char* file) { return survey_mesh(load_mesh_contents(cases_ / file), file); }
};

TEST_F(SharedMeshes, AreWhatTheirMakersSay) {
    for (const SharedMesh& right : kMeshes) {
        SCOPED_TRACE(right.file);
        MeshSurvey now;
        EXPECT_EQ(error_of([&] { now = survey(right.file); }), "no error");
        const Vec3d size_m = now.max_m - now.min_m;
        EXPECT_NEAR(size_m.x, right.x_m, 1e-6);
        EXPECT_NEAR(size_m.y, right.y_m, 1e-6);
        EXPECT_NEAR(size_m.z, right.z_m, 1e-6);
        EXPECT_EQ(now.triangles, right.triangles);
        double area_m2 = 0;
        bool textured = false;
        for (const SurveyedSurface& surface : now.surfaces)
            area_m2 += surface.area_m2, textured |= surface.textured;
        EXPECT_NEAR(area_m2, right.area_m2, 1e-6 * right.area_m2);
        EXPECT_EQ(textured, right.textured);
        EXPECT_THAT(now.unreadable_textures, testing::IsEmpty());
        EXPECT_THAT(now.missing_materials, testing::IsEmpty());
        EXPECT_THAT(now.remarks, testing::SizeIs(right.remarks));
        EXPECT_EQ(now.opposed_normals, right.opposed);
        EXPECT_EQ(now.leaning_normals, right.leaning);
    }
}

// Closed, and one: radii every 30 degrees, and every polyhedron.
TEST_F(SharedMeshes, ShapesAreOneClosedShell) {
    for (const char* file : {"shape/damit_plain.tab", "shape/lat_lon_radius.tab", "shape/vf_trailing.tab"}) {
        const MeshSurvey now = survey(file);
        EXPECT_EQ(now.shells, 1u) << file;
        EXPECT_EQ(now.open_edges + now.inconsistent_edges + now.crowded_edges + now.inverted_shells, 0u)
            << file;
    }
    const MeshSurvey ellipsoid = survey("shape/lat_lon_radius.tab");
    EXPECT_NEAR(ellipsoid.max_m.x - ellipsoid.min_m.x, 4, 1e-6);
    EXPECT_NEAR(ellipsoid.max_m.y - ellipsoid.min_m.y, 2, 1e-6);
    EXPECT_NEAR(ellipsoid.max_m.z - ellipsoid.min_m.z, 2, 1e-6);
    EXPECT_THAT(ellipsoid.remarks,
                testing::ElementsAre(testing::HasSubstr("its longitudes are taken as east")));
}

TEST_F(SharedMeshes, ACountOfNoneBeforeTrianglesIsRefused) {
    EXPECT_THAT(error_of([&] { survey("obj/binary_count_zero.stl"); }), testing::HasSubstr("room for 2"));
}

// Spacecraft and small bodies of NASA's 42.
TEST_F(SharedMeshes, ModelsOf42Open) {
    const std::filesystem::path zoo = cases_.parent_path() / "data/models/zoo";
    if (!std::filesystem::exists(zoo)) GTEST_SKIP() << "needs the shared data, " << zoo;
    for (const auto& entry : std::filesystem::directory_iterator(zoo)) {
        if (entry.path().extension() != ".obj") continue;
        EXPECT_EQ(error_of([&] { EXPECT_GT(load_mesh_contents(entry.path()).mesh.triangles.size(), 0u); }),
                  "no error")
            << entry.path();
    }
}

}  // namespace
}  // namespace hilcam
