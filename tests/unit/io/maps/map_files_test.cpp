#include "io/maps/map_files.h"

#include <gmock/gmock.h>

#include "tests/support/files.h"

namespace hilcam {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::IsSupersetOf;
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
    EXPECT_THAT(
        label_pointers("^A = \"a.img\"\n^B=b.img\n ^C = ( \"c.img\" , 1 )\n^D =\n  'd.img'\n^E = /* x/y */ "
                       "(\"e.img\", 5 <BYTES>)\n^F = {\"f g.img\"}",
                       "m"),
        IsSupersetOf({"a.img", "b.img", "c.img", "d.img", "e.img", "f g.img"}));
    // Words that point at nothing may have folders, and so may comments.
    for (const char* const text :
         {"NOTE = \"see ../readme\"\nPRODUCT = /a/b\nE = 10^6\n", "^A = a.img\n/* in km/s */\nB = 1\n"})
        EXPECT_EQ(error_of([&] { label_pointers(text, "m"); }), "no error") << text;
    for (const char* const text :
         {"^A = ../b", "^A = \"/b\"", "^A = ('c.img', '/b')", "^A = {\"sub/b\"}", "^A\n=\n\"../b\"",
          "^A = \"b\\c\"", "^A = \"/vsicurl/x", "^A = /* */ ../b", "^A = # so\n ../b",
          "^A = (\"b)\", \"../x\")", "^A = \"/*\" \"../x\" \"*/\"", "^A = (\"b\" \"/../x\")"})
        EXPECT_THAT(error_of([&] { label_pointers(text, "m"); }), HasSubstr("m: its label points at"))
            << text;
}

// Readers of labels take the bytes before a zero and those of the next block for one word.
TEST_F(MapFilesTest, ALabelIsTextUpToItsEnd) {
    const std::string begin = "PDS_VERSION_ID = PDS3\n";
    const std::string zero = begin + "^IMAGE = \"b" + '\0' + "\"\nEND\n";
    EXPECT_THAT(error_of([&] { find_map_files(write("a.lbl", zero), "m"); }), HasSubstr("no text"));
    const std::string comment = begin + "/*\nEND\n*/ ^IMAGE = \"../b\"\n";
    EXPECT_THAT(error_of([&] { find_map_files(write("d.lbl", comment), "m"); }), HasSubstr("points at"));
    const std::string values = std::string(600, ' ') + "\n^ = ../b" + std::string(100, '\0');
    EXPECT_EQ(error_of([&] { find_map_files(write("b.lbl", begin + "END\r\n" + values), "m"); }), "no error");
    const std::string late = begin + std::string(1 << 20, ' ') + "^IMAGE = \"../b\"\nEND\n";
    EXPECT_THAT(error_of([&] { find_map_files(write("c.lbl", late), "m"); }), HasSubstr("no line END"));
}

// What is no label is values, which may look like anything.
TEST_F(MapFilesTest, ValuesPointAtNothing) {
    EXPECT_THAT(find_map_files(write("a.img", "\1\2^A = ../b\n"), "m").pointed_at, IsEmpty());
}

}  // namespace
}  // namespace hilcam
