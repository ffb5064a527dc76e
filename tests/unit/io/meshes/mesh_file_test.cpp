#include "io/meshes/mesh_file.h"

#include <gmock/gmock.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <fstream>

#include "io/images/image_file.h"
#include "render/vocabulary/check.h"
#include "render/vocabulary/units.h"
#include "tests/support/files.h"

namespace hilcam {
namespace {

using testing::HasSubstr;

class Files : public FilesTest {
  protected:
    std::string mesh_error(const std::filesystem::path& file) {
        return error_of([&] { load_mesh(file); });
    }
};

const char* const kPlyHead =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n";

TEST_F(Files, ObjQuadBecomesTwoTrianglesWithItsMaterial) {
    write("m.mtl", "newmtl gold\nKd 0.8 0.6 0.2\n");
    const Mesh m = load_mesh(
        write("m.obj", "mtllib m.mtl\nusemtl gold\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n"));
    EXPECT_EQ(m.triangles.size(), 2u);
    EXPECT_EQ(m.surfaces[m.surface_of_triangle[0]].name, "gold");
    EXPECT_TRUE(m.normals.empty());
}

TEST_F(Files, AFileThatEndsItsReaderIsRefused) {
    EXPECT_THAT(mesh_error(write("m.ply", std::string(kPlyHead) + "0 0 0\n1 0 0\n0 1 0\n")),
                HasSubstr("m.ply: "));
    EXPECT_THAT(mesh_error(write("n.ply", "ply\nformat ascii 1.0\nelement verte")),
                HasSubstr("its PLY header has no end_header"));
}

TEST_F(Files, PlyAndStlLoad) {
    EXPECT_EQ(
        load_mesh(write("m.ply", std::string(kPlyHead) + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")).triangles.size(),
        1u);
    EXPECT_EQ(
        load_mesh(write("m.stl",
                        "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
                        "endloop\nendfacet\nendsolid s\n"))
            .triangles.size(),
        1u);
}

// 84 bytes, then 50 for each triangle.
TEST_F(Files, ABinaryStlIsAtLeastAsLongAsItSays) {
    const auto stl = [](const std::string& header, std::uint8_t triangles, std::size_t bytes) {
        std::string out = header + std::string(80 - header.size(), ' ');
        out += {static_cast<char>(triangles), 0, 0, 0};
        for (int i = 0; i < triangles; ++i) {
            for (const float number : {0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f})
                out.append(reinterpret_cast<const char*>(&number), sizeof(number));
            out.append(2, '\0');
        }
        out.resize(bytes, '\0');
        return out;
    };
    for (const char* header : {"", "solid as some programs begin it"}) {
        EXPECT_EQ(load_mesh(write("m.stl", stl(header, 1, 134))).triangles.size(), 1u);
        EXPECT_THAT(
            mesh_error(write("m.stl", stl(header, 10, 284))),
            HasSubstr("m.stl: does not parse: its 10 triangles, as a binary STL, take 584 bytes, and the "
                      "file has 284, room for 4"));
        EXPECT_EQ(load_mesh(write("m.stl", stl(header, 4, 304))).triangles.size(), 4u);
    }
    EXPECT_THAT(mesh_error(write("m.stl", std::string(30, '\0'))),
                HasSubstr("m.stl: does not parse: found 30 bytes"));
}

TEST_F(Files, BadMeshesSayWhatIsWrong) {
    EXPECT_THAT(mesh_error(folder_ / "none.glb"), HasSubstr("none.glb: no such mesh file"));
    EXPECT_THAT(mesh_error(write("m.txt", "x")), HasSubstr("found a file of kind '.txt'; accepted: .glb"));
    EXPECT_THAT(mesh_error(write("m.glb", "rubbish")), HasSubstr("m.glb: does not parse"));
    EXPECT_THAT(mesh_error(write("n.ply", std::string(kPlyHead) + "0 0 0\nnan 0 0\n0 1 0\n3 0 1 2\n")),
                HasSubstr("n.ply: "));
    EXPECT_THAT(mesh_error(write("d.ply", std::string(kPlyHead) + "0 0 0\n1 0 0\n0 1 0\n3 1 1 2\n")),
                HasSubstr("holds no triangle"));
    write("t.mtl", "newmtl a\nKd 1 1 1\nmap_Kd gone.png\n");
    EXPECT_THAT(mesh_error(write(
                    "t.obj", "mtllib t.mtl\nusemtl a\nv 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0 0\nf 1/1 2/1 3/1\n")),
                HasSubstr("texture 'gone.png' of material 'a' is missing"));
    write("gone.png", "not a picture");
    EXPECT_THAT(mesh_error(folder_ / "t.obj"), HasSubstr("does not decode"));
}

// A library of materials is shared by many meshes, as that of NASA's 42 is: its other textures are not those of this one.
TEST_F(Files, OnlyTexturesThatTrianglesHaveAreRead) {
    write("t.mtl", "newmtl a\nKd 1 1 1\nnewmtl b\nKd 1 1 1\nmap_Kd gone.png\n");
    const std::string begin = "mtllib t.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0 0\nusemtl a\n";
    EXPECT_TRUE(load_mesh(write("a.obj", begin + "f 1/1 2/1 3/1\n")).textures.empty());
    // Triangles that are left out have none.
    EXPECT_TRUE(
        load_mesh(write("c.obj", begin + "f 1/1 2/1 3/1\nusemtl b\nf 1/1 2/1 2/1\n")).textures.empty());
    EXPECT_THAT(mesh_error(write("b.obj", begin + "f 1/1 2/1 3/1\nusemtl b\nf 1/1 2/1 3/1\n")),
                HasSubstr("gone.png"));
}

TEST_F(Files, AllTexturesThatCannotBeReadAreListed) {
    write("t.mtl", "newmtl a\nmap_Kd gone.png\nnewmtl b\nmap_Kd bad.png\nnewmtl c\nmap_Kd good.ppm\n");
    write("bad.png", "no picture");
    write("good.ppm", "P3 1 1 255 255 0 0");
    std::string obj = "mtllib t.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0 0\n";
    for (const char* material : {"a", "b", "c"})
        obj.append("usemtl ").append(material).append("\nf 1/1 2/1 3/1\n");
    const auto file = write("t.obj", obj);
    const MeshContents found = load_mesh_contents(file);
    EXPECT_THAT(found.unreadable_textures,
                testing::ElementsAre(HasSubstr("texture 'gone.png' of material 'a' is missing; expected at "),
                                     HasSubstr("texture 'bad.png' of material 'b' does not decode")));
    EXPECT_EQ(found.mesh.triangles.size(), 3u);
    EXPECT_EQ(found.mesh.textures.size(), 1u);
    EXPECT_THAT(mesh_error(file),
                testing::AllOf(HasSubstr("t.obj: 2 textures cannot be read"), HasSubstr("gone.png"),
                               HasSubstr("bad.png"), testing::Not(HasSubstr("\n"))));
}

// Textures lie beside the library that names them, and else beside the mesh.
TEST_F(Files, TexturesAreFoundAsOtherMachinesNameThem) {
    std::filesystem::create_directories(folder_ / "in/sub");
    write("in/sub/t.mtl",
          "newmtl a\nmap_Kd half.ppm\nnewmtl b\nmap_Kd SUB\\Half.PPM\nnewmtl c\nmap_Kd C:\\x\\own.ppm\n");
    write("in/sub/half.ppm", "P3 1 1 255 255 0 0");
    write("in/own.ppm", "P3 1 1 255 0 0 255");
    for (const auto& [material, red] : {std::pair{"a", 255}, {"b", 255}, {"c", 0}}) {
        const auto file = write("in/m.obj", "mtllib sub/t.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0 0\nusemtl " +
                                                std::string(material) + "\nf 1/1 2/1 3/1\n");
        const MeshContents found = load_mesh_contents(file);
        ASSERT_EQ(found.mesh.textures.size(), 1u) << material;
        EXPECT_EQ(found.mesh.textures[0].texels[0][0], red) << material;
        EXPECT_EQ(found.remarks.size(), std::string(material) == "a" ? 0u : 1u) << material;
    }
}

TEST_F(Files, ATexturesNameAndItsDecoderPrintNothing) {
    write("t.mtl", "newmtl a\nKd 1 1 1\nmap_Kd \x1b[31m.png\n");
    const auto mesh =
        write("t.obj", "mtllib t.mtl\nusemtl a\nv 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0 0\nf 1/1 2/1 3/1\n");
    EXPECT_THAT(mesh_error(mesh), HasSubstr("texture ' [31m.png' of material 'a' is missing"));
    write_numbers(folder_ / "whole.png", DnImage(64, 64));
    std::ifstream in(folder_ / "whole.png", std::ios::binary);
    std::string bytes{std::istreambuf_iterator<char>(in), {}};
    bytes[bytes.find("IDAT") + 20] ^= 0x55;
    write("\x1b[31m.png", bytes);
    testing::internal::CaptureStderr();
    const std::string error = mesh_error(mesh);
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
    EXPECT_THAT(error, HasSubstr("does not decode (libpng"));
}

TEST_F(Files, IssLoadsWithItsTextures) {
    const char* shared = std::getenv("HILCAM_SHARED");
    const std::filesystem::path file =
        std::filesystem::path(shared ? shared : HILCAM_SOURCE_DIR "/../shared") / "data/models/iss.glb";
    if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not there";
    const Mesh m = load_mesh(file);
    EXPECT_GT(m.triangles.size(), 200000u);
    EXPECT_GE(m.textures.size(), 10u);
    EXPECT_EQ(m.uvs.size(), m.vertices_m.size());
}

TEST_F(Files, FramesKeepTheirBitsOnDisk) {
    DnImage frame(3, 2);
    const std::uint16_t values[] = {0, 1, 4095, 65535, 256, 77};
    std::copy(std::begin(values), std::end(values), frame.all().begin());
    write_numbers(folder_ / "f.png", frame);
    // Signature, then IHDR says 16 bits grey.
    std::ifstream in(folder_ / "f.png", std::ios::binary);
    std::string head(26, 0);
    in.read(head.data(), 26);
    EXPECT_EQ(head[24], 16);
    EXPECT_EQ(head[25], 0);
    EXPECT_THROW(write_numbers(folder_ / "f.jpg", frame), InputError);
    EXPECT_THROW(write_numbers(folder_ / "no" / "f.png", frame), DeviceError);
}

}  // namespace
}  // namespace hilcam
