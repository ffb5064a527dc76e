// Maps of whoever wishes hilcam ill, as a scenario names them: each ends in one line, soon, within little memory, and nothing but the
// map's own files is opened.

#include <fcntl.h>
#include <gmock/gmock.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>

#include "io/maps/ground_map_file.h"
#include "io/system/fd.h"
#include "tests/support/files.h"
#include "tests/support/tiff_files.h"

namespace hilcam {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class MapAttack : public FilesTest {
  protected:
    std::string refusal_of(const std::filesystem::path& file) {
        GroundMapConfig config;
        config.file = file;
        config.holes = MapHoles::kFill;
        config.bounds_deg = {-180, -90, 180, 90};
        return error_of([&] { open_ground_map(config, {"moon", {1737.4e3, 1737.4e3}}); });
    }
    void make_pipe(const std::string& name) { ASSERT_EQ(mkfifo((folder_ / name).c_str(), 0600), 0); }
    // The memory that the largest reader so far had, which is gone.
    static long most_of_readers_kb() {
        rusage used{};
        getrusage(RUSAGE_CHILDREN, &used);
        return used.ru_maxrss;
    }
};

// Labels of 4 x 4 posts of 8 bits, whose values lie where they say.
std::string pds(const std::string& image) {
    return "PDS_VERSION_ID = PDS3\r\nRECORD_TYPE = FIXED_LENGTH\r\nRECORD_BYTES = 4\r\n^IMAGE = " + image +
           "\r\nOBJECT = IMAGE\r\n LINES = 4\r\n LINE_SAMPLES = 4\r\n SAMPLE_TYPE = UNSIGNED_INTEGER\r\n"
           " SAMPLE_BITS = 8\r\nEND_OBJECT = IMAGE\r\nEND\r\n";
}
std::string isis(const std::string& core, const std::string& format = "BandSequential") {
    return "Object = IsisCube\n  Object = Core\n    ^Core = " + core +
           "\n    StartByte = 1\n    Format = " + format +
           "\n    Group = Dimensions\n      Samples = 4\n      Lines = 4\n      Bands = 1\n    End_Group\n"
           "    Group = Pixels\n      Type = UnsignedByte\n      ByteOrder = Lsb\n      Base = 0.0\n"
           "      Multiplier = 1.0\n    End_Group\n  End_Object\nEnd_Object\nEnd\n";
}
const std::string kEnvi =
    "ENVI\nsamples = 4\nlines = 4\nbands = 1\nheader offset = 0\ndata type = 1\ninterleave = bsq\n";

std::string in_place_of(std::string text,
                        std::initializer_list<std::pair<const char*, const char*>> changes) {
    for (const auto& [old, now] : changes) text.replace(text.find(old), std::string(old).size(), now);
    return text;
}

// What they are written for: with values beside them they are maps.
TEST_F(MapAttack, TheLabelsOfThisTestAreReadWhereTheyAreHonest) {
    write("values.dat", std::string(16, 'a'));
    EXPECT_EQ(refusal_of(write("pds.lbl", pds("\"values.dat\""))), "no error");
    EXPECT_EQ(refusal_of(write("pds2.lbl", pds("(\"VALUES.DAT\", 1)"))), "no error");
    EXPECT_EQ(refusal_of(write("isis.lbl", isis("values.dat"))), "no error");
    write("envi.hdr", kEnvi);
    EXPECT_EQ(refusal_of(write("envi.img", std::string(16, 'a'))), "no error");
    EXPECT_EQ(refusal_of(write("map.tif", tiff({}))), "no error");
}

// The reader may look where they lead, although it sees no other folder than the map's.
TEST_F(MapAttack, LinksToAMapAndItsHeaderAreFollowed) {
    std::filesystem::create_directories(folder_ / "store");
    write("store/1", tiff({}));
    write("store/2", kEnvi);
    std::filesystem::create_symlink("store/1", folder_ / "map.tif");
    std::filesystem::create_symlink(folder_ / "store/2", folder_ / "envi.hdr");
    EXPECT_EQ(refusal_of(folder_ / "map.tif"), "no error");
    EXPECT_EQ(refusal_of(write("envi.img", std::string(16, 'a'))), "no error");
}

TEST_F(MapAttack, ALabelPointsAtNothingOutsideItsFolder) {
    std::filesystem::create_directories(folder_ / "in");
    write("secret.dat", std::string(16, 'x'));
    write("in/values.dat", std::string(16, 'x'));
    for (const std::string target :
         {"\"../secret.dat\"", "\"../../../dev/zero\"", "\"../../../etc/passwd\"", "(\"../secret.dat\", 1)",
          "\r\n\"../secret.dat\"", "/* so */ \"../secret.dat\"", "\"/etc/passwd\"", "\"sub/values.dat\"",
          "\"/vsisubfile/0_16,values.dat\"", "\"/vsimem/x\"", "\"\\\\host\\share\""}) {
        EXPECT_THAT(refusal_of(write("in/a.lbl", pds(target))),
                    AllOf(HasSubstr("points at"), HasSubstr("beside it")))
            << target;
        EXPECT_THAT(refusal_of(write("in/a.cub", isis(target))),
                    AllOf(HasSubstr("points at"), HasSubstr("beside it")))
            << target;
    }
    EXPECT_THAT(refusal_of(write("in/a.cub", isis("values.dat", "GeoTIFF"))), HasSubstr("by its own name"));
    EXPECT_THAT(
        refusal_of(write("in/a.lbl",
                         "PDS_VERSION_ID = PDS3\nOBJECT = COMPRESSED_FILE\n FILE_NAME = \"../b\"\nEND\n")),
        HasSubstr("compressed"));
}

TEST_F(MapAttack, NoPipeKeepsTheReader) {
    make_pipe("pipe");
    EXPECT_THAT(refusal_of(write("a.lbl", pds("\"pipe\""))), HasSubstr("pipe: cannot be read: it is a pipe"));
    EXPECT_THAT(refusal_of(write("b.lbl", pds("(\"PIPE\", 3)"))), HasSubstr("it is a pipe"));
    EXPECT_THAT(refusal_of(write("c.cub", isis("pipe"))), HasSubstr("it is a pipe"));
    int i = 0;
    for (const std::string ending : {".tfw", ".tifw", ".wld", ".tab", ".TAB", ".tif.ovr", ".tif.aux.xml",
                                     ".tif.msk", ".hdr", ".psw", ".cbw", ".sta"}) {
        const std::string stem = "map" + std::to_string(i++);
        make_pipe(stem + ending);
        EXPECT_THAT(refusal_of(write(stem + ".tif", tiff({}))),
                    AllOf(HasSubstr(stem + ending), HasSubstr("it is a pipe")))
            << ending;
    }
    make_pipe("envi.hdr");
    EXPECT_THAT(refusal_of(write("envi.img", std::string(16, 'a'))),
                AllOf(HasSubstr("envi.hdr"), HasSubstr("it is a pipe")));
    std::filesystem::create_symlink("/dev/zero", folder_ / "zero.hdr");
    EXPECT_THAT(refusal_of(write("zero.img", std::string(16, 'a'))), HasSubstr("it is a device"));
}

// The scenario's own name has no folder, so that a name of GDAL's own could begin with what the label says.
TEST_F(MapAttack, NothingGoesOutIntoTheNetwork) {
    const Fd server(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
    sockaddr_in where = socket_address(0x7F000001, 0);
    socklen_t size = sizeof where;
    ASSERT_EQ(bind(server.get(), reinterpret_cast<const sockaddr*>(&where), size), 0);
    ASSERT_EQ(listen(server.get(), 8), 0);
    ASSERT_EQ(getsockname(server.get(), reinterpret_cast<sockaddr*>(&where), &size), 0);
    const std::string address = "http://127.0.0.1:" + std::to_string(ntohs(where.sin_port)) + "/a{none}";
    const std::filesystem::path before = std::filesystem::current_path();
    std::filesystem::current_path(folder_);
    for (const std::string handler : {"/vsicurl/", "/vsicurl_streaming/", "/vsis3/b/"}) {
        write("vsi.lbl", pds("\"" + handler + address + "\""));
        EXPECT_THAT(refusal_of("vsi.lbl"), HasSubstr("vsi.lbl"));
        write("vsi.cub", isis("\"" + handler + address + "\""));
        EXPECT_THAT(refusal_of("vsi.cub"), HasSubstr("vsi.cub"));
        EXPECT_THAT(refusal_of(handler + address), HasSubstr("no such file"));
    }
    std::filesystem::current_path(before);
    pollfd asked{server.get(), POLLIN, 0};
    EXPECT_EQ(poll(&asked, 1, 0), 0) << "somebody has connected";
}

TEST_F(MapAttack, LittleFilesOfMuchAreRefusedWithinLittleMemory) {
    const std::string few = "few bytes of what would be a stream";
    TiffTags strip{1'000'000, 1'000'000, 16, 1, 1'000'000, 0, 0, few};
    EXPECT_THAT(refusal_of(write("strip.tif", tiff(strip))),
                AllOf(HasSubstr("strip.tif"), HasSubstr("accepted: a whole file")));
    strip.said_bytes = 0xFFFFFFFF;
    EXPECT_THAT(refusal_of(write("said.tif", tiff(strip))), HasSubstr("accepted: a whole file"));
    TiffTags one{60'000, 60'000, 8, 8, 60'000, 0, 0, few};
    EXPECT_THAT(refusal_of(write("deflate.tif", tiff(one))),
                AllOf(HasSubstr("blocks of 3600 MB"), HasSubstr("at most 67 MB")));
    TiffTags wide{1u << 30, 2, 8, 8, 2, 0, 0, few};
    EXPECT_THAT(refusal_of(write("wide.tif", tiff(wide))), HasSubstr("blocks of 2147 MB"));
    TiffTags tile{40'000, 40'000, 8, 5, 0, 40'000, 40'000, few};
    EXPECT_THAT(refusal_of(write("tile.tif", tiff(tile))), HasSubstr("blocks of 1600 MB"));
    TiffTags all{0x7FFFFFFF, 0x7FFFFFFF, 8, 1, 0x7FFFFFFF, 0, 0, few};
    EXPECT_THAT(refusal_of(write("all.tif", tiff(all))), AllOf(HasSubstr("all.tif"), HasSubstr("accepted:")));
    // The same of strips and tiles that the directory has no places for.
    for (const std::uint32_t rows : {1u, 16u}) {
        TiffTags many = all;
        many.rows_per_strip = rows;
        EXPECT_THAT(refusal_of(write("many.tif", tiff(many))),
                    AllOf(HasSubstr("many.tif"), HasSubstr("accepted:")))
            << rows;
    }
    TiffTags tiles{0x7FFFFFFF, 0x7FFFFFFF, 8, 8, 0, 256, 256, few};
    EXPECT_THAT(refusal_of(write("tiles.tif", tiff(tiles))),
                AllOf(HasSubstr("tiles.tif"), HasSubstr("accepted:")));
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
    EXPECT_LT(most_of_readers_kb(), 400'000);
#endif
}

TEST_F(MapAttack, AFileThatEndsBeforeItsValuesIsRefused) {
    TiffTags cut;
    cut.values.resize(100);
    cut.said_bytes = 128;
    EXPECT_THAT(refusal_of(write("cut.tif", tiff(cut))),
                AllOf(HasSubstr("ends after"), HasSubstr("accepted: a whole file")));
    // 100 x 100 posts, and one byte too few.
    const std::string few(9999, 'a');
    write("envi.hdr", in_place_of(kEnvi, {{"samples = 4", "samples = 100"}, {"lines = 4", "lines = 100"}}));
    EXPECT_THAT(refusal_of(write("envi.img", few)), HasSubstr("less than the 10000 bytes"));
    write("few.dat", few);
    const std::string label = in_place_of(pds("\"few.dat\""), {{"RECORD_BYTES = 4", "RECORD_BYTES = 100"},
                                                               {"LINES = 4", "LINES = 100"},
                                                               {"SAMPLES = 4", "SAMPLES = 100"}});
    EXPECT_THAT(refusal_of(write("pds.lbl", label)), HasSubstr("less than the 10000 bytes"));
    write("row.hdr",
          "ENVI\nsamples = 2000000000\nlines = 2\nbands = 1\nheader offset = 0\ndata type = 5\ninterleave = "
          "bsq\n");
    EXPECT_THAT(refusal_of(write("row.img", std::string(16, 'a'))), HasSubstr("row.img"));
}

}  // namespace
}  // namespace hilcam
