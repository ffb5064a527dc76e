#include "io/meshes/shape_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/meshes/mesh_file.h"
#include "tests/support/files.h"

namespace hilcam {
namespace {

using testing::HasSubstr;

double volume(const Mesh& m) {
    double six = 0;
    for (const auto& t : m.triangles)
        six += dot(to_double(m.vertices_m[t[0]]),
                   cross(to_double(m.vertices_m[t[1]]), to_double(m.vertices_m[t[2]])));
    return six / 6;
}

// Corners of a tetrahedron of volume 1/6, whose facets look inwards in the file.
constexpr const char* kLetters = "v 0 0 0\nv 1 0 0\n\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 4 2\nf 1 3 4\nf 2 4 3\n";
constexpr const char* kPlates =
    "4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n4\n1 1 3 2\n2 1 2 4\n3 1 4 3\n4 2 3 4\n";

// Face 1 to 6 of a cube from -1 to 1 with Q = 2, each from a corner and two ways along its edges, as the format has them.
std::string cube() {
    std::string out = "2\n";
    const auto face = [&](Vec3d corner, Vec3d along_i, Vec3d along_j) {
        for (int j = 0; j <= 2; ++j)
            for (int i = 0; i <= 2; ++i) {
                const Vec3d v = corner + 0.5 * i * along_i + 0.5 * j * along_j;
                out += std::to_string(v.x) + " " + std::to_string(v.y) + " " + std::to_string(v.z) + "\n";
            }
    };
    const Vec3d x{2, 0, 0}, y{0, 2, 0}, z{0, 0, 2};
    face({-1, -1, 1}, x, y), face({-1, 1, 1}, x, -z), face({-1, -1, 1}, y, -z), face({1, -1, 1}, -x, -z),
        face({1, 1, 1}, -y, -z), face({-1, 1, -1}, x, -y);
    return out;
}

TEST(ShapeTable, EveryFormEnclosesItsVolume) {
    EXPECT_NEAR(volume(read_shape_table(kLetters, "t")), 1.0 / 6, 1e-7);
    const Mesh from_zero =
        read_shape_table("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 0 1 2\nf 0 3 1\nf 0 2 3\nf 1 3 2\n", "t");
    EXPECT_NEAR(volume(from_zero), 1.0 / 6, 1e-7);
    EXPECT_NEAR(volume(read_shape_table(kPlates, "t")), 1.0 / 6, 1e-7);
    const Mesh m = read_shape_table(cube(), "t");
    EXPECT_EQ(m.vertices_m.size(), 26u);  // 6 Q^2 + 2
    EXPECT_EQ(m.triangles.size(), 48u);
    EXPECT_NEAR(volume(m), 8, 1e-6);
    EXPECT_EQ(m.surfaces.front().name, "shape");
}

// An octahedron with half axes 2, 1 and 1 has 4/3 times their product.
constexpr const char* kCorners = "2 0 0\n-2 0 0\n0 1 0\n0 -1 0\n0 0 1\n0 0 -1\n";
constexpr const char* kFacets[] = {"1 3 5", "3 2 5", "2 4 5", "4 1 5", "3 1 6", "2 3 6", "4 2 6", "1 4 6"};

// DAMIT, ADAM and Basilisk have facets as corners alone, NAIF's type 4 and others behind their count.
TEST(ShapeTable, PolyhedraOfTwoCountsAreNoCubes) {
    for (const char* before : {"", "3 ", "3\n", "3,"}) {
        std::string text = "  6   8\r\n" + std::string(kCorners) + "\n";
        for (const char* facet : kFacets) text.append(before).append(facet) += '\n';
        const Mesh m = read_shape_table(text, "t");
        EXPECT_EQ(m.vertices_m.size(), 6u) << before;
        EXPECT_EQ(m.triangles.size(), 8u) << before;
        EXPECT_NEAR(volume(m), 16.0 / 6, 1e-6) << before;
    }
    // The same with its counts on one line and numbers before its lines is a table of plates; a square is two facets.
    EXPECT_EQ(read_shape_table("4 1\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n4 1 2 3 4\n", "t").triangles.size(), 2u);
    EXPECT_NEAR(volume(read_shape_table(
                    "4 4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n1 1 3 2\n2 1 2 4\n3 1 4 3\n4 2 3 4\n", "t")),
                1.0 / 6, 1e-7);
}

TEST(ShapeTable, ExponentsOfFortranAndTheEndOfATextOfDosAreKnown) {
    std::string text = "\xEF\xBB\xBF";
    for (const char* line : {"v 0.0D+00 0 0\r\n", "v 1.0d0 0 0\r\n", "v 0 .1D1 0\r\n", "v 0 0 10D-1\r\n",
                             "f 1 2 3\r\nf 1 4 2\r\nf 1 3 4\r\nf 2 4 3\r\n"})
        text += line;
    for (const std::string& end : {std::string(), std::string("\x1A"), std::string("\x1A and what was there"),
                                   std::string(7, '\0'), std::string("\r\n\r\n\x1A\0", 6)})
        EXPECT_NEAR(volume(read_shape_table(text + end, "t")), 1.0 / 6, 1e-7);
}

TEST(ShapeTable, MistakesAreNamedWithTheirLine) {
    const auto why = [](const std::string& text) {
        try {
            read_shape_table(text, "s.tab");
        } catch (const InputError& error) {
            return std::string(error.what());
        }
        return std::string("nothing");
    };
    EXPECT_THAT(why(""), HasSubstr("the file ends"));
    EXPECT_THAT(why("v 0 0 0\nf 1 2 3\n"),
                HasSubstr("s.tab:2: found '2'; accepted: the number of a vertex, of which there are 1"));
    EXPECT_THAT(why("v 0 0 0\nv 1 0 0\nf 0 1 2\n"),
                HasSubstr("corners are counted from 0 and reach the number of vertices, 2"));
    EXPECT_THAT(why("v 0 0 x\n"), HasSubstr("s.tab:1: found 'x'; accepted: a number below 1e9"));
    EXPECT_THAT(why("v 0 0 0\nq 1\n"), HasSubstr("s.tab:2: found 'q 1'; accepted: v x y z, or f i j k"));
    EXPECT_THAT(why("v 0 0 0\n"), HasSubstr("has no facet"));
    EXPECT_THAT(why("4\n1 0 0 0\n3 0 0 0\n"),
                HasSubstr("s.tab:3: found '3'; accepted: the vertex's number, 2"));
    EXPECT_THAT(why(cube().substr(0, 300)), HasSubstr("accepted: "));
    EXPECT_THAT(why("9000\n1 2 3\n"), HasSubstr("Q of 1 to 4096"));
    EXPECT_THAT(why("3 1\n0 0 0\n1 0 0\n0 1 0\n"), HasSubstr("the file ends; accepted: a facet"));
    EXPECT_THAT(why("3 1\n0 0 0\n1 0\n"), HasSubstr("s.tab:3: found '1 0'; accepted: three coordinates"));
    EXPECT_THAT(why("3 1\n0 0 0\n1 0 0\n0 1 0\n7 1 2 3\n"),
                HasSubstr("s.tab:5: found '7 1 2 3'; accepted: three corners, or 3"));
    EXPECT_THAT(why("3 1\n0 0 0\n1 0 0\n0 1 0\n3\n1 2\n"),
                HasSubstr("s.tab:6: found '1 2'; accepted: 3 corners"));
    EXPECT_THAT(why("v 1D 0 0\n"), HasSubstr("s.tab:1: found '1D'; accepted: a number"));
}

class ShapeFiles : public FilesTest {};

TEST_F(ShapeFiles, AreMeshesAsOthers) {
    EXPECT_EQ(load_mesh(write("a.tab", kLetters)).triangles.size(), 4u);
    EXPECT_EQ(load_mesh_contents(write("b.plt", kPlates)).mesh.triangles.size(), 4u);
    EXPECT_EQ(load_mesh(write("c.icq", cube())).triangles.size(), 48u);
    EXPECT_THAT(error_of([&] { load_mesh(write("d.icq", "v 1\n")); }),
                HasSubstr("d.icq:1: found 'v'; accepted: a number"));
    const std::vector<std::string> wing = {"wing"};
    EXPECT_THAT(error_of([&] { load_mesh_parts(folder_ / "a.tab", wing); }), HasSubstr("has no nodes"));
}

TEST(ShapeTable, ErosIsWhole) {
    const std::filesystem::path file =
        std::filesystem::path(HILCAM_SOURCE_DIR) / "../shared/data/shapes/eros007790.tab";
    if (!std::filesystem::exists(file)) GTEST_SKIP() << "needs the shared data, " << file;
    const Mesh m = load_mesh(file);
    EXPECT_EQ(m.triangles.size(), 7790u);
    EXPECT_EQ(m.vertices_m.size(), 3897u);
    // Thomas et al., Icarus 155, 18 (2002): 2535 +- 20 km^3; the model of this many facets lies within.
    EXPECT_NEAR(volume(m), 2535, 20);
}

}  // namespace
}  // namespace hilcam
