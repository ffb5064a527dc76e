#include "io/system/input_file.h"

#include <gmock/gmock.h>
#include <sys/socket.h>
#include <sys/stat.h>

#include <functional>
#include <iterator>
#include <vector>

#include "io/config/config_yaml.h"
#include "io/files/aem_file.h"
#include "io/files/atmosphere_file.h"
#include "io/files/brdf_file.h"
#include "io/files/catalogue_file.h"
#include "io/files/element_set.h"
#include "io/files/height_map_file.h"
#include "io/files/leap_seconds_file.h"
#include "io/files/oem_file.h"
#include "io/images/picture_file.h"
#include "io/meshes/mesh_file.h"
#include "tests/support/files.h"
#include "tests/support/limits.h"

namespace hilcam {
namespace {

using testing::HasSubstr;

const InputKind kText{100, "a text"};

class InputFileTest : public FilesTest {
  protected:
    std::filesystem::path pipe(const std::string& name) {
        EXPECT_EQ(mkfifo((folder_ / name).c_str(), 0600), 0);
        return folder_ / name;
    }
    std::string error(const std::filesystem::path& file) {
        return error_of([&] { read_input_file(file, kText); });
    }
};

TEST_F(InputFileTest, WhatIsNoRegularFileIsRefusedByWhatItIs) {
    EXPECT_THAT(error("/dev/zero"),
                HasSubstr("/dev/zero: cannot be read: it is a device, not a regular file; accepted: a text"));
    EXPECT_THAT(error(pipe("p")), HasSubstr("it is a pipe"));
    EXPECT_THAT(error(folder_), HasSubstr("it is a folder"));
    EXPECT_THAT(error(folder_ / "none"), HasSubstr("none: no such file; accepted: a text"));
    const Fd socket(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
    const sockaddr_un address = unix_address((folder_ / "s").string());
    ASSERT_EQ(bind(socket.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    EXPECT_THAT(error(folder_ / "s"), HasSubstr("it is a socket"));
}

TEST_F(InputFileTest, LinksAreFollowedAndSizesBounded) {
    std::filesystem::create_symlink(write("a", "text"), folder_ / "link");
    EXPECT_EQ(read_input_file(folder_ / "link", kText), "text");
    const auto large = write("large", "x");
    std::filesystem::resize_file(large, 1u << 30);  // without blocks on the disk
    EXPECT_THAT(error(large), HasSubstr("has 1073741824 bytes; accepted: at most 100 bytes"));
}

TEST_F(InputFileTest, AFileHasWhatItHadWhenItWasOpened) {
    const std::uintmax_t size = 1u << 20;
    const auto file = write("f", std::string(size, 'a'));
    const InputKind kind{size, "a text"};
    InputStream grows(file, kind);
    std::filesystem::resize_file(file, 2 * size);
    const std::string all{std::istreambuf_iterator<char>(grows), {}};
    EXPECT_EQ(all.size(), size);

    std::filesystem::resize_file(file, size);
    InputStream shrinks(file, kind);
    std::filesystem::resize_file(file, size / 2);
    std::string line;
    EXPECT_THAT(error_of([&] { std::getline(shrinks, line); }),
                HasSubstr("f: ends at byte 524288 of 1048576: it became shorter while it was read"));
}

// Each reader, given a file of the ending that it knows it by.
TEST_F(InputFileTest, NoReaderWaitsForAPipeOrReadsADeviceWithoutEnd) {
    using Read = std::function<void(const std::filesystem::path&)>;
    struct Reader {
        const char* ending;
        Read read;
    };
    const SpectralGrid grid({0.4, 0.7});
    const auto heights = [](const std::filesystem::path& file) {
        HeightMapConfig config;
        config.file = file, config.columns = config.rows = 2;
        open_height_map(config);
    };
    const std::vector<Reader> readers = {
        {".yaml", [](const auto& file) { read_config(file, SectionField{}); }},
        {".tle", [](const auto& file) { load_element_sets(file); }},
        {".oem", [](const auto& file) { load_oem(file, ""); }},
        {".aem", [](const auto& file) { load_aem(file, ""); }},
        {".stars.csv", [](const auto& file) { load_catalogue(file); }},
        {".list", [](const auto& file) { load_leap_seconds(file); }},
        {".air.csv", [&](const auto& file) { read_atmosphere(file, grid); }},
        {".csv", [&](const auto& file) { read_brdf(file, grid); }},
        {".binary", [&](const auto& file) { read_brdf(file, grid); }},
        {".raw", heights},
        {".png", [](const auto& file) { read_picture(file); }},
        {".tiff", [](const auto& file) { read_pixel_map(file, false); }},
        {".glb", [](const auto& file) { load_mesh(file); }},
    };
    for (const Reader& reader : readers) {
        const auto file = pipe(std::string("pipe") + reader.ending);
        EXPECT_THAT(error_of([&] { reader.read(file); }),
                    HasSubstr(file.string() + ": cannot be read: it is a pipe"));
        const auto device = folder_ / (std::string("zero") + reader.ending);
        std::filesystem::create_symlink("/dev/zero", device);
        EXPECT_THAT(error_of([&] { reader.read(device); }),
                    HasSubstr(device.string() + ": cannot be read: it is a device"));
    }
    EXPECT_FALSE(has_top_level_key(folder_ / "pipe.yaml", "a"));
}

}  // namespace
}  // namespace hilcam
