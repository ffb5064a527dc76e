#include "io/meshes/stl_source.h"

#include <gmock/gmock.h>

#include <cmath>

#include "io/meshes/mesh_file.h"
#include "tests/support/files.h"

namespace hilcam {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const std::string kStlFacet =
    "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";

// One facet in the plane z = 0 with that normal.
std::string stl_bytes(std::array<float, 3> normal, std::uint8_t count = 1, const std::string& behind = "") {
    std::string out(80, ' ');
    out += {static_cast<char>(count), 0, 0, 0};
    for (const float number : {normal[0], normal[1], normal[2], 0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f})
        out.append(reinterpret_cast<const char*>(&number), sizeof number);
    return out + std::string(2, '\0') + behind;
}

class StlSource : public FilesTest {
  protected:
    MeshContents contents(const std::string& stl) { return load_mesh_contents(write("m.stl", stl)); }
};

TEST_F(StlSource, EverySolidIsRead) {
    for (const std::string& text :
         {"solid a\n" + kStlFacet + "endsolid a\n",
          "solid empty\nendsolid empty\nsolid b\n" + kStlFacet + "endsolid b\n",
          "solid b\n" + kStlFacet + "endsolid b\nsolid empty\nendsolid empty\n",
          "\xEF\xBB\xBFsolid a\n" + kStlFacet + "endsolid a\n", "\n  solid a\n" + kStlFacet + "endsolid a\n",
          std::string(
              "SOLID A\nFACET NORMAL 0 0 1\nOUTER LOOP\nVERTEX 0 0 0\nVERTEX 1 0 0\nVERTEX 0 1 0\nENDLOOP\n"
              "ENDFACET\nENDSOLID A\n")})
        EXPECT_EQ(contents(text).mesh.triangles.size(), 1u) << text;
    const MeshContents two =
        contents("solid a\n" + kStlFacet + "endsolid a\nsolid b\n" + kStlFacet + kStlFacet + "endsolid b\n");
    EXPECT_EQ(two.mesh.triangles.size(), 3u);
    EXPECT_THAT(error_of([&] { contents("solid a\nendsolid a\nsolid b\nendsolid b\n"); }),
                HasSubstr("m.stl: "));
}

TEST_F(StlSource, WhatLiesBehindTheLastTriangleIsLeftOut) {
    const MeshContents m = contents(stl_bytes({0, 0, 1}, 1, "extra bytes"));
    EXPECT_EQ(m.mesh.triangles.size(), 1u);
    EXPECT_THAT(m.remarks,
                ElementsAre("the file has 11 bytes behind the last of its 1 triangles; they are left out"));
    EXPECT_THAT(contents(stl_bytes({0, 0, 1})).remarks, IsEmpty());
    EXPECT_THAT(
        error_of([&] {
            contents(stl_bytes({0, 0, 1}, 0));
        }),
        HasSubstr("its 0 triangles, as a binary STL, take 84 bytes, and the file has 134, room for 1"));
    EXPECT_THAT(error_of([&] { contents(stl_bytes({0, 0, 1}, 2)); }), HasSubstr("room for 1"));
}

// The order of the corners is the normal, whatever the file says of it.
TEST_F(StlSource, FacetsAreFlat) {
    struct Case {
        std::array<float, 3> normal;
        std::uint64_t opposed, leaning;
    };
    const float lean = 0.45f, length = std::sqrt(1 - lean * lean);  // 26.7 degrees, past a cosine of 0.9
    for (const Case& one :
         {Case{{0, 0, 1}, 0, 0}, Case{{0, 0, 7}, 0, 0}, Case{{0, 0, 0}, 0, 0}, Case{{0, 0, -1}, 1, 0},
          Case{{1, 0, 0}, 0, 1}, Case{{lean, 0, length}, 0, 1}, Case{{0.4f, 0, 1}, 0, 0}}) {
        const MeshContents m = contents(stl_bytes(one.normal));
        EXPECT_TRUE(m.mesh.normals.empty());
        EXPECT_EQ(m.opposed_facets, one.opposed) << one.normal[0] << " " << one.normal[2];
        EXPECT_EQ(m.leaning_facets, one.leaning) << one.normal[0] << " " << one.normal[2];
        EXPECT_EQ(m.mesh.vertices_m[m.mesh.triangles[0][1]], (Vec3f{1, 0, 0}));
    }
}

}  // namespace
}  // namespace hilcam
