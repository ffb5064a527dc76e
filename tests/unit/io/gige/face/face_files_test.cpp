// The files of a camera's face: what is read, and what is refused with which words.

#include "io/gige/face/face_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/gige/device/gige_zip.h"
#include "io/gige/face/description_file.h"
#include "io/gige/face/small_file.h"
#include "io/gige/face/sparse_memory.h"
#include "io/gige/face/unzip.h"
#include "render/vocabulary/check.h"
#include "tests/support/files.h"

namespace hilcam {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

template <class Call>
std::string refusal_of_call(const Call& call) {
    try {
        call();
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

const std::string kXml =
    "<?xml version=\"1.0\"?>\n<RegisterDescription><Port Name=\"Device\"/></RegisterDescription>\n";

std::string packed(const std::string& content) {
    const std::vector<std::uint8_t> zip = zip_of("d.xml", content);
    return {zip.begin(), zip.end()};
}

TEST(Description, TextZipAndAFirstLineAreTheSame) {
    EXPECT_EQ(description_of(kXml, "f"), kXml);
    EXPECT_EQ(description_of("Vendor-Model-1 (10.0.0.1)\n" + kXml, "f"), kXml);
    EXPECT_EQ(description_of(packed(kXml), "f"), kXml);
    EXPECT_EQ(description_of(packed("line\n" + kXml), "f"), kXml);
}

TEST(Description, WhatIsNoneIsRefused) {
    EXPECT_THAT(refusal_of_call([] { description_of("hello", "f.xml"); }),
                AllOf(HasSubstr("f.xml: found 'hello'"), HasSubstr("accepted: a GenICam description")));
    EXPECT_THAT(refusal_of_call([] { description_of("<?xml?><svg/>", "f.xml"); }),
                HasSubstr("without <RegisterDescription"));
    EXPECT_THAT(refusal_of_call([] { description_of(kXml.substr(0, 60), "f.xml"); }), HasSubstr("cut"));
}

TEST(Unzip, WhatIsCutOrDamagedIsRefused) {
    const std::string zip = packed(std::string(5000, 'x') + kXml);
    const auto open = [](const std::string& bytes, std::size_t most = 1 << 20) {
        return refusal_of_call([&] {
            unzip_first({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}, most, "z");
        });
    };
    EXPECT_EQ(open(zip), "");
    EXPECT_THAT(open(zip, 100), HasSubstr("z: unzips to"));
    EXPECT_THAT(open(zip.substr(0, zip.size() / 2)), HasSubstr("no directory"));
    std::string damaged = zip;
    damaged[60] = static_cast<char>(damaged[60] ^ 0x55);
    EXPECT_NE(open(damaged), "");
    std::string other = zip;
    other[other.find("PK\x01\x02") + 10] = 12;  // bzip2
    EXPECT_THAT(open(other), HasSubstr("method 12"));
}

using SmallFile = FilesTest;

TEST_F(SmallFile, ItsSizeIsLimited) {
    const std::filesystem::path file = write("f", "12345");
    EXPECT_EQ(read_small_file(file, 5), "12345");
    EXPECT_THAT(error_of([&] { read_small_file(file, 4); }), HasSubstr("has 5 bytes; accepted: at most 4"));
    EXPECT_THAT(error_of([&] { read_small_file(folder_ / "g", 4); }), HasSubstr("cannot be read"));
}

TEST(RegistersFile, LinesAreAddressesAndBytes) {
    const auto runs = registers_of("# hilcam registers 1\n\n0xA104 00000280 # width\r\n0xFFFFFFFF ab", "r");
    ASSERT_EQ(runs.size(), 2u);
    EXPECT_EQ(runs[0].address, 0xA104u);
    EXPECT_THAT(runs[0].bytes, ElementsAre(0, 0, 2, 0x80));
    EXPECT_EQ(runs[1].address, 0xFFFFFFFFu);
}

TEST(RegistersFile, OtherLinesAreRefusedByNumber) {
    const auto open = [](const std::string& text) {
        return refusal_of_call([&] { registers_of(text, "r"); });
    };
    EXPECT_THAT(open("0x10 00\n"), HasSubstr("r:1: found '0x10 00'"));
    for (const char* line :
         {"10 00", "0x 00", "0x10", "0x10 0", "0x10 0g", "0x100000000 00", "0xFFFFFFFF 0000"})
        EXPECT_THAT(open("# hilcam registers 1\n" + std::string(line)), HasSubstr("r:2: found '")) << line;
    EXPECT_THAT(open("# hilcam registers 1\n0x14 00\n0x10 0000000000"),
                HasSubstr("0x00000014 is there twice"));
}

TEST(SparseMemory, ItIsZeroWhereNothingWasWrittenAndGoesRound) {
    SparseMemory memory;
    const std::array<std::uint8_t, 4> data = {1, 2, 3, 4};
    memory.write(0xFFFFFFFE, data);
    memory.write(4094, data);
    std::array<std::uint8_t, 6> out{};
    memory.read(0xFFFFFFFD, out);
    EXPECT_THAT(out, ElementsAre(0, 1, 2, 3, 4, 0));
    memory.read(4093, out);
    EXPECT_THAT(out, ElementsAre(0, 1, 2, 3, 4, 0));
    EXPECT_EQ(memory.pages(), 3u);
}

// --- the table

const char* const kTable = R"({"hilcam_face": 1,
"description": {"crc32": "0x00000000", "bytes": 1}, "identity": {"vendor": "V", "model": "M"},
"camera": {"width_px": 640, "height_px": 480},
"rows": [
 {"feature": "Width", "at": {"address": "0x00020000", "bytes": 4, "endian": "big", "low": 0, "high": 31, "kind": "unsigned"},
  "formula": {"kind": "linear", "scale": 1, "offset": 0}, "when": [{"at": {"address": "0x00020004", "bytes": 4,
  "endian": "big", "low": 0, "high": 3, "kind": "unsigned"}, "is": 2}], "select": {"TriggerSelector": "FrameStart"}}],
"self_clearing": [], "chunks": null, "registers": [["0x00020000", 4, "RW"]], "memory": [["0x00020004", "00000002"]]})";

std::string with(std::string from, std::string to) {
    std::string text = kTable;
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
}

TEST(FaceTable, IsReadWhole) {
    const FaceTable table = face_table_of(kTable, "t");
    ASSERT_EQ(table.rows.size(), 1u);
    EXPECT_EQ(table.rows[0].feature, "Width");
    EXPECT_EQ(table.rows[0].field.address, 0x20000u);
    EXPECT_EQ(table.rows[0].selected, "FrameStart");
    ASSERT_EQ(table.rows[0].when.size(), 1u);
    EXPECT_EQ(table.rows[0].when[0].is, 2u);
    EXPECT_EQ(table.width_px, 640);
    EXPECT_EQ(table.memory[0].bytes.size(), 4u);
    EXPECT_FALSE(table.registers[0].read_only);
}

TEST(FaceTable, MistakesAreNamedByTheirPlace) {
    const auto open = [](const std::string& text) {
        return refusal_of_call([&] { face_table_of(text, "t"); });
    };
    EXPECT_THAT(open("{"), HasSubstr("t: is no JSON that can be read, at byte"));
    EXPECT_THAT(open("[]"), HasSubstr("has no hilcam_face"));
    EXPECT_THAT(open(std::string(1000, '[')), HasSubstr("nested more than"));
    EXPECT_THAT(open(with("\"hilcam_face\": 1", "\"hilcam_face\": 2")),
                HasSubstr("hilcam_face: found '2'; accepted: 1"));
    EXPECT_THAT(open(with("\"high\": 31", "\"high\": 32")), HasSubstr("t: rows[0]: at: found bits 0 to 32"));
    EXPECT_THAT(open(with("\"0x00020000\"", "\"20000\"")), HasSubstr("rows[0]: at: address: found"));
    EXPECT_THAT(open(with("linear", "cubic")), HasSubstr("accepted: linear, reciprocal, logarithm, points"));
    EXPECT_THAT(open(with("\"scale\": 1", "\"scale\": 0")), HasSubstr("a number other than 0"));
    EXPECT_THAT(open(with("[\"0x00020004\", \"00000002\"]", "[\"0x00020004\", \"0\"]")),
                HasSubstr("memory[0]"));
    EXPECT_THAT(open(with("\"unsigned\"}", "\"float\"}, \"x\": {\"low\": 1}")), "");
    EXPECT_THAT(open(with("\"low\": 0, \"high\": 31, \"kind\": \"unsigned\"",
                          "\"low\": 0, \"high\": 15, \"kind\": \"float\"")),
                HasSubstr("a float of 16 bits"));
}

TEST(FaceTable, ValuesDoNotShareBits) {
    const std::string row =
        R"({"feature": "Height", "at": {"address": "0x00020000", "bytes": 4, "endian": "big", "low": 31, "high": 31,
"kind": "unsigned"}, "values": [[0, 0]]},)";
    const auto open = [](const std::string& text) {
        return refusal_of_call([&] { face_table_of(text, "t"); });
    };
    // The first row holds under a guard, so another may be there without it.
    EXPECT_EQ(open(with("\"rows\": [", "\"rows\": [" + row)), "");
    EXPECT_THAT(open(with("\"rows\": [", "\"rows\": [" + row + row)),
                HasSubstr("rows[1]: Height at 0x00020000 overlaps with Height, rows[0]"));
}

