#include "io/meshes/obj_source.h"

#include <gmock/gmock.h>

#include <algorithm>

#include "io/meshes/mesh_file.h"
#include "tests/support/files.h"

namespace hilcam {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::string plain_obj_text(const std::string& obj) { return plain_obj(obj, "m.obj").text; }

TEST(ObjSource, SaysTheSameInPlainWords) {
    EXPECT_EQ(plain_obj_text("\xEF\xBB\xBFv 0 0 0\n"), "v 0 0 0\n");
    EXPECT_EQ(plain_obj_text("  v 1 2 3 # a comment\n\tvn 0 0 1\r\n\r\nf 1 2 3\rf 4 5 6"),
              "v 1 2 3\nvn 0 0 1\nf 1 2 3\nf 4 5 6\n");
    EXPECT_EQ(plain_obj_text("v .5 -.5 1.5D+01\n"), "v 0.5 -.5 1.5e+01\n");
    EXPECT_EQ(plain_obj_text("v 1 2 3 1\nv 1 2 3 .1 .2 .3\nv 1 2 3 .1 .2 .3 1\nv 1 2 3 4 5\n"),
              "v 1 2 3 1\nv 1 2 3 0.1 0.2 0.3\nv 1 2 3 0.1 0.2 0.3\nv 1 2 3\n");
    EXPECT_EQ(plain_obj_text("vt 0.5\nvt 0 1\nvt 0 1 0\n"), "vt 0.5 0\nvt 0 1\nvt 0 1 0\n");
    EXPECT_EQ(plain_obj_text("f 01/002/3 +2//4 -1/-2 5/ # last\nfo 1 2 3\nl 1 2\n"),
              "f 1/2/3 2//4 -1/-2 5/\nf 1 2 3\nl 1 2\n");
    EXPECT_EQ(plain_obj_text("f 1 2 \\\n 3 \\\r\n4\nusemtl a # b\no x\n# all\n"),
              "f 1 2 3 4\nusemtl a # b\no x\n");
}

TEST(ObjSource, LibrariesAreNamesWithBlanksOrSeveral) {
    const auto names = [](const std::string& line) { return plain_obj(line, "m.obj").libraries; };
    EXPECT_THAT(names("mtllib a.mtl\nmtllib b.MTL\n"), ElementsAre("a.mtl", "b.MTL"));
    EXPECT_THAT(names("mtllib a.mtl b.mtl\tc.mtl"), ElementsAre("a.mtl", "b.mtl", "c.mtl"));
    EXPECT_THAT(names("mtllib my own.mtl  other one.mtl"), ElementsAre("my own.mtl", "other one.mtl"));
    EXPECT_THAT(names("mtllib \"my own.mtl\" b.mtl"), ElementsAre("my own.mtl", "b.mtl"));
    EXPECT_THAT(names("mtllib materials"), ElementsAre("materials"));
    EXPECT_THAT(names("mtllib"), IsEmpty());
    EXPECT_THAT(plain_obj_text("mtllib a.mtl\nv 0 0 0"), "v 0 0 0\n");
}

TEST(ObjSource, WhatAssimpWouldDropIsRefusedWithItsLine) {
    const auto why = [](const std::string& obj) {
        try {
            plain_obj(obj, "m.obj");
        } catch (const InputError& error) {
            return std::string(error.what());
        }
        return std::string("nothing");
    };
    EXPECT_EQ(why("v 0 0 0\n\nv 1 2\n"), "m.obj:3: found 'v 1 2'; accepted: 3 numbers or more");
    EXPECT_EQ(why("v 0 0 0\r\n\r\nvt # 1\r\n"), "m.obj:3: found 'vt # 1'; accepted: 1 numbers or more");
    const std::string corners =
        "; accepted: corners v, v/vt, v//vn or v/vt/vn, counted from 1, or from -1 back";
    for (const char* line :
         {"f 0 1 2", "f 1.0 2 3", "f a b c", "f /1 2 3", "f 1/2/3/4 1 2", "f 12345678901 1 2"}) {
        const std::string said = why("v 0 0 0\n" + std::string(line));
        EXPECT_THAT(said, HasSubstr("m.obj:2: found '" + std::string(line))) << line;
        EXPECT_THAT(said, HasSubstr(corners)) << line;
    }
    EXPECT_THAT(why(std::string("v\0 \0", 4)), HasSubstr("m.obj: found a text of wide letters"));
}

class ObjFiles : public FilesTest {
  protected:
    const std::string quad_ = "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 0 1 0\n";
    Vec3f color_of(const std::string& obj) {
        const Mesh mesh = load_mesh(write("m.obj", obj));
        return mesh.surfaces[mesh.surface_of_triangle[0]].base_color;
    }
};

TEST_F(ObjFiles, EveryDialectIsTheSameQuad) {
    for (const std::string& text :
         {quad_ + "f 1 2 3 4\n", "\xEF\xBB\xBF" + quad_ + "f 1 2 3 4\n",
          "  " + quad_ + "  f 01 02 03 04 # all\n", quad_ + "f -4 -3 -2 -1\n", quad_ + "f 1 2 \\\n3 4",
          std::string("v .0 .0 .0\nv 2 0 0 1 1 1 1\nv 2 1 0\nv 0 1D0 0\nf 1 2 3 4\n")}) {
        std::string carriage = text;
        std::replace(carriage.begin(), carriage.end(), '\n', '\r');
        for (const std::string& obj : {text, carriage}) {
            const Mesh mesh = load_mesh(write("m.obj", obj));
            ASSERT_EQ(mesh.triangles.size(), 2u) << obj;
            Vec3f most;
            for (const auto& t : mesh.triangles)
                for (const std::uint32_t i : t)
                    most = {std::max(most.x, mesh.vertices_m[i].x), std::max(most.y, mesh.vertices_m[i].y),
                            std::max(most.z, mesh.vertices_m[i].z)};
            EXPECT_EQ(most, (Vec3f{2, 1, 0})) << obj;
        }
    }
}

TEST_F(ObjFiles, MaterialsComeFromEveryLibrary) {
    write("a.mtl", "newmtl a\nKd 0.1 0.1 0.1");
    write("my own.mtl", "\xEF\xBB\xBFnewmtl b\r\n\tKd 0.2 0.2 0.2\r\n");
    EXPECT_EQ(color_of("mtllib a.mtl my own.mtl\n" + quad_ + "usemtl a\nf 1 2 3\n").x, 0.1f);
    EXPECT_EQ(color_of("mtllib a.mtl my own.mtl\n" + quad_ + "usemtl b\nf 1 2 3\n").x, 0.2f);
    EXPECT_EQ(color_of("mtllib a.mtl\nmtllib my own.mtl\n" + quad_ + "usemtl b\nf 1 2 3\n").x, 0.2f);
    EXPECT_EQ(color_of("mtllib A.MTL\n" + quad_ + "usemtl a\nf 1 2 3\n").x, 0.1f);
}

TEST_F(ObjFiles, LibrariesThatAreNotThereAreNamed) {
    write("a.mtl", "newmtl a\n");
    const MeshContents some =
        load_mesh_contents(write("m.obj", "mtllib a.mtl gone.mtl\n" + quad_ + "usemtl a\nf 1 2 3\n"));
    EXPECT_THAT(some.missing_materials, ElementsAre("gone.mtl"));
    EXPECT_THAT(some.remarks, IsEmpty());
    // One of the mesh's own name stands for those that are not there.
    write("m.mtl", "newmtl a\n");
    const MeshContents own =
        load_mesh_contents(write("m.obj", "mtllib gone.mtl\n" + quad_ + "usemtl a\nf 1 2 3\n"));
    EXPECT_THAT(own.missing_materials, IsEmpty());
    EXPECT_THAT(own.remarks, ElementsAre("materials 'gone.mtl': no file of that name; taken: 'm.mtl'"));
}

}  // namespace
}  // namespace hilcam
