#include "emulator/check/mesh_survey.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "tests/support/files.h"

namespace hilcam {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

// A cube of one metre; its corners count x, y, z by bits 0, 1, 2.
constexpr const char* kCorners = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 0 0 1\nv 1 0 1\nv 0 1 1\nv 1 1 1\n";
constexpr const char* kFaces =
    "f 1 3 4\nf 1 4 2\nf 5 6 8\nf 5 8 7\nf 1 2 6\nf 1 6 5\nf 3 7 8\nf 3 8 4\nf 1 5 7\nf 1 7 3\n";
constexpr const char* kLast = "f 2 4 8\nf 2 8 6\n";

class MeshSurveyTest : public FilesTest {
  protected:
    MeshSurvey survey(const std::string& obj, const std::string& name = "mesh.obj") {
        const auto file = write(name, obj);
        return survey_mesh(load_mesh_contents(file), file.string());
    }
    std::vector<std::string> problems(const std::string& obj) { return problems_of(survey(obj)); }
};

TEST_F(MeshSurveyTest, ACubeIsWhatItIs) {
    write("box.mtl", "newmtl gold\n");
    const MeshSurvey s = survey(std::string("mtllib box.mtl\n") + kCorners + "o box\nusemtl gold\n" + kFaces +
                                "usemtl white\n" + kLast);
    EXPECT_EQ(s.triangles, 12u);
    EXPECT_EQ(s.places, 8u);
    EXPECT_EQ(s.shells, 1u);
    EXPECT_EQ(s.max_m.x - s.min_m.x, 1);
    double area_m2 = 0;
    for (const SurveyedSurface& surface : s.surfaces) area_m2 += surface.area_m2;
    EXPECT_NEAR(area_m2, 6, 1e-12);
    std::uint64_t triangles = 0;
    for (const MeshNode& node : s.nodes) triangles += node.triangles;
    EXPECT_EQ(triangles, 12u);
    EXPECT_THAT(problems_of(s), IsEmpty());
    EXPECT_THAT(to_text(s), HasSubstr("size       1 x 1 x 1 m: x 0 to 1, y 0 to 1, z 0 to 1\n"
                                      "triangles  12 in 1 shells; "));
    EXPECT_THAT(to_text(s), HasSubstr("problems: none\n"));
    EXPECT_THAT(to_text(s), HasSubstr("'box'"));
}

TEST_F(MeshSurveyTest, LooksThatAreNotTakenAreNamed) {
    write("lamp.mtl", "newmtl lamp\nKd 1 1 1\nKe 5 5 5\n");
    EXPECT_THAT(problems(std::string("mtllib lamp.mtl\n") + kCorners + "usemtl lamp\n" + kFaces + kLast),
                ElementsAre("emission of 'lamp': not used"));
}

TEST_F(MeshSurveyTest, ASurfaceThatNothingHasIsNotListed) {
    // The importer adds a 'DefaultMaterial' to each OBJ.
    write("gold.mtl", "newmtl gold\n");
    const MeshSurvey s =
        survey(std::string("mtllib gold.mtl\n") + kCorners + "usemtl gold\n" + kFaces + kLast);
    ASSERT_EQ(s.surfaces.size(), 1u);
    EXPECT_EQ(s.surfaces[0].name, "gold");
    EXPECT_EQ(s.surfaces[0].triangles, 12u);
}

TEST_F(MeshSurveyTest, WhatIsWrongIsCounted) {
    const std::string corners = kCorners, faces = kFaces, last = kLast;
    EXPECT_THAT(problems(corners + faces), ElementsAre(HasSubstr("4 open edges: ")));
    // One of the last two is turned over: all of its edges go the way of its neighbours'.
    EXPECT_THAT(problems(corners + faces + "f 2 4 8\nf 2 6 8\n"),
                ElementsAre(HasSubstr("3 inconsistent edges: ")));
    EXPECT_THAT(problems(corners + faces + last + "f 2 4 4\n"),
                ElementsAre(HasSubstr("1 collapsed triangles: ")));
    const std::vector<std::string> twice = problems(corners + faces + last + "f 2 4 8\n");
    EXPECT_THAT(twice, Contains(HasSubstr("1 repeated triangles: ")));
    EXPECT_THAT(twice, Contains(HasSubstr("3 edges of three triangles or more: ")));
    EXPECT_THAT(problems(corners + "v 0.5 0 0\n" + faces + last + "f 1 9 2\n"),
                Contains(HasSubstr("1 slivers: ")));
}

TEST_F(MeshSurveyTest, ACubeThatIsInsideOut) {
    // The same triangles with two corners exchanged.
    const std::string obj = std::string(kCorners) +
                            "f 1 4 3\nf 1 2 4\nf 5 8 6\nf 5 7 8\nf 1 6 2\nf 1 5 6\nf 3 8 7\nf 3 4 8\nf 1 7 "
                            "5\nf 1 3 7\nf 2 8 4\nf 2 6 8\n";
    EXPECT_THAT(problems(obj), ElementsAre(HasSubstr("1 inverted shells: ")));
    // The order of the corners is opposed to normals that look outwards.
    const std::string with_normals =
        std::string(kCorners) + "vn -1 0 0\nvn 1 0 0\n" +
        "f 1//1 7//1 5//1\nf 1//1 3//1 7//1\nf 2//2 8//2 4//2\nf 2//2 6//2 8//2\n";
    EXPECT_THAT(problems(with_normals), Contains(HasSubstr("4 triangles with opposed normals: ")));
}

TEST_F(MeshSurveyTest, MillimetresAreTold) {
    const MeshSurvey s = survey("v 0 0 0\nv 3000 0 0\nv 0 2000 0\nf 1 2 3\n");
    EXPECT_TRUE(s.probably_mm);
    EXPECT_THAT(problems_of(s).front(), HasSubstr("probably in millimetres"));
    const nlohmann::json json = nlohmann::json::parse(to_json(s));
    EXPECT_EQ(json["size_m"].dump(), "[3000.0,2000.0,0.0]");
    EXPECT_EQ(json["open_edges"].get<int>(), 3);
    EXPECT_EQ(json["problems"].size(), 2u);
}

TEST_F(MeshSurveyTest, AMissingFileOfMaterialsIsTold) {
    const std::string cube = std::string(kCorners) + "usemtl gold\n" + kFaces + kLast;
    EXPECT_THAT(problems("mtllib none.mtl\n" + cube),
                ElementsAre("no file 'none.mtl': surfaces with its materials are grey"));
    EXPECT_THAT(problems("mtllib none.mtl\no box\n" + cube + "o other\nusemtl white\nf 1 2 3\n"),
                Contains("no file 'none.mtl': surfaces with its materials are grey").Times(1));
    EXPECT_THAT(problems(cube), IsEmpty());
    // The file of the mesh's own name is taken then, as other programs do.
    write("mesh.mtl", "newmtl gold\n");
    EXPECT_THAT(problems("mtllib none.mtl\n" + cube),
                ElementsAre("materials 'none.mtl': no file of that name; taken: 'mesh.mtl'"));
}

TEST_F(MeshSurveyTest, TexturesThatCannotBeReadAreToldBesideTheRest) {
    write("t.mtl", "newmtl a\nmap_Kd gone.png\nnewmtl b\nmap_Kd t.mtl\n");
    const MeshSurvey s =
        survey(std::string("mtllib t.mtl\n") + kCorners + "usemtl a\n" + kFaces + "usemtl b\n" + kLast);
    EXPECT_EQ(s.triangles, 12u);
    EXPECT_THAT(problems_of(s), ElementsAre(HasSubstr("texture 'gone.png' of material 'a' is missing"),
                                            HasSubstr("texture 't.mtl' of material 'b' does not decode")));
    EXPECT_EQ(nlohmann::json::parse(to_json(s))["unreadable_textures"].size(), 2u);
}

TEST_F(MeshSurveyTest, NormalsOfAnStlThatAreNotThoseOfItsCornersAreTold) {
    const auto stl = [](const std::string& normal) {
        return "solid s\nfacet normal " + normal +
               "\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid s\n";
    };
    EXPECT_THAT(problems_of(survey(stl("0 0 1"), "m.stl")), ElementsAre(HasSubstr("open edges")));
    EXPECT_THAT(problems_of(survey(stl("0 0 -1"), "m.stl")),
                Contains(HasSubstr("1 triangles with opposed normals: ")));
    EXPECT_THAT(problems_of(survey(stl("1 0 0"), "m.stl")),
                Contains(HasSubstr("1 facets with tilted normals: ")));
    EXPECT_FALSE(survey(stl("0 0 1"), "m.stl").has_normals);
}

// Single precision has steps of 0.5 m there: of a plate of ten metres little is left.
TEST_F(MeshSurveyTest, AMeshFarFromItsOriginIsTold) {
    EXPECT_THAT(problems("v 4200000 0 0\nv 4200010 0 0\nv 4200000 10 0\nf 1 2 3\n"),
                Contains(HasSubstr(
                    "so far from its origin that single precision moves its vertices by up to 0.5 m")));
    EXPECT_THAT(problems("v 1000 0 0\nv 1010 0 0\nv 1000 10 0\nf 1 2 3\n"),
                ElementsAre(HasSubstr("open edges")));
}

TEST_F(MeshSurveyTest, AFileThatIsNoMeshIsRefused) {
    EXPECT_THAT(error_of([&] { load_mesh_contents(write("x.txt", "")); }),
                HasSubstr("accepted: .glb .gltf .obj"));
    EXPECT_THAT(error_of([&] { load_mesh_contents(folder_ / "none.obj"); }), HasSubstr("no such mesh file"));
    EXPECT_THAT(error_of([&] { load_mesh_contents(write("e.obj", "v 0 0 0\nv 1 0 0\nl 1 2\n")); }),
                HasSubstr("e.obj: does not parse"));
}

}  // namespace
}  // namespace hilcam
