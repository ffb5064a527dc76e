// What the reader of glTF makes of each way in which a file can say where its triangles are. Most of these are own, smallest forms of
// Khronos' sample assets of the same name.
#include <draco/attributes/point_attribute.h>
#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <gmock/gmock.h>
#include <meshoptimizer.h>

#include <array>
#include <cmath>
#include <cstdlib>

#include "io/meshes/data_uri.h"
#include "io/meshes/mesh_file.h"
#include "tests/support/files.h"
#include "tests/support/gltf_writer.h"

namespace hilcam {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using Json = GltfWriter::Json;

double area_m2(const Mesh& mesh) {
    double sum = 0;
    for (const auto& t : mesh.triangles) sum += length(area_vector(mesh, t));
    return sum;
}

// Least and greatest coordinates.
std::array<Vec3f, 2> box_m(const Mesh& mesh) {
    std::array<Vec3f, 2> box{mesh.vertices_m[0], mesh.vertices_m[0]};
    for (const Vec3f v : mesh.vertices_m) {
        box[0] = {std::min(box[0].x, v.x), std::min(box[0].y, v.y), std::min(box[0].z, v.z)};
        box[1] = {std::max(box[1].x, v.x), std::max(box[1].y, v.y), std::max(box[1].z, v.z)};
    }
    return box;
}

class GltfFile : public FilesTest {
  protected:
    Mesh load(GltfWriter& file) { return load_mesh(write("m.gltf", file.text())); }
    std::string error(GltfWriter& file) {
        return error_of([&] { load(file); });
    }
};

// glTF 2.0, section 3.12: a reader that does not know it must fail.
TEST_F(GltfFile, ARequiredExtensionThatIsNotKnownIsRefusedByName) {
    GltfWriter file;
    file.show(file.quad());
    file.root["extensionsUsed"] = file.root["extensionsRequired"] = {"KHR_texture_basisu"};
    EXPECT_THAT(error(file), HasSubstr("m.gltf: extensionsRequired: found 'KHR_texture_basisu'; accepted: "));
    file.root.erase("extensionsRequired");
    EXPECT_EQ(load(file).triangles.size(), 2u);
}

TEST_F(GltfFile, ATextureForAnUnknownExtensionAloneIsRefused) {
    GltfWriter file;
    Json quad = file.pictured_quad();
    quad["material"] = 0;
    file.show(quad);
    file.picture(half_picture({0, 0, 0}, {9, 9, 9}));
    file.root["textures"] = {{{"extensions", {{"KHR_texture_basisu", {{"source", 0}}}}}}};
    file.root["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
    EXPECT_THAT(error(file), HasSubstr("textures[0]: found a picture for 'KHR_texture_basisu' alone"));
    // A plain source beside it is what others are to take.
    file.root["textures"][0]["source"] = 0;
    EXPECT_EQ(load(file).textures.size(), 1u);
}

// KHR_mesh_quantization: whole numbers, as fractions of the greatest or as they are, with a stride.
TEST_F(GltfFile, QuantisedPlacesAreNumbersOfTheirType) {
    const std::vector<std::int16_t> corners = {-16384, -16384, 0, 0, 16384,  -16384, 0, 0,
                                               16384,  16384,  0, 0, -16384, 16384,  0, 0};
    for (const bool normalized : {true, false}) {
        GltfWriter file;
        Json quad = file.quad();
        quad["attributes"]["POSITION"] = file.accessor<std::int16_t>(corners, "VEC3", 5122, 4);
        file.root["accessors"].back()["normalized"] = normalized;
        file.root["bufferViews"].back()["byteStride"] = 8;
        file.root["nodes"][0]["scale"] = {2, 2, 2};
        file.root["extensionsRequired"] = {"KHR_mesh_quantization"};
        file.show(quad);
        const float side = 2 * 2 * 16384.0f / (normalized ? 32767 : 1);
        EXPECT_FLOAT_EQ(box_m(load(file))[1].x - box_m(load(file))[0].x, side);
    }
}

// Four instances of a square of 4 m2 at scales 1, 1, 2, 3, and the child of their node, which is no instance.
TEST_F(GltfFile, InstancesArePlacedByTheirOwnPlaceTurnAndScale) {
    GltfWriter file;
    file.show(file.quad());
    const float h = std::sqrt(0.5f);
    const Json attributes = {{"TRANSLATION", file.floats({0, 0, 0, 10, 0, 0, 20, 0, 0, 30, 0, 0}, 3)},
                             {"ROTATION", file.floats({0, 0, 0, 1, 0, h, 0, h, 0, 0, h, h, 0, 0, 0, 1}, 4)},
                             {"SCALE", file.floats({1, 1, 1, 1, 1, 1, 2, 2, 2, 3, 3, 3}, 3)}};
    file.root["nodes"] = {{{"mesh", 0},
                           {"translation", {0, 0, 5}},
                           {"children", {1}},
                           {"extensions", {{"EXT_mesh_gpu_instancing", {{"attributes", attributes}}}}}},
                          {{"mesh", 0}, {"name", "child"}}};
    file.root["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
    const Mesh mesh = load(file);
    EXPECT_EQ(mesh.triangles.size(), 10u);
    EXPECT_NEAR(area_m2(mesh), 4 * (1 + 1 + 4 + 9 + 1), 1e-4);
    const auto box = box_m(mesh);
    EXPECT_NEAR(box[1].x, 33, 1e-5);
    // The one that is turned about y by a right angle stands from z = 4 to 6.
    EXPECT_NEAR(box[0].z, 4, 1e-5);
    EXPECT_NEAR(box[1].z, 6, 1e-5);
    file.root["accessors"].back()["count"] = 3;
    EXPECT_THAT(error(file), HasSubstr("instances with 4 and with 3 values"));
}

TEST_F(GltfFile, HiddenNodesAreLeftOutWithAllBelowThem) {
    GltfWriter file;
    file.show(file.quad());
    const Json hidden = {{"KHR_node_visibility", {{"visible", false}}}};
    file.root["nodes"] = {
        {{"mesh", 0}},
        {{"mesh", 0}, {"translation", {4, 0, 0}}, {"extensions", hidden}, {"children", {2}}},
        {{"mesh", 0}, {"translation", {8, 0, 0}}}};
    file.root["scenes"] = {{{"nodes", {0, 1}}}};
    EXPECT_EQ(load(file).triangles.size(), 2u);
    file.root["nodes"][1].erase("extensions");
    EXPECT_EQ(load(file).triangles.size(), 6u);
}

TEST_F(GltfFile, TheSceneThatTheFileNamesIsShown) {
    GltfWriter file;
    file.show(file.quad());
    file.root["nodes"].push_back({{"mesh", 0}, {"scale", {5, 5, 5}}});
    file.root["scenes"].push_back({{"nodes", {1}}});
    EXPECT_NEAR(area_m2(load(file)), 4, 1e-6);
    file.root["scene"] = 1;
    EXPECT_NEAR(area_m2(load(file)), 100, 1e-4);
}

// Weights of the mesh, and those of a node before them.
TEST_F(GltfFile, MorphTargetsMoveByTheirDefaultWeights) {
    GltfWriter file;
    Json quad = file.quad();
    quad["targets"] = {{{"POSITION", file.floats({0, 0, 0, 2, 0, 0, 2, 0, 0, 0, 0, 0}, 3)}}};
    file.show(quad);
    EXPECT_FLOAT_EQ(box_m(load(file))[1].x, 1);
    file.root["meshes"][0]["weights"] = {0.5};
    EXPECT_FLOAT_EQ(box_m(load(file))[1].x, 2);
    file.root["nodes"][0]["weights"] = {1};
    EXPECT_FLOAT_EQ(box_m(load(file))[1].x, 3);
}

// The node of a skin does not count; half of a vertex' weight takes it half of the way.
TEST_F(GltfFile, SkinsAreWhereTheirJointsAre) {
    GltfWriter file;
    Json quad = file.quad();
    quad["attributes"]["JOINTS_0"] =
        file.accessor<std::uint8_t>({0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0}, "VEC4", 5121, 4);
    quad["attributes"]["WEIGHTS_0"] =
        file.floats({1, 0, 0, 0, 0.5f, 0.5f, 0, 0, 0.5f, 0.5f, 0, 0, 1, 0, 0, 0}, 4);
    std::vector<float> inverse(32);
    for (std::size_t i = 0; i < 2; ++i)
        for (std::size_t k = 0; k < 4; ++k) inverse[16 * i + 5 * k] = 1;
    file.show(quad);
    file.root["skins"] = {{{"joints", {1, 2}}, {"inverseBindMatrices", file.floats(inverse, 16)}}};
    file.root["nodes"] = {{{"mesh", 0}, {"skin", 0}, {"translation", {100, 0, 0}}},
                          {{"translation", {5, 0, 0}}, {"children", {2}}},
                          {{"translation", {4, 0, 0}}}};
    file.root["scenes"] = {{{"nodes", {0, 1}}}};
    const auto box = box_m(load(file));
    EXPECT_FLOAT_EQ(box[0].x, 4);  // -1 + 5
    EXPECT_FLOAT_EQ(box[1].x, 8);  // 1 + (5 + 9) / 2
}

// Zeros but for what the sparse part says.
TEST_F(GltfFile, SparseAccessorsSayTheirValuesApart) {
    GltfWriter file;
    Json quad = file.quad();
    const std::size_t places = file.accessor<std::uint16_t>({1, 2, 3}, "SCALAR", 5123, 1);
    const std::size_t values = file.floats({2, 0, 0, 2, 2, 0, 0, 2, 0}, 3);
    const Json& accessors = file.root["accessors"];
    const Json sparse = {
        {"count", 3},
        {"indices", {{"bufferView", accessors[places]["bufferView"]}, {"componentType", 5123}}},
        {"values", {{"bufferView", accessors[values]["bufferView"]}}}};
    file.root["accessors"].push_back(
        {{"componentType", 5126}, {"type", "VEC3"}, {"count", 4}, {"sparse", sparse}});
    quad["attributes"]["POSITION"] = file.root["accessors"].size() - 1;
    file.show(quad);
    EXPECT_NEAR(area_m2(load(file)), 4, 1e-6);
    EXPECT_FLOAT_EQ(box_m(load(file))[1].x, 2);
    file.root["accessors"].back()["count"] = 3;
    EXPECT_THAT(error(file), HasSubstr("sparse: index 3 is beyond its end"));
}

// All triangles of a strip and of a fan face the same way.
TEST_F(GltfFile, StripsAndFansAreUnrolled) {
    for (const int mode : {5, 6}) {
        GltfWriter file;
        Json quad = file.quad();
        if (mode == 5)
            quad["attributes"]["POSITION"] = file.floats({-1, -1, 0, 1, -1, 0, -1, 1, 0, 1, 1, 0}, 3);
        quad.erase("indices");
        quad["mode"] = mode;
        file.show(quad);
        const Mesh mesh = load(file);
        ASSERT_EQ(mesh.triangles.size(), 2u);
        for (const auto& t : mesh.triangles) EXPECT_NEAR(area_vector(mesh, t).z, 2, 1e-6) << mode;
    }
}

TEST_F(GltfFile, PointsAndLinesAreToldOf) {
    GltfWriter file;
    Json lines = file.quad();
    lines["mode"] = 1;
    file.root["meshes"] = {{{"name", "axes"}, {"primitives", {lines, file.quad()}}}};
    EXPECT_THAT(load(file).left_out, ElementsAre("points and lines of 'axes': not used"));
}

// Vertices that no triangle of a primitive names are not there: others share them.
TEST_F(GltfFile, PrimitivesTakeTheirOwnOfSharedVertices) {
    GltfWriter file;
    const Json quad = file.quad();
    Json half = quad;
    half["indices"] = file.accessor<std::uint8_t>({0, 2, 3}, "SCALAR", 5121, 1);
    file.root["meshes"] = {{{"primitives", {half}}}};
    const Mesh mesh = load(file);
    EXPECT_EQ(mesh.vertices_m.size(), 3u);
    EXPECT_NEAR(area_m2(mesh), 2, 1e-6);
}

// RFC 3986, section 2.1: Khronos' "Box With Spaces" names its files so.
TEST_F(GltfFile, UrisHavePercentSigns) {
    EXPECT_EQ(decoded_data_uri("data:x;base64,aGk="), "hi");
    EXPECT_FALSE(decoded_data_uri("data:x;base64,a*k="));
    GltfWriter file;
    file.show(file.quad());
    write("quad \xC3\xBC.bin", file.bytes());
    file.text();
    file.root["buffers"][0]["uri"] = "quad%20%C3%BC.bin";
    EXPECT_EQ(load_mesh(write("m.gltf", file.root.dump())).triangles.size(), 2u);
    file.root["buffers"][0]["uri"] = "..%2Fquad.dat";
    write("../quad.dat", file.bytes());
    EXPECT_THAT(error_of([&] { load_mesh(write("n.gltf", file.root.dump())); }),
                HasSubstr("lies outside the mesh's folder"));
    std::filesystem::remove(folder_ / "../quad.dat");
}

// EXT_meshopt_compression, by the library's own encoder: vertices with a filter, and indices.
TEST_F(GltfFile, MeshoptBuffersAreUnpacked) {
    GltfWriter file;
    std::vector<float> places;
    std::vector<unsigned> corners;
    constexpr unsigned kSide = 20;
    for (unsigned y = 0; y < kSide; ++y)
        for (unsigned x = 0; x < kSide; ++x) {
            places.insert(places.end(), {static_cast<float>(x), static_cast<float>(y), 0});
            if (x + 1 == kSide || y + 1 == kSide) continue;
            const unsigned at = y * kSide + x;
            corners.insert(corners.end(), {at, at + 1, at + kSide + 1, at, at + kSide + 1, at + kSide});
        }
    std::vector<float> exponential(places.size());
#if MESHOPTIMIZER_VERSION >= 190  // Debian 13 has 0.22, whose encoder asks for a mode
    meshopt_encodeFilterExp(exponential.data(), places.size() / 3, 12, 24, places.data(),
                            meshopt_EncodeExpSeparate);
#else
    meshopt_encodeFilterExp(exponential.data(), places.size() / 3, 12, 24, places.data());
#endif
    std::string vertices(meshopt_encodeVertexBufferBound(places.size() / 3, 12), '\0'),
        indices(meshopt_encodeIndexBufferBound(corners.size(), places.size() / 3), '\0');
    vertices.resize(meshopt_encodeVertexBuffer(reinterpret_cast<unsigned char*>(vertices.data()),
                                               vertices.size(), exponential.data(), places.size() / 3, 12));
    indices.resize(meshopt_encodeIndexBuffer(reinterpret_cast<unsigned char*>(indices.data()), indices.size(),
                                             corners.data(), corners.size()));
    Json quad = {{"attributes", {{"POSITION", file.floats(places, 3)}}},
                 {"indices", file.accessor<unsigned>(corners, "SCALAR", 5125, 1)}};
    // What the views say of themselves is a fallback that nobody reads.
    const auto pack = [&](std::size_t view, const std::string& bytes, const Json& more) {
        const std::size_t packed = file.view(bytes);
        Json compression = file.root["bufferViews"][packed];
        compression.update(more);
        file.root["bufferViews"][view]["buffer"] = 7;
        file.root["bufferViews"][view]["extensions"] = {{"EXT_meshopt_compression", compression}};
    };
    pack(0, vertices,
         {{"byteStride", 12}, {"count", kSide * kSide}, {"mode", "ATTRIBUTES"}, {"filter", "EXPONENTIAL"}});
    pack(1, indices, {{"byteStride", 4}, {"count", corners.size()}, {"mode", "TRIANGLES"}});
    file.root["extensionsRequired"] = {"EXT_meshopt_compression"};
    file.show(quad);
    const Mesh mesh = load(file);
    EXPECT_EQ(mesh.triangles.size(), corners.size() / 3);
    EXPECT_NEAR(area_m2(mesh), (kSide - 1) * (kSide - 1), 1e-3);
    Json& compression = file.root["bufferViews"][0]["extensions"]["EXT_meshopt_compression"];
    compression["filter"] = "COLOR";
    EXPECT_THAT(error(file), HasSubstr("bufferViews[0]: compression: found filter 'COLOR'; accepted: NONE"));
    compression["filter"] = "NONE";
    compression["count"] = 1e12;
    EXPECT_THAT(error(file), HasSubstr("bufferViews[0]: 1000000000000 elements of 12 bytes do not come of"));
    compression["count"] = 500;
    EXPECT_THAT(error(file), HasSubstr("bufferViews[0]: its compressed bytes do not decode (meshoptimizer"));
}

// KHR_draco_mesh_compression, by the library's own encoder.
TEST_F(GltfFile, DracoPrimitivesAreUnpacked) {
    draco::TriangleSoupMeshBuilder builder;
    builder.Start(2);
    const int place = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
    const std::array<std::array<float, 3>, 4> v = {{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}};
    builder.SetAttributeValuesForFace(place, draco::FaceIndex(0), v[0].data(), v[1].data(), v[2].data());
    builder.SetAttributeValuesForFace(place, draco::FaceIndex(1), v[0].data(), v[2].data(), v[3].data());
    const std::unique_ptr<draco::Mesh> mesh = builder.Finalize();
    draco::Encoder encoder;
    draco::EncoderBuffer buffer;
    ASSERT_TRUE(encoder.EncodeMeshToBuffer(*mesh, &buffer).ok());
    GltfWriter file;
    const std::size_t view = file.view(std::string(buffer.data(), buffer.size()));
    file.root["accessors"] = {{{"componentType", 5126}, {"type", "VEC3"}, {"count", 4}},
                              {{"componentType", 5123}, {"type", "SCALAR"}, {"count", 6}}};
    const Json packed = {{"bufferView", view},
                         {"attributes", {{"POSITION", mesh->attribute(place)->unique_id()}}}};
    file.show({{"attributes", {{"POSITION", 0}}},
               {"indices", 1},
               {"extensions", {{"KHR_draco_mesh_compression", packed}}}});
    file.root["extensionsRequired"] = {"KHR_draco_mesh_compression"};
    EXPECT_NEAR(area_m2(load(file)), 4, 1e-3);
    Json& extension = file.root["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"];
    extension["attributes"]["POSITION"] = 9;
    EXPECT_THAT(error(file), HasSubstr("Draco: there is no attribute number 9 for 'POSITION'"));
    file.root["bufferViews"][view]["byteLength"] = buffer.size() / 2;
    EXPECT_THAT(error(file), HasSubstr("its bytes do not decode (Draco: "));
}

// Whatever a file says of places in it is checked against what is there.
TEST_F(GltfFile, WhatLiesNowhereIsRefused) {
    const std::vector<std::pair<std::string, std::string>> wrong = {
        {"/accessors/0/count", "elements do not lie in bufferViews[0], which has 48 bytes"},
        {"/accessors/0/byteOffset", "elements do not lie in bufferViews[0]"},
        {"/accessors/0/bufferView", "bufferViews[4000000]: there is none"},
        {"/accessors/0/componentType", "componentType: found 4000000; accepted: 5120 to 5123, 5125, 5126"},
        {"/bufferViews/0/byteOffset", "do not lie in its buffer of 60"},
        {"/bufferViews/0/byteLength", "do not lie in its buffer of 60"},
        {"/bufferViews/0/byteStride", "byteStride: found 4000000"},
        {"/bufferViews/0/buffer", "buffers[4000000]: there is none"},
        {"/meshes/0/primitives/0/indices", "accessors[4000000]: there is none"},
        {"/meshes/0/primitives/0/attributes/POSITION", "accessors[4000000]: there is none"},
        {"/meshes/0/primitives/0/material", "materials[4000000]: there is none"},
        {"/meshes/0/primitives/0/mode", "mode: found 4000000; accepted: 0 to 6"},
        {"/nodes/0/mesh", "meshes[4000000]: there is none"},
        {"/scenes/0/nodes/0", "a node is named that does not exist: '4000000'"},
        {"/scene", "scenes[4000000]: there is none"},
    };
    for (const auto& [place, words] : wrong) {
        GltfWriter file;
        file.show(file.quad());
        file.text();
        file.root[Json::json_pointer(place)] = 4000000;
        EXPECT_THAT(error_of([&] { load_mesh(write("m.gltf", file.root.dump())); }), HasSubstr(words))
            << place;
        file.root[Json::json_pointer(place)] = -1;
        EXPECT_THAT(error_of([&] { load_mesh(write("m.gltf", file.root.dump())); }), HasSubstr("m.gltf: "))
            << place;
    }
    GltfWriter file;
    Json quad = file.quad();
    quad["indices"] = file.accessor<std::uint16_t>({0, 1, 4}, "SCALAR", 5123, 1);
    file.show(quad);
    EXPECT_THAT(error(file), HasSubstr("triangle 0 of part 'meshes[0]' names a vertex that does not exist"));
}

}  // namespace
}  // namespace hilcam
