#include "io/maps/map_files.h"

#include <gmock/gmock.h>

#include "tests/support/files.h"

namespace hilcam {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::UnorderedElementsAre;

class MapFilesTest : public FilesTest {};

TEST_F(MapFilesTest, WhatBeginsAsTheMapDoesLiesBesideIt) {
    for (const char* const name : {"Map.tif", "map.tif.ovr", "MAP.HDR", "map", "other.hdr", "ma.tif"})
        write(name, "x");
    std::filesystem::create_directories(folder_ / "map_tiles");
    const MapFiles found = find_map_files(folder_ / "Map.tif", "m");
    EXPECT_THAT(found.beside, UnorderedElementsAre("Map.tif", "map.tif.ovr", "MAP.HDR", "map"));
    EXPECT_THAT(found.pointed_at, IsEmpty());
    EXPECT_TRUE(found.file.is_absolute());
}

TEST_F(MapFilesTest, ALabelPointsByNamesInAnyCase) {
    write("DATA.IMG", "x");
    write("other.lbl", "x");
    const MapFiles found =
        find_map_files(write("a.lbl", "PDS_VERSION_ID = PDS3\n^IMAGE = \"data.img\"\nEND\n"), "m");
    EXPECT_THAT(found.pointed_at, ElementsAre("DATA.IMG"));
    EXPECT_THAT(found.beside, ElementsAre("a.lbl"));
}

TEST_F(MapFilesTest, PointersAreFoundHoweverTheyAreWritten) {
    EXPECT_THAT(label_pointers("^IMAGE = 9\n^TABLE = (3, 4)\n^A = 12 <BYTES>\n", "m"), IsEmpty());
    EXPECT_THAT(label_pointers("^A = \"a.img\"\n^B=b.img\n ^C = ( \"c.img\" , 1 )\n^D =\n  'd.img'\n^E = /* "
                               "x */ (\"e.img\", 5 <BYTES>)",
                               "m"),
                ElementsAre("a.img", "b.img", "c.img", "d.img", "e.img"));
    // Words that point at nothing may have folders.
    EXPECT_THAT(label_pointers("NOTE = \"see ../readme\"\nPRODUCT = /a/b\nE = 10^6\n", "m"), IsEmpty());
    for (const char* const text :
         {"^A = ../b", "^A = \"/b\"", "^A = ('c.img', '/b')", "^A = {\"sub/b\"}", "^A\n=\n\"../b\"",
          "^A = \"b\\\\c\"", "^A = ..", "^A = \"/vsicurl/x", "^A = /* */ ../b"})
        EXPECT_THAT(error_of([&] { label_pointers(text, "m"); }), HasSubstr("m: its label points at"))
            << text;
}

// What is no label is values, which may look like anything.
TEST_F(MapFilesTest, ValuesPointAtNothing) {
    EXPECT_THAT(find_map_files(write("a.img", "\1\2^A = ../b\n"), "m").pointed_at, IsEmpty());
}

}  // namespace
}  // namespace hilcam
