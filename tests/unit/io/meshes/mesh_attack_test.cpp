// Meshes that ask a reader for more than they can be worth: each is refused in one line, at once, and within
// little memory.
#include <gmock/gmock.h>
#include <sys/stat.h>

#include <cstdint>
#include <cstdlib>
#include <iostream>
#include <nlohmann/json.hpp>

#include "io/meshes/mesh_file.h"
#include "tests/support/files.h"
#include "tests/support/limits.h"

namespace hilcam {
namespace {

using nlohmann::json;
using namespace std::string_literals;

std::string u32(std::uint64_t value) {
    std::string out;
    for (int shift = 0; shift < 32; shift += 8) out += static_cast<char>(value >> shift);
    return out;
}
// A chunk may say another size than it has.
std::string chunk(const char* type, std::string data, std::uint64_t size) {
    return u32(size) + std::string(type, 4) + data;
}
std::string padded(std::string text) {
    text.resize((text.size() + 3) / 4 * 4, ' ');
    return text;
}
std::string glb(const std::string& chunks) { return "glTF" + u32(2) + u32(12 + chunks.size()) + chunks; }

// Floats of the triangle (0, 0, 0), (1, 0, 0), (0, 1, 0).
std::string triangle() {
    const std::string one = u32(0x3F800000), zero = u32(0);
    return zero + zero + zero + one + zero + zero + zero + one + zero;
}
const char* const kTriangleUri =
    "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA";

json document(const json& nodes, const json& buffer) {
    return {{"asset", {{"version", "2.0"}}},
            {"scene", 0},
            {"scenes", {{{"nodes", {0}}}}},
            {"nodes", nodes},
            {"meshes", {{{"primitives", {{{"attributes", {{"POSITION", 0}}}}}}}}},
            {"accessors",
             {{{"bufferView", 0},
               {"componentType", 5126},
               {"count", 3},
               {"type", "VEC3"},
               {"min", {0, 0, 0}},
               {"max", {1, 1, 0}}}}},
            {"bufferViews", {{{"buffer", 0}, {"byteLength", 36}}}},
            {"buffers", {buffer}}};
}
std::string glb_of(const json& nodes) {
    const std::string text = padded(document(nodes, {{"byteLength", 36}}).dump());
    return glb(chunk("JSON", text, text.size()) + chunk("BIN\0", triangle(), 36));
}

class MeshAttack : public FilesTest {
  protected:
    // Loads it in a process of its own, with a limit of memory that a mesh of this size is far below, and of
    // time that a slow machine is.
    void expect_refused(const std::filesystem::path& file, const std::string& words) {
        EXPECT_EXIT(
            {
                limit_this_process(700u << 20, 60);
                std::cerr << error_of([&] { load_mesh(file); });
                _exit(0);
            },
            testing::ExitedWithCode(0), words);
    }
};

TEST_F(MeshAttack, ChunksOfAGlbLieInTheFile) {
    expect_refused(
        write("m.glb", glb(chunk("JSON", "{}  ", 0xFFFFFFFC))),
        "m.glb: does not parse: its chunk at byte 12 has 4294967292 bytes, and the file has 4 behind");
    const std::string text = padded(document({{{"mesh", 0}}}, {{"byteLength", 36}}).dump());
    expect_refused(write("n.glb", glb(chunk("JSON", text, text.size()) + chunk("BIN\0", triangle(), 3600))),
                   "has 3600 bytes, and the file has 36 behind");
}

TEST_F(MeshAttack, InstancesAreCountedBeforeTheyAreMade) {
    json nodes = json::array();
    for (int i = 0; i < 24; ++i) nodes.push_back({{"children", {i + 1, i + 1}}});
    nodes.push_back({{"mesh", 0}});
    expect_refused(write("m.glb", glb_of(nodes)), "m.glb: has more than 200000 nodes");
    const json plain = document(nodes, {{"byteLength", 36}, {"uri", kTriangleUri}});
    expect_refused(write("m.gltf", plain.dump()), "m.gltf: has more than 200000 nodes");
    expect_refused(write("n.glb", glb_of({{{"children", {1}}}, {{"children", {0}}}})),
                   "its node 0 is a child of itself");
    json chain = json::array();
    for (int i = 0; i < 5000; ++i) chain.push_back({{"children", {i + 1}}});
    chain.push_back({{"mesh", 0}});
    expect_refused(write("o.glb", glb_of(chain)), "lie deeper than 1000 levels");
    // A few instances are what instances are for.
    EXPECT_EQ(load_mesh(write("p.glb", glb_of({{{"children", {1, 1}}}, {{"mesh", 0}}}))).triangles.size(),
              2u);
}

TEST_F(MeshAttack, MaterialsAreCountedBeforeTheyAreMade) {
    const std::string shape = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    std::string used = shape, made;
    for (int i = 0; i < 20000; ++i) {
        used.append("usemtl m").append(std::to_string(i)).append("\nf 1 2 3\n");
        made.append("newmtl m").append(std::to_string(i)).append("\nKd 1 0 0\n");
    }
    const std::string words = "has 10001 materials or more; accepted: at most 10000";
    expect_refused(write("used.obj", used), "used.obj: " + words);
    write("made.mtl", made);
    expect_refused(write("m.obj", "mtllib made.mtl\n" + shape + "f 1 2 3\n"), "made.mtl: " + words);
}

TEST_F(MeshAttack, PolygonsOfManyCornersAreRefused) {
    std::string obj = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf";
    for (int i = 0; i < 510000; ++i) obj.append(" ").append(std::to_string(1 + i % 4));
    // assimp 5.4 does not come to the end of it in the time that a mesh has.
    expect_refused(write("m.obj", obj + "\n"),
                   "m.obj: (has a polygon of 510000 corners; accepted: at most 10000|does not parse: its "
                   "reader found no end)");
}

TEST_F(MeshAttack, MemoryThatAHeaderPromisesIsNotTaken) {
    expect_refused(write("m.ply",
                         "ply\nformat binary_little_endian 1.0\nelement vertex 4000000000\nproperty float x\n"
                         "property float y\nproperty float z\nelement face 4000000000\n"
                         "property list uchar int vertex_indices\nend_header\n"),
                   "m.ply: does not parse: it ");
}

TEST_F(MeshAttack, FilesBesideTheMeshAreRegularFilesToo) {
    ASSERT_EQ(mkfifo((folder_ / "pipe").c_str(), 0600), 0);
    const std::string shape = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl a\nf 1/1 2/1 3/1\n";
    expect_refused(write("m.obj", "mtllib pipe\n" + shape), "pipe: cannot be read: it is a pipe");
    write("t.mtl", "newmtl a\nmap_Kd pipe\n");
    expect_refused(write("t.obj", "mtllib t.mtl\n" + shape), "pipe: cannot be read: it is a pipe");
    const json buffer = {{"byteLength", 36}, {"uri", "pipe"}};
    expect_refused(write("b.gltf", document({{{"mesh", 0}}}, buffer).dump()),
                   "pipe: cannot be read: it is a pipe");
}

// A mesh in `in/` names files beside that folder, by a path or by a link: pictures and materials are read, others are not.
TEST_F(MeshAttack, FilesOutsideTheFolderAreLookedAtFirst) {
    std::filesystem::create_directories(folder_ / "in/below");
    const std::string shape = "usemtl a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", texture = "newmtl a\nmap_Kd ";
    const auto texels = [&](const std::string& name, const std::string& obj) {
        return load_mesh(write(name, obj)).textures.at(0).texels;
    };
    write("a.mtl", texture + "../a.ppm\n");
    write("a.ppm", "P3 1 1 255 1 2 3");
    write("secret.png", "no picture");
    write("secret.txt", "newmtl a\n");
    const std::vector<std::array<std::uint8_t, 3>> picture = {{1, 2, 3}};
    write("in/t.mtl", texture + "../a.ppm\n");
    EXPECT_EQ(texels("in/t.obj", "mtllib t.mtl\n" + shape), picture);
    // Its texture is beside the folder that the library lies in: a third child reads it.
    write("b.mtl", texture + "a.ppm\n");
    EXPECT_EQ(texels("in/m.obj", "mtllib ../b.mtl\n" + shape), picture);
    std::filesystem::create_symlink("../a.ppm", folder_ / "in/link.ppm");
    write("in/l.mtl", texture + "link.ppm\n");
    EXPECT_EQ(texels("in/l.obj", "mtllib l.mtl\n" + shape), picture);
    const std::string outside = "lies outside the mesh's folder, at .*accepted there: a picture, materials";
    write("in/s.mtl", texture + "../secret.png\n");
    expect_refused(write("in/s.obj", "mtllib s.mtl\n" + shape), outside);
    expect_refused(write("in/x.obj", "mtllib ../secret.txt\n" + shape), outside);
    ASSERT_EQ(mkfifo((folder_ / "pipe").c_str(), 0600), 0);
    write("in/p.mtl", texture + "../pipe\n");
    expect_refused(write("in/p.obj", "mtllib p.mtl\n" + shape), "pipe: cannot be read: it is a pipe");
    const json buffer = {{"byteLength", 36}, {"uri", "../a.txt"}};
    write("a.txt", triangle());
    expect_refused(write("in/b.gltf", document({{{"mesh", 0}}}, buffer).dump()), outside);
    write("a.bin", triangle());
    const json binary = {{"byteLength", 36}, {"uri", "../a.bin"}};
    EXPECT_EQ(load_mesh(write("in/c.gltf", document({{{"mesh", 0}}}, binary).dump())).triangles.size(), 1u);
    // What lies below is read: this one is no picture, and a link to the mesh is as good as the mesh.
    write("in/below/a.png", "no picture");
    write("in/b.mtl", texture + "below/a.png\n");
    expect_refused(write("in/b.obj", "mtllib b.mtl\n" + shape), "texture 'below/a.png'");
    std::filesystem::create_symlink("in/b.obj", folder_ / "link.obj");
    write("b.mtl", "newmtl a\nKd 1 0 0\n");
    EXPECT_EQ(load_mesh(folder_ / "link.obj").triangles.size(), 1u);
}

TEST_F(MeshAttack, AUriNamesAFileWithABlank) {
    write("a b.bin", triangle());
    for (const char* uri : {"a%20b.bin", "a b.bin"}) {
        const json buffer = {{"byteLength", 36}, {"uri", uri}};
        EXPECT_EQ(load_mesh(write("m.gltf", document({{{"mesh", 0}}}, buffer).dump())).triangles.size(), 1u)
            << uri;
    }
}

TEST_F(MeshAttack, AGlbMayHaveItsBufferAsText) {
    const json buffer = {{"byteLength", 36}, {"uri", kTriangleUri}};
    const std::string text = padded(document({{{"mesh", 0}}}, buffer).dump());
    EXPECT_EQ(load_mesh(write("m.glb", glb(chunk("JSON", text, text.size())))).triangles.size(), 1u);
}

// Whole meshes of one triangle, or what a file of the kind begins with. assimp has an importer for each.
TEST_F(MeshAttack, ContentsOfOtherKindsAreReadByNoOtherImporter) {
    const std::vector<std::pair<const char*, std::string>> foreign = {
        {"AC3D",
         "AC3Db\nMATERIAL \"m\" rgb 1 1 1  amb 1 1 1  emis 0 0 0  spec 0 0 0  shi 0  trans 0\nOBJECT world\n"
         "kids 1\nOBJECT poly\nnumvert 3\n0 0 0\n1 0 0\n0 1 0\nnumsurf 1\nSURF 0x20\nmat 0\nrefs 3\n0 0 0\n"
         "1 0 0\n2 0 0\nkids 0\n"},
        {"OFF", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"},
        {"X", "xof 0303txt 0032\nMesh m {\n3;\n0;0;0;,\n1;0;0;,\n0;1;0;;\n1;\n3;0,1,2;;\n}\n"},
        {"COLLADA", "<?xml version=\"1.0\"?>\n<COLLADA version=\"1.4.1\"></COLLADA>\n"},
        {"LWO", "FORM\0\0\0\x0CLWO2PNTS\0\0\0\0"s},
        {"MD3", "IDP3\x0F\0\0\0"s + std::string(100, '\0')},
        {"MD5", "MD5Version 10\ncommandline \"\"\nnumJoints 0\nnumMeshes 0\n"},
        {"3DS", "MM\x0E\0\0\0\x02\0\x0A\0\0\0\x03\0\0\0"s},
        {"BLENDER", "BLENDER-v279REND\0\0\0\0"s},
    };
    for (const char* ending : {".glb", ".gltf", ".obj", ".stl", ".ply"})
        for (const auto& [kind, contents] : foreign) {
            const auto file = write(std::string("m") + ending, contents);
            const std::string error = error_of([&] { load_mesh(file); });
            EXPECT_THAT(error, testing::AnyOf(testing::HasSubstr("does not parse: "),
                                              testing::HasSubstr("holds no triangle")))
                << kind << " as " << ending;
            EXPECT_THAT(error, testing::Not(testing::HasSubstr(kind + ": "s))) << ending;
        }
}

}  // namespace
}  // namespace hilcam
