// Shape kernels by an independent writer (tests/support/dsk_writer.h), in every layout that the format allows.

#include "io/meshes/dsk_shape.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "io/meshes/mesh_file.h"
#include "render/vocabulary/units.h"
#include "tests/support/dsk_writer.h"
#include "tests/support/files.h"
#include "tests/support/transfer_writer.h"

namespace hilcam {
namespace {

using testing::HasSubstr;

WrittenShape tetrahedron(int surface = 1, double scale_km = 1) {
    WrittenShape s;
    s.surface = surface;
    s.vertices_km = {{0, 0, 0}, {scale_km, 0, 0}, {0, scale_km, 0}, {0, 0, scale_km}};
    s.plates = {{1, 3, 2}, {1, 2, 4}, {1, 4, 3}, {2, 3, 4}};
    return s;
}

// Rings of vertices between two poles: 2 (rows - 1) columns plates over several records of both kinds.
WrittenShape globe(int rows, int columns) {
    WrittenShape s;
    s.vertices_km = {{0, 0, 0.25}};
    for (int i = 1; i < rows; ++i)
        for (int j = 0; j < columns; ++j) {
            const double polar = kPi * i / rows, around = 2 * kPi * j / columns;
            s.vertices_km.push_back({0.25 * std::sin(polar) * std::cos(around),
                                     0.25 * std::sin(polar) * std::sin(around), 0.25 * std::cos(polar)});
        }
    s.vertices_km.push_back({0, 0, -0.25});
    const auto at = [&](int i, int j) {
        return i <= 0 ? 1 : i >= rows ? 2 + (rows - 1) * columns : 2 + (i - 1) * columns + j % columns;
    };
    for (int i = 0; i < rows; ++i)
        for (int j = 0; j < columns; ++j) {
            if (i < rows - 1) s.plates.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            if (i > 0) s.plates.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
        }
    return s;
}

double volume_m3(const Mesh& m) {
    double six = 0;
    for (const auto& t : m.triangles)
        six += dot(to_double(m.vertices_m[t[0]]),
                   cross(to_double(m.vertices_m[t[1]]), to_double(m.vertices_m[t[2]])));
    return six / 6;
}

class DskShape : public FilesTest {
  protected:
    std::string refusal(const std::string& bytes, std::optional<int> surface = {}) {
        return error_of([&] { read_dsk_shape(bytes, "a.bds", surface); });
    }
};

TEST_F(DskShape, HasPlatesInMetres) {
    for (const bool big_endian : {false, true}) {
        const Mesh m = read_dsk_shape(DskWriter(big_endian).add(tetrahedron()).bytes(), "a.bds");
        ASSERT_EQ(m.vertices_m.size(), 4u);
        EXPECT_EQ(m.vertices_m[3].z, 1000);
        EXPECT_EQ(m.triangles[1], (std::array<std::uint32_t, 3>{0, 1, 3}));
        EXPECT_NEAR(volume_m3(m), 1e9 / 6, 1);
        EXPECT_EQ(m.surfaces.size(), 1u);
        EXPECT_TRUE(m.normals.empty());
    }
}

TEST_F(DskShape, IsTheSameHoweverItsRecordsLie) {
    const WrittenShape shape = globe(30, 40);
    const Mesh whole = read_dsk_shape(DskWriter().add(shape).bytes(), "a.bds");
    EXPECT_EQ(whole.triangles.size(), 2u * 29 * 40);
    // A solid of so many facets has a bit less than the sphere.
    EXPECT_NEAR(volume_m3(whole) / (4 * kPi / 3 * std::pow(250, 3)), 1, 0.02);
    EXPECT_GT(volume_m3(whole), 0);
    for (const std::size_t in_turn : {1u, 3u})
        for (const std::size_t clusters : {1u, 5u, 200u})
            for (const bool big_endian : {false, true}) {
                const Mesh m =
                    read_dsk_shape(DskWriter(big_endian, in_turn, clusters).add(shape).bytes(), "a.bds");
                EXPECT_EQ(m.triangles, whole.triangles);
                ASSERT_EQ(m.vertices_m.size(), whole.vertices_m.size());
                for (std::size_t i = 0; i < m.vertices_m.size(); ++i)
                    EXPECT_EQ(length(m.vertices_m[i] - whole.vertices_m[i]), 0);
            }
}

TEST_F(DskShape, IsTheSameInTransferFormat) {
    const DskWriter writer = DskWriter().add(globe(30, 40)).add(tetrahedron(-3, 2));
    const DskWriter::Numbers numbers = writer.numbers();
    const std::string text = transfer_das(numbers.doubles, numbers.integers);
    const Mesh binary = read_dsk_shape(writer.bytes(), "a.bds", -3), same = read_dsk_shape(text, "a.xds", -3);
    EXPECT_EQ(same.triangles, binary.triangles);
    ASSERT_EQ(same.vertices_m.size(), 4u);
    EXPECT_EQ(length(same.vertices_m[3] - binary.vertices_m[3]), 0);
    EXPECT_EQ(dsk_segments(text, "a.xds").size(), 2u);
    EXPECT_THAT(refusal(text.substr(0, text.find('\n', text.size() / 2) + 1)),
                HasSubstr("the file ends; accepted: a whole kernel"));
    write("a.xds", text);
    EXPECT_EQ(load_mesh_contents(folder_ / "a.xds", -3).mesh.triangles.size(), 4u);
}

TEST_F(DskShape, OfSeveralSurfacesOneIsChosen) {
    DskWriter writer;
    writer.add(tetrahedron(7)).add(tetrahedron(-3, 2)).add(tetrahedron(7, 3));
    EXPECT_THAT(refusal(writer.bytes()),
                HasSubstr("a.bds: has the surfaces -3, 7; accepted: one of them, chosen by 'mesh_surface'"));
    EXPECT_EQ(read_dsk_shape(writer.bytes(), "a.bds", -3).triangles.size(), 4u);
    // All segments of a surface.
    const Mesh both = read_dsk_shape(writer.bytes(), "a.bds", 7);
    EXPECT_EQ(both.triangles.size(), 8u);
    EXPECT_EQ(both.triangles[4], (std::array<std::uint32_t, 3>{4, 6, 5}));
    EXPECT_THAT(refusal(writer.bytes(), 9), HasSubstr("a.bds: has no surface 9; accepted: -3, 7"));
    const std::vector<DskSegment> segments = dsk_segments(writer.bytes(), "a.bds");
    ASSERT_EQ(segments.size(), 3u);
    EXPECT_EQ(segments[1].surface, -3);
    EXPECT_EQ(segments[2].body, 2000433);
    EXPECT_EQ(segments[2].plates, 4u);
}

TEST_F(DskShape, IsReadByItsEnding) {
    const auto file = write("two.bds", DskWriter().add(tetrahedron(1)).add(tetrahedron(2)).bytes());
    const std::vector<std::string> none, wing = {"wing"};
    EXPECT_EQ(load_mesh_parts(file, none, 2).front().triangles.size(), 4u);
    EXPECT_THAT(error_of([&] { load_mesh(file); }), HasSubstr("two.bds: has the surfaces 1, 2"));
    EXPECT_THAT(error_of([&] { load_mesh_parts(file, wing, 2); }), HasSubstr("has no nodes"));
    const MeshContents contents = load_mesh_contents(file, 1);
    ASSERT_EQ(contents.nodes.size(), 2u);
    EXPECT_EQ(contents.nodes[1].name, "surface 2 of body 2000433, frame 10");
    EXPECT_EQ(contents.nodes[1].triangles, 4u);
    EXPECT_EQ(contents.collapsed_triangles, 0u);
    const auto ply = write("a.ply", "ply\n");
    EXPECT_THAT(error_of([&] { load_mesh_parts(ply, none, 2); }),
                HasSubstr("found the surface 2; accepted: none: only shape kernels (.bds, .xds) have"));
}

TEST_F(DskShape, BadOnesAreNamed) {
    const std::string good = DskWriter().add(tetrahedron()).bytes();
    const auto with = [&](std::size_t at, const std::string& bytes) {
        return std::string(good).replace(at, bytes.size(), bytes);
    };
    EXPECT_THAT(refusal("DAS/DSK"), HasSubstr("a.bds: has 7 bytes; accepted: a shape kernel"));
    EXPECT_THAT(refusal(with(0, "DAF/SPK ")),
                HasSubstr("found the identification 'DAF/SPK'; accepted: DAS/DSK"));
    EXPECT_THAT(refusal(with(84, "VAX-GFLT")), HasSubstr("found the binary format 'VAX-GFLT'"));
    EXPECT_THAT(refusal(with(706, "\n")), HasSubstr("was damaged when it was transferred as text"));
    for (const std::size_t records : {2u, 3u, 4u})
        EXPECT_THAT(refusal(good.substr(0, 1024 * records)), HasSubstr("is cut short or damaged")) << records;
    WrittenShape shape = tetrahedron();
    shape.type = 4;
    EXPECT_THAT(refusal(DskWriter().add(shape).bytes()),
                HasSubstr("segment 1: found data type 4; accepted: 2"));
    shape = tetrahedron();
    shape.plates[2][1] = 5;
    EXPECT_THAT(refusal(DskWriter().add(shape).bytes()),
                HasSubstr("segment 1: plate 3: found vertex 5; accepted: 1 to 4"));
    shape = tetrahedron();
    shape.vertices_km[1].y = std::nan("");
    EXPECT_THAT(refusal(DskWriter().add(shape).bytes()), HasSubstr("segment 1: vertex 2 is no place"));
    shape = tetrahedron();
    shape.body = 10;
    EXPECT_THAT(refusal(DskWriter().add(tetrahedron()).add(shape).bytes()),
                HasSubstr("its surface is of the bodies 10, 2000433 in the frames 10"));
    EXPECT_THAT(refusal(DskWriter().bytes()), HasSubstr("has no segment"));
}

// A plate that has collapsed is left out, as in other meshes.
TEST_F(DskShape, CollapsedPlatesAreLeftOut) {
    WrittenShape shape = tetrahedron();
    shape.plates.push_back({2, 2, 3});
    EXPECT_EQ(read_dsk_shape(DskWriter().add(shape).bytes(), "a.bds").triangles.size(), 4u);
    const auto file = write("c.bds", DskWriter().add(shape).bytes());
    EXPECT_EQ(load_mesh_contents(file).collapsed_triangles, 1u);
}

}  // namespace
}  // namespace hilcam