TEST(FaceTable, IsForOneDescription) {
    FaceTable table = face_table_of(kTable, "t");
    EXPECT_THAT(refusal_of_call([&] { check_description(table, "ab", "t.json", "d.xml"); }),
                AllOf(HasSubstr("t.json: was made of another description"), HasSubstr("d.xml"),
                      HasSubstr("bind again")));
    table.description_crc32 = 0x9e83486d, table.description_bytes = 2;  // zlib.crc32(b"ab")
    EXPECT_EQ(refusal_of_call([&] { check_description(table, "ab", "t.json", "d.xml"); }), "");
}

TEST(FaceFiles, ATableIsForACameraOfOneSize) {
    const FaceTable table = face_table_of(kTable, "t");
    EXPECT_EQ(refusal_of_call([&] { check_camera(table, 640, 480); }), "");
    EXPECT_THAT(refusal_of_call([&] { check_camera(table, 640, 512); }),
                AllOf(HasSubstr("640 x 480 pixels, this one has 640 x 512"), HasSubstr("bind again")));
}

TEST(FaceFiles, TheDescriptionLiesWhereNoRegisterIs) {
    FaceTable table;
    table.registers = {{0x20000, 4, false}, {0x40000000, 0x100, true}, {0xFFFFFFF0, 4, false}};
    const std::uint32_t place = free_place(table, 100000);
    EXPECT_GT(place, 0x40000100u);
    EXPECT_LT(place + 100000u, 0xFFFFFFF0u);
    EXPECT_EQ(place % 4096, 0u);
    for (std::uint32_t i = 1; i < 4096; ++i) table.registers.push_back({i << 20, 1 << 19, false});
    EXPECT_LE(free_place(table, 100000) + 100000, 0x100000u);  // before the first of these
    EXPECT_GT(free_place(table, 100000), 0x20004u);
    EXPECT_THAT(refusal_of_call([&] { free_place(table, 1 << 20); }), HasSubstr("no gap"));
}

}  // namespace
}  // namespace hilcam
