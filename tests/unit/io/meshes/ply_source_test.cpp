#include "io/meshes/ply_source.h"

#include <gmock/gmock.h>

#include <cstring>

#include "io/meshes/mesh_file.h"
#include "tests/support/files.h"

namespace hilcam {
namespace {

using testing::HasSubstr;

const std::string kPlyVertices = "property float x\nproperty float y\nproperty float z\n";
std::string ply_head(const std::string& form, int vertices, const std::string& rest) {
    return "ply\nformat " + form + " 1.0\nelement vertex " + std::to_string(vertices) + "\n" + kPlyVertices +
           rest + "end_header\n";
}
const std::string kStrips = "element tristrips 1\nproperty list int int vertex_indices\n";
// A row of three squares: corners 0, 2, 4, 6 below and 1, 3, 5, 7 above.
const std::string kPlyRow = "0 0 0\n0 1 0\n1 0 0\n1 1 0\n2 0 0\n2 1 0\n3 0 0\n3 1 0\n";

std::string ply_number(std::int32_t value, bool big) {
    std::string out;
    for (int i = 0; i < 4; ++i) out += static_cast<char>(value >> 8 * (big ? 3 - i : i));
    return out;
}
std::string ply_number(float value, bool big) {
    std::int32_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    return ply_number(bits, big);
}

class PlySource : public FilesTest {
  protected:
    Mesh mesh_of(const std::string& ply) { return load_mesh(write("m.ply", ply)); }
    std::string refusal(const std::string& ply) {
        return error_of([&] { mesh_of(ply); });
    }
    // Twice the area along +z: what looks down counts against it.
    static double twice_area(const Mesh& mesh) {
        double sum = 0;
        for (const auto& t : mesh.triangles)
            sum += cross(to_double(mesh.vertices_m[t[1]] - mesh.vertices_m[t[0]]),
                         to_double(mesh.vertices_m[t[2]] - mesh.vertices_m[t[0]]))
                       .z;
        return sum;
    }
};

// Corners 0, 2, 1 turn to the left, and all triangles of a strip look to one side.
TEST_F(PlySource, StripsBecomeTrianglesThatLookToOneSide) {
    const Mesh whole = mesh_of(ply_head("ascii", 8, kStrips) + kPlyRow + "8 0 1 2 3 4 5 6 7\n");
    EXPECT_EQ(whole.triangles.size(), 6u);
    EXPECT_DOUBLE_EQ(twice_area(whole), -6);
    // -1 begins anew, and corners that are repeated turn a strip without a triangle of their own.
    const Mesh parts = mesh_of(ply_head("ascii", 8, kStrips) + kPlyRow + "9 0 1 2 3 -1 5 4\n7 6 \n");
    EXPECT_EQ(parts.triangles.size(), 4u);
    EXPECT_DOUBLE_EQ(twice_area(parts), -2 + 2);
    EXPECT_DOUBLE_EQ(twice_area(mesh_of(ply_head("ascii", 8, kStrips) + kPlyRow + "5 0 0 1 2 3\n")), 2);
}

TEST_F(PlySource, StripsOfBytesAreTheSame) {
    for (const bool big : {false, true}) {
        std::string ply = ply_head(big ? "binary_big_endian" : "binary_little_endian", 4, kStrips);
        for (const float value : {-1.f, -1.f, 0.f, 1.f, -1.f, 0.f, -1.f, 1.f, 0.f, 1.f, 1.f, 0.f})
            ply += ply_number(value, big);
        for (const int value : {4, 0, 1, 2, 3}) ply += ply_number(std::int32_t{value}, big);
        const Mesh mesh = mesh_of(ply);
        EXPECT_EQ(mesh.triangles.size(), 2u);
        EXPECT_DOUBLE_EQ(twice_area(mesh), 8);
    }
}

// assimp takes bytes that look like ends of lines and blanks for a part of the header.
TEST_F(PlySource, DataMayBeginWithAnyByte) {
    for (const char first : {'\n', '\r', ' ', '\t'})
        for (const char* end : {"end_header\n", "end_header\r\n"}) {
            std::string ply = ply_head("binary_little_endian", 3,
                                       "element face 1\nproperty list uchar int vertex_indices\n");
            ply.replace(ply.find("end_header\n"), 11, end);
            const float x = [&] {
                const std::string bytes = {first, 0, 0, 0x40};  // 2 and a little
                float value = 0;
                std::memcpy(&value, bytes.data(), sizeof value);
                return value;
            }();
            for (const float value : {x, 0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f})
                ply += ply_number(value, false);
            ply += '\3';
            for (const int value : {0, 1, 2}) ply += ply_number(std::int32_t{value}, false);
            const Mesh mesh = mesh_of(ply);
            ASSERT_EQ(mesh.triangles.size(), 1u) << int{first};
            EXPECT_EQ(mesh.vertices_m[mesh.triangles[0][0]], (Vec3f{x, 0, 0})) << int{first};
        }
}

// Scanners add elements of their own, whose data assimp takes for those of the next element.
TEST_F(PlySource, ElementsOfOtherKindsArePassedOver) {
    const std::string face = "element face 1\nproperty list uchar int vertex_indices\n";
    const std::string camera = "element camera 2\nproperty float view\nproperty list uchar short seen\n";
    const std::string begin = "ply\nformat ascii 1.0\n" + camera + "element vertex 3\n" + kPlyVertices + face;
    EXPECT_EQ(mesh_of(begin + "end_header\n7 2 9 9\n8 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n").triangles.size(),
              1u);
    EXPECT_EQ(mesh_of(ply_head("ascii", 3, camera + face) + "0 0 0\n1 0 0\n0 1 0\n7 2 9 9\n8 0\n3 0 1 2\n")
                  .triangles.size(),
              1u);
    EXPECT_EQ(mesh_of(ply_head("ascii", 3, face + camera) + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n7 2 9 9\n8 0\n")
                  .triangles.size(),
              1u);
    std::string ply =
        "ply\nformat binary_little_endian 1.0\nelement camera 1\nproperty uchar view\nproperty float "
        "f\nelement vertex 3\n" +
        kPlyVertices + face + "end_header\n" + "v" + ply_number(1.f, false);
    for (const float value : {2.f, 0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f}) ply += ply_number(value, false);
    ply += '\3';
    for (const int value : {0, 1, 2}) ply += ply_number(std::int32_t{value}, false);
    const Mesh mesh = mesh_of(ply);
    EXPECT_EQ(mesh.vertices_m[mesh.triangles[0][0]], (Vec3f{2, 0, 0}));
}

TEST_F(PlySource, CommentsAndMarksAreLeftOut) {
    const std::string face = "element face 1\nproperty list uchar int vertex_indices\n";
    const std::string data = "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    EXPECT_EQ(
        mesh_of("\xEF\xBB\xBF" + ply_head("ascii", 3, "comment a\nobj_info num_cols 512\n" + face) + data)
            .triangles.size(),
        1u);
    EXPECT_EQ(mesh_of(ply_head("ascii", 3, "comment element face 7\n" + face + "obj_info x\n") + data)
                  .triangles.size(),
              1u);
    // An element of none beside the strips.
    EXPECT_EQ(
        mesh_of(ply_head("ascii", 3, "element face 0\nproperty list uchar int vertex_indices\n" + kStrips) +
                "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")
            .triangles.size(),
        1u);
}

TEST_F(PlySource, MistakesAreNamed) {
    const std::string face = "element face 1\nproperty list uchar int vertex_indices\n";
    EXPECT_THAT(refusal(ply_head("ascii", 3, face + kStrips) + kPlyRow),
                HasSubstr("it has faces and strips of triangles"));
    EXPECT_THAT(refusal(ply_head("ascii", 3, face + face) + kPlyRow),
                HasSubstr("m.ply:9: found 'face'; accepted: each element once"));
    EXPECT_THAT(refusal(ply_head("ascii", 3, "element face many\n")),
                HasSubstr("accepted: element NAME COUNT"));
    EXPECT_THAT(refusal(ply_head("ascii", 3, "property quaternion q\n")),
                HasSubstr("found 'quaternion'; accepted: a type"));
    EXPECT_THAT(refusal(ply_head("ascii", 8, kStrips) + kPlyRow + "3 0 1 -2\n"),
                HasSubstr("found the index -2"));
    EXPECT_THAT(refusal(ply_head("ascii", 8, kStrips) + kPlyRow + "3 0 1 x\n"),
                HasSubstr("found 'x'; accepted: a whole number"));
    EXPECT_THAT(refusal(ply_head("ascii", 8, kStrips) + kPlyRow + "3 0 1\n"),
                HasSubstr("the file ends too early"));
    EXPECT_THAT(refusal(ply_head("ascii", 8, kStrips) + kPlyRow + "99999 0 1 2\n"),
                HasSubstr("a list of 99999 numbers"));
    EXPECT_THAT(refusal(ply_head("ascii", 8, kStrips) + kPlyRow + "3 0 1 99\n"), HasSubstr("m.ply: "));
    EXPECT_THAT(refusal(ply_head("binary_little_endian", 8, kStrips)), HasSubstr("the file ends too early"));
}

}  // namespace
}  // namespace hilcam
