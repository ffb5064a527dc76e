// What files of meshes say of how their surfaces look, and what is made of it: the row of pixels through the middle of a quad that is
// lit from the front, and what is left out.
#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <functional>

#include "io/images/picture_codecs.h"
#include "io/meshes/mesh_file.h"
#include "render/vocabulary/units.h"
#include "tests/support/files.h"
#include "tests/support/gltf_writer.h"
#include "tests/support/stage.h"

namespace hilcam {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using Json = GltfWriter::Json;

constexpr std::array<std::uint8_t, 3> kDark = {20, 20, 20}, kBright = {230, 230, 230};

double seen_area_m2(
    const Mesh& mesh, std::function<bool(const MeshSurface&)> has = [](const MeshSurface&) { return true; }) {
    double sum = 0;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
        if (has(mesh.surfaces[mesh.surface_of_triangle[i]]))
            sum += length(area_vector(mesh, mesh.triangles[i]));
    return sum;
}

// Radiance of the quad in the middle of each of its parts from left to right, over that of a white Lambert surface there.
std::vector<float> row_of(Mesh mesh, std::size_t parts, Vec2f middle = {0, 0}, bool kept = false,
                          int depth = 1) {
    Stage stage;
    stage.camera(64, 0.5);
    stage.quality.max_depth = depth;
    if (kept) stage.quality.path_model = "cached";
    SceneObject object;
    for (const MeshSurface& surface : mesh.surfaces)
        object.materials.push_back(make_material(surface, stage.grid));
    object.mesh = std::move(mesh);
    // The camera looks along +z with y down: a half turn about x faces the quad to it, upright.
    stage.add(std::move(object), {-static_cast<double>(middle.x), static_cast<double>(middle.y), 4});
    stage.render();
    std::vector<float> out;
    const double px_m = stage.geometry.focal_length_px / 4;
    for (std::size_t i = 0; i < parts; ++i) {
        const double x_m = -1 + (2.0 * static_cast<double>(i) + 1) / static_cast<double>(parts) -
                           static_cast<double>(middle.x);
        const auto column = static_cast<std::size_t>(std::floor(32 + x_m * px_m));
        out.push_back(stage.radiance.row(32)[column] * kPiF / kSun_w_m2_um);
    }
    return out;
}

class MeshLooks : public FilesTest {
  protected:
    Mesh load(GltfWriter& file) { return load_mesh(write("m.gltf", file.text())); }
    // A quad with a picture, and a material that has it for its colours.
    static GltfWriter pictured(int wrap, Json texture, std::vector<float> uvs = {0, 1, 1, 1, 1, 0, 0, 0}) {
        GltfWriter file;
        Json quad = file.quad();
        quad["attributes"]["TEXCOORD_0"] = file.floats(uvs, 2);
        quad["attributes"]["TEXCOORD_1"] = file.floats({0, 1, 1, 1, 1, 0, 0, 0}, 2);
        quad["material"] = 0;
        file.show(quad);
        file.picture(half_picture(kDark, kBright), wrap);
        texture["index"] = 0;
        file.root["materials"] = {
            {{"name", "m"},
             {"pbrMetallicRoughness", {{"baseColorTexture", texture}, {"metallicFactor", 0}}}}};
        return file;
    }
    static GltfWriter plain(const Json& material) {
        GltfWriter file;
        Json quad = file.quad();
        quad["material"] = 0;
        file.show(quad);
        file.root["materials"] = {material};
        return file;
    }
};

// sRGB 20 is 0.007, sRGB 230 is 0.791 (IEC 61966-2-1). The clear layer adds 0.04 and takes as much of what is below.
void expect_dark_or_bright(const std::vector<float>& row, const std::string& words) {
    ASSERT_EQ(row.size(), words.size());
    for (std::size_t i = 0; i < row.size(); ++i)
        EXPECT_NEAR(row[i], words[i] == 'b' ? 0.78f : 0.02f, words[i] == 'b' ? 0.06f : 0.015f)
            << words << " " << i;
}

TEST_F(MeshLooks, ATextureLiesAsKhrTextureTransformMovesIt) {
    GltfWriter plain = pictured(10497, {});
    expect_dark_or_bright(row_of(load(plain), 4), "ddbb");
    GltfWriter moved = pictured(10497, {{"extensions", {{"KHR_texture_transform", {{"offset", {0.5, 0}}}}}}});
    expect_dark_or_bright(row_of(load(moved), 4), "bbdd");
    GltfWriter scaled = pictured(10497, {{"extensions", {{"KHR_texture_transform", {{"scale", {2, 1}}}}}}});
    expect_dark_or_bright(row_of(load(scaled), 4), "dbdb");
    // A quarter turn counterclockwise of the places, seen in the picture's axes: the upper half of the quad (v < 0.5) takes u = v.
    GltfWriter turned =
        pictured(10497, {{"extensions", {{"KHR_texture_transform", {{"rotation", kPi / 2}}}}}});
    const Mesh mesh = load(turned);
    EXPECT_NEAR(mesh.uvs[0].x, 1, 1e-6);  // (0, 1)
    EXPECT_NEAR(mesh.uvs[1].x, 1, 1e-6);  // (1, 1)
    EXPECT_NEAR(mesh.uvs[1].y, -1, 1e-6);
    // The extension may choose the set, too.
    GltfWriter chosen = pictured(10497, {{"extensions", {{"KHR_texture_transform", {{"texCoord", 1}}}}}},
                                 std::vector<float>(8, 0.1f));
    expect_dark_or_bright(row_of(load(chosen), 4), "ddbb");
}

TEST_F(MeshLooks, ATextureTakesTheSetOfPlacesThatItNames) {
    GltfWriter file = pictured(10497, {{"texCoord", 1}}, std::vector<float>(8, 0.1f));
    expect_dark_or_bright(row_of(load(file), 4), "ddbb");
    GltfWriter missing = pictured(10497, {{"texCoord", 4}});
    EXPECT_THAT(load(missing).left_out, ElementsAre(HasSubstr("TEXCOORD_4")));
}

// Three pictures side by side.
TEST_F(MeshLooks, ATextureGoesOnBeyondItsEdgeAsItsSamplerSays) {
    const std::vector<float> uvs = {-1, 1, 2, 1, 2, 0, -1, 0};
    GltfWriter repeat = pictured(10497, {}, uvs), clamp = pictured(33071, {}, uvs),
               mirror = pictured(33648, {}, uvs);
    expect_dark_or_bright(row_of(load(repeat), 6), "dbdbdb");
    expect_dark_or_bright(row_of(load(clamp), 6), "dddbbb");
    expect_dark_or_bright(row_of(load(mirror), 6), "bddbbd");
    // At the edges nothing of the other edge shines through; between two texels of four pixels each colours go over.
    GltfWriter edge = pictured(33071, {});
    const std::vector<float> row = row_of(load(edge), 32);
    expect_dark_or_bright({row.begin(), row.begin() + 13}, std::string(13, 'd'));
    expect_dark_or_bright({row.begin() + 19, row.end()}, std::string(13, 'b'));
}

// The first row of a picture is its top: at v = 0 of glTF, at v = 1 of an OBJ.
TEST_F(MeshLooks, ATextureStandsUpright) {
    std::vector<std::uint8_t> rgb(3 * 64, 230);
    std::fill(rgb.begin() + 96, rgb.end(), std::uint8_t{20});
    const std::string png = encode_png({rgb, 8, 8, SampleKind::kRgb8});
    GltfWriter file = pictured(10497, {});
    file.picture(png);
    write("upright.png", png);
    write("m.mtl", "newmtl m\nKd 1 1 1\nmap_Kd upright.png\n");
    const Mesh obj =
        load_mesh(write("m.obj",
                        "mtllib m.mtl\nusemtl m\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nvt 0 0\nvt 1 0\n"
                        "vt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n"));
    for (const Mesh& mesh : {load(file), obj}) {
        expect_dark_or_bright(row_of(mesh, 4, {0, 0.5f}), "bbbb");
        expect_dark_or_bright(row_of(mesh, 4, {0, -0.5f}), "dddd");
    }
}

// glTF 2.0, section 3.9.2: colours at corners are linear factors; so are an OBJ's. Those of a PLY in whole numbers are a picture's.
TEST_F(MeshLooks, ColoursAtCornersScaleTheSurface) {
    GltfWriter file = plain({{"pbrMetallicRoughness", {{"metallicFactor", 0}}}});
    Json& quad = file.root["meshes"][0]["primitives"][0];
    quad["attributes"]["COLOR_0"] =
        file.floats({0.1f, 0.1f, 0.1f, 0.9f, 0.9f, 0.9f, 0.9f, 0.9f, 0.9f, 0.1f, 0.1f, 0.1f}, 3);
    const Mesh obj = load_mesh(write("m.obj",
                                     "v -1 -1 0 0.1 0.1 0.1\nv 1 -1 0 0.9 0.9 0.9\nv 1 1 0 0.9 0.9 0.9\n"
                                     "v -1 1 0 0.1 0.1 0.1\nf 1 2 3 4\n"));
    const Mesh mesh = load(file);
    for (const Mesh& colored : {mesh, obj}) {
        EXPECT_FLOAT_EQ(colored.surfaces[colored.surface_of_triangle[0]].base_color.x, 1);
        const std::vector<float> row = row_of(colored, 8), kept = row_of(colored, 8, {0, 0}, true);
        for (std::size_t i = 0; i < 8; ++i) {
            // Linear between the corners, below a clear layer.
            const float share = 0.1f + 0.8f * (static_cast<float>(i) + 0.5f) / 8;
            EXPECT_NEAR(row[i], share, 0.05f) << i;
            EXPECT_NEAR(kept[i], row[i], 0.01f) << i;
        }
    }
    const char* const head =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
    const char* const tail = "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
    const std::string whole = "property uchar red\nproperty uchar green\nproperty uchar blue\n",
                      floats = "property float red\nproperty float green\nproperty float blue\n";
    const Mesh bytes = load_mesh(
        write("b.ply", head + whole + tail + "0 0 0 230 20 0\n1 0 0 230 20 0\n0 1 0 230 20 0\n3 0 1 2\n"));
    EXPECT_NEAR(bytes.colors[0].x, 0.791f, 0.001f);
    EXPECT_NEAR(bytes.colors[0].y, 0.007f, 0.0005f);
    EXPECT_FLOAT_EQ(bytes.surfaces[0].base_color.x, 1);
    const Mesh linear = load_mesh(write(
        "f.ply", head + floats + tail + "0 0 0 0.5 0.25 0\n1 0 0 0.5 0.25 0\n0 1 0 0.5 0.25 0\n3 0 1 2\n"));
    EXPECT_FLOAT_EQ(linear.colors[0].x, 0.5f);
    EXPECT_FLOAT_EQ(linear.colors[0].y, 0.25f);
    // White ones say nothing, and what has none stays as it was.
    quad["attributes"]["COLOR_0"] = file.floats(std::vector<float>(16, 1), 4);
    EXPECT_THAT(load(file).colors, IsEmpty());
}

// A metal's colours are its facets'.
TEST_F(MeshLooks, ColoursAtCornersScaleMetalToo) {
    GltfWriter file = plain({{"pbrMetallicRoughness", {{"roughnessFactor", 1}}}});
    const std::vector<float> white = row_of(load(file), 1);
    file.root["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] =
        file.floats(std::vector<float>(12, 0.5f), 3);
    const std::vector<float> half = row_of(load(file), 1);
    EXPECT_NEAR(half[0], 0.5f * white[0], 0.02f * white[0]);
}

// A picture with alpha: its left half is there. What a mask leaves open is a hole, in every kind of light.
TEST_F(MeshLooks, AMaskCutsHoles) {
    std::vector<std::uint8_t> rgba;
    for (int i = 0; i < 64; ++i)
        for (const int v : {230, 230, 230, i % 8 < 4 ? 255 : 0}) rgba.push_back(static_cast<std::uint8_t>(v));
    GltfWriter file = pictured(33071, {});
    file.picture(png_with_alpha(rgba, 8), 33071);
    file.root["materials"][0]["alphaMode"] = "MASK";
    const Mesh mesh = load(file);
    EXPECT_NEAR(seen_area_m2(mesh), 2, 1e-5);
    EXPECT_THAT(mesh.left_out, IsEmpty());
    const std::vector<float> row = row_of(mesh, 4);
    EXPECT_NEAR(row[0], 0.78f, 0.06f);
    EXPECT_NEAR(row[1], 0.78f, 0.06f);
    EXPECT_EQ(row[2], 0);
    EXPECT_EQ(row[3], 0);
    // Repeated five times, with a step of its own in each; the factor counts, too.
    GltfWriter many = file;
    many.root["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["extensions"] = {
        {"KHR_texture_transform", {{"scale", {5, 5}}}}};
    many.root["samplers"][0] = {{"magFilter", 9728}};
    EXPECT_NEAR(seen_area_m2(load(many)), 2, 1e-4);
    many.root["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = {1, 1, 1, 0.4};
    EXPECT_THAT(error_of([&] { load(many); }), HasSubstr("holds no triangle that its masks leave"));
    file.root["materials"][0]["alphaMode"] = "OPAQUE";
    EXPECT_NEAR(seen_area_m2(load(file)), 4, 1e-5);
}

// A disk of alpha on a smooth slope: its area is that of the circle, and its border none of the texels' staircase.
TEST_F(MeshLooks, AMaskOfFewTexelsHasASmoothBorder) {
    constexpr int kSize = 32;
    std::vector<std::uint8_t> rgba;
    for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x) {
            const double away = std::hypot(x + 0.5 - kSize / 2.0, y + 0.5 - kSize / 2.0);
            const int alpha = static_cast<int>(std::clamp(127.5 + 40 * (10 - away), 0.0, 255.0));
            for (const int v : {255, 255, 255, alpha}) rgba.push_back(static_cast<std::uint8_t>(v));
        }
    GltfWriter file = pictured(33071, {});
    file.picture(png_with_alpha(rgba, kSize), 33071);
    file.root["samplers"][0].erase("magFilter");
    file.root["materials"][0]["alphaMode"] = "MASK";
    const double radius_m = 10 * 2.0 / kSize;
    EXPECT_NEAR(seen_area_m2(load(file)), kPi * radius_m * radius_m, 0.01 * kPi * radius_m * radius_m);
}

// Metal to the left, paint to the right, each as rough as the picture says (glTF 2.0, section 5.22.5: green and blue).
TEST_F(MeshLooks, AMetallicRoughnessTextureMakesSurfacesOfItsKinds) {
    GltfWriter file = pictured(10497, {});
    file.picture(half_picture({0, 40, 255}, {0, 255, 0}));
    file.root["materials"][0]["pbrMetallicRoughness"] = {{"metallicRoughnessTexture", {{"index", 0}}}};
    const Mesh mesh = load(file);
    EXPECT_NEAR(seen_area_m2(mesh,
                             [](const MeshSurface& s) {
                                 return s.metallic == 1 && std::abs(s.roughness - 40 / 255.0f) < 0.01f;
                             }),
                2, 1e-5);
    EXPECT_NEAR(seen_area_m2(mesh, [](const MeshSurface& s) { return s.metallic == 0 && s.roughness == 1; }),
                2, 1e-5);
    for (const Vec3f v : mesh.vertices_m)
        EXPECT_FALSE(std::abs(v.x) > 1e-5f && std::abs(v.x) < 1 - 1e-5f) << v.x;
    // One that lies otherwise than the colours is left out by name.
    file.root["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}, {"texCoord", 1}};
    EXPECT_THAT(load(file).left_out,
                ElementsAre(HasSubstr("metallic-roughness texture, which lies otherwise")));
    EXPECT_EQ(load(file).triangles.size(), 2u);
}

TEST_F(MeshLooks, SpecularGlossinessIsTakenForItsDiffuseBody) {
    GltfWriter file = plain({{"extensions",
                              {{"KHR_materials_pbrSpecularGlossiness",
                                {{"diffuseFactor", {0.2, 0.2, 0.2, 1}},
                                 {"specularFactor", {0, 0, 0}},
                                 {"glossinessFactor", 0}}}}}});
    const Mesh mesh = load(file);
    EXPECT_FLOAT_EQ(mesh.surfaces[0].metallic, 0);
    EXPECT_FLOAT_EQ(mesh.surfaces[0].refractive_index, 1);
    EXPECT_NEAR(row_of(mesh, 1)[0], 0.2f, 0.005f);
    Json& sheen = file.root["materials"][0]["extensions"]["KHR_materials_pbrSpecularGlossiness"];
    sheen["diffuseFactor"] = {0, 0, 0, 1}, sheen["specularFactor"] = {0.9, 0.6, 0.3};
    EXPECT_FLOAT_EQ(load(file).surfaces[0].metallic, 1);
    EXPECT_FLOAT_EQ(load(file).surfaces[0].base_color.y, 0.6f);
    // 0.04 is the reflectance of index 1.5.
    sheen["diffuseFactor"] = {0.5, 0.5, 0.5, 1}, sheen["specularFactor"] = {0.04, 0.04, 0.04};
    EXPECT_NEAR(load(file).surfaces[0].refractive_index, 1.5f, 1e-5f);
}

// Alpha is coverage: a share of what the surface would be, and the rest of what lies behind it. An OBJ's 0 means "opaque" to many.
TEST_F(MeshLooks, AlphaIsCoverage) {
    write("m.mtl",
          "newmtl pane\nKd 0.8 0.8 0.8\nd 0.2\nnewmtl turned\nKd 0.8 0.8 0.8\nTr 0.8\nnewmtl old\nKd 0.8 0.8 "
          "0.8\nd 0\n");
    const auto obj = [&](const std::string& material) {
        return load_mesh(write("m.obj", "mtllib m.mtl\nusemtl " + material +
                                            "\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nf 1 2 3 4\n"));
    };
    EXPECT_NEAR(row_of(obj("pane"), 1)[0], 0.16f, 0.002f);
    EXPECT_THAT(obj("pane").left_out, IsEmpty());
    EXPECT_NEAR(row_of(obj("turned"), 1)[0], 0.16f, 0.002f);
    EXPECT_NEAR(row_of(obj("old"), 1)[0], 0.8f, 0.05f);
    EXPECT_THAT(obj("old").left_out,
                ElementsAre("dissolve 0, which is taken for opaque, of 'old': not used"));
    GltfWriter file =
        plain({{"alphaMode", "BLEND"}, {"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, 0.3}}}}});
    EXPECT_NEAR(row_of(load(file), 1)[0], 0.3f, 0.002f);
    // What lies behind it is seen through what it leaves, twice a third of it: once for the Sun, once for the eye.
    file.root["meshes"].push_back(file.root["meshes"][0]);
    file.root["meshes"][1]["primitives"][0]["material"] = 1;
    file.root["materials"].push_back({{"pbrMetallicRoughness", {{"metallicFactor", 0}}}});
    file.root["nodes"].push_back({{"mesh", 1}, {"translation", {0, 0, -0.1}}});
    file.root["scenes"][0]["nodes"] = {0, 1};
    EXPECT_NEAR(row_of(load(file), 1, {0, 0}, false, 2)[0], 0.3f + 0.7f * 0.7f, 0.03f);
    file.root["materials"][0] = {
        {"extensions", {{"KHR_materials_transmission", {{"transmissionFactor", 0.9}}}}}};
    const SpectralGrid grid({0.5, 0.6});
    const Material glass = make_material(load(file).surfaces[0], grid);
    EXPECT_TRUE(glass.transmits() && glass.brdf.index() == kModel<brdf::Glass>);
}

// map_Kd's options (MTL): a place is scaled by -s and moved by -o; -clamp on lets the edge go on.
TEST_F(MeshLooks, OptionsOfAnObjsMapAreTaken) {
    write("half.png", half_picture(kDark, kBright));
    const auto row = [&](const std::string& options, const char* right = "1") {
        write("m.mtl", "newmtl m\nKd 1 1 1\nmap_Kd " + options + " half.png\n");
        const std::string r = right;
        return row_of(
            load_mesh(
                write("m.obj", "mtllib m.mtl\nusemtl m\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nvt 0 0\nvt " +
                                   r + " 0\nvt " + r + " 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n")),
            4);
    };
    expect_dark_or_bright(row(""), "ddbb");
    expect_dark_or_bright(row("-s 2 1 1"), "dbdb");
    expect_dark_or_bright(row("-o 0.5"), "bbdd");
    expect_dark_or_bright(row("-s 2 1 1 -o 0.5 0 0"), "bdbd");
    expect_dark_or_bright(row("-clamp off", "2"), "dbdb");
    expect_dark_or_bright(row("-clamp on", "2"), "dbbb");
}

TEST_F(MeshLooks, WhatIsNotTakenIsNamed) {
    GltfWriter file = pictured(10497, {});
    Json& material = file.root["materials"][0];
    material["name"] = "lamp";
    material["emissiveFactor"] = {1, 1, 1};
    material["normalTexture"] = {{"index", 0}};
    material["extensions"] = {{"KHR_materials_clearcoat", {{"clearcoatFactor", 1}}}};
    file.root["animations"] = {{{"channels", Json::array()}}};
    EXPECT_THAT(load(file).left_out,
                ElementsAre("KHR_materials_clearcoat of 'lamp': not used",
                            "animation (the mesh is at rest): not used", "emission of 'lamp': not used",
                            "normal map of 'lamp': not used"));
    write("m.mtl", "newmtl lamp\nKd 1 1 1\nKe 1 1 1\nmap_Bump b.png\n");
    EXPECT_THAT(
        load_mesh(write("m.obj", "mtllib m.mtl\nusemtl lamp\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")).left_out,
        ElementsAre("bump map of 'lamp': not used", "emission of 'lamp': not used"));
}

}  // namespace
}  // namespace hilcam
