// A reader of maps that is broken, that lies, or that is not there; and what becomes of it.

#include "io/maps/map_helper.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include <cmath>
#include <csignal>

#include "io/maps/map_messages.h"
#include "io/system/confinement.h"
#include "io/system/program_files.h"
#include "tests/support/files.h"
#include "tests/support/tiff_files.h"

namespace hilcam {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

class MapHelper : public FilesTest {
  protected:
    const MappedBody moon_{"moon", {1737.4e3, 1737.4e3}};
    GroundMapConfig map() {
        GroundMapConfig config;
        config.file = write("map.tif", tiff({}));
        config.where = "maps.0.file";
        return config;
    }
    // A reader that is a script.
    std::filesystem::path reader(const std::string& text) {
        const std::filesystem::path file = write("reader", text);
        chmod(file.c_str(), 0700);
        return file;
    }
    // One that answers the request to open with the fields of a MapAnswer, and goes on with `after`.
    std::filesystem::path liar(const std::string& fields, const std::string& after = "") {
        return reader(
            "#!/usr/bin/python3\nimport mmap, os, socket, struct, time\ns = socket.socket(fileno=3)\nm = "
            "mmap.mmap(4, 0)\n"
            "refused, failed, columns, rows, channels, bands, spacing, whole, reading = 0, 0, 8, 8, 1, 1, "
            "1.0, 0, 0\n"
            "def answer(): s.send(struct.pack('<IIiiiiIIIIIId', refused, failed, columns, rows, channels, "
            "bands, 1, "
            "whole, 0, 0, 0, reading, spacing))\n" +
            fields + "\ns.recv(1000)\nanswer()\n" + after + "\n");
    }
    std::string refusal_by(const std::filesystem::path& program) {
        return error_of([&] { open_map_by(program, map(), moon_); });
    }
};

TEST_F(MapHelper, WhereThereIsNoneTheMessageSaysWhatToInstall) {
    EXPECT_THAT(refusal_by(folder_ / "nothing"),
                AllOf(StartsWith("maps.0.file: "), HasSubstr("map.tif"), HasSubstr("hilcam-read-map"),
                      HasSubstr("apt install hilcam-maps")));
}

TEST_F(MapHelper, AReaderThatDiesIsAMessage) {
    EXPECT_THAT(refusal_by(reader("#!/bin/sh\nexit 0\n")),
                HasSubstr("map.tif: does not parse: it is broken"));
    EXPECT_THAT(refusal_by(reader("#!/bin/sh\nkill -SEGV $$\n")), HasSubstr("does not parse: it is broken"));
    EXPECT_THAT(refusal_by(reader("#!/bin/sh\nexit 101\n")), HasSubstr("asks for more memory"));
    EXPECT_THROW(refusal_by(reader("no program")), DeviceError);
}

TEST_F(MapHelper, WhatAReaderSaysIsNotBelieved) {
    EXPECT_EQ(refusal_by(liar("")), "no error");  // the script itself is right
    for (const char* const lie :
         {"columns = -5", "columns = 1", "rows = 0", "channels = 2", "channels = 7", "bands = 0",
          "spacing = 0.0", "spacing = -1.0", "spacing = float('nan')", "spacing = float('inf')"})
        EXPECT_THAT(refusal_by(liar(lie)), HasSubstr("confuses its reader")) << lie;
    EXPECT_THAT(
        refusal_by(reader(
            "#!/usr/bin/python3\nimport socket\ns = socket.socket(fileno=3)\ns.recv(1000)\ns.send(b'no')\n")),
        HasSubstr("does not parse"));
    // A refusal's words are shown, within bounds and without what turns a terminal over.
    EXPECT_EQ(refusal_by(liar("m[0:13] = b'so\\x1b[31m it is'; refused = 13")), "so [31m it is");
    const auto reading =
        open_map_by(liar("m[0:16] = b'so\\x1b[31m\\ndoubt\\n\\x07b'; reading = 16"), map(), moon_)->reading();
    EXPECT_EQ(reading.taken, "so [31m");
    EXPECT_THAT(reading.doubts, testing::ElementsAre("doubt", " b"));
    EXPECT_LE(open_map_by(liar("m[0:9999] = b'a' * 9999; reading = 4000000000"), map(), moon_)
                  ->reading()
                  .taken.size(),
              kMaxText_bytes);
    EXPECT_LE(refusal_by(liar("m[0:9999] = b'a' * 9999; refused = 4000000000")).size(), kMaxText_bytes);
}

TEST_F(MapHelper, PostsAndValuesOfALiarLeadNowhere) {
    const std::filesystem::path program =
        liar("whole = 1",
             "s.recv(1000)\nm[2097152:2097168] = struct.pack('<dd', 1e300, float('nan'))\n"
             "m[2097168:2097184] = struct.pack('<dd', 8.5, 2)\nm[2097184:2097200] = struct.pack('<dd', 3.25, "
             "2)\nanswer()\n"
             "s.recv(1000)\nm[0:12] = struct.pack('<fff', float('inf'), float('nan'), 7)\nfailed = "
             "1\nanswer()\ns.recv(1000)");
    const auto raster = open_map_by(program, map(), moon_);
    const std::vector<Vec3d> places(3, Vec3d{1, 0, 0});
    std::vector<Vec2d> posts(3);
    raster->find_posts(places, posts);
    EXPECT_TRUE(std::isnan(posts[0].x) && std::isnan(posts[1].x));
    EXPECT_EQ(posts[2].x, 3.25);
    std::vector<float> values(3);
    raster->read(0, 0, 0, 3, 1, values);
    EXPECT_TRUE(std::isnan(values[0]) && std::isnan(values[1]));
    EXPECT_EQ(values[2], 7);
    EXPECT_EQ(raster->failed_reads(), 1u);
    // It dies at the next: holes from then on, each of them counted.
    raster->read(0, 0, 0, 3, 1, values);
    raster->find_posts(places, posts);
    EXPECT_TRUE(std::isnan(values[2]) && std::isnan(posts[2].x));
    EXPECT_EQ(raster->failed_reads(), 3u);
    EXPECT_THAT(ended_map_readers(),
                AllOf(HasSubstr("maps.0.file: "), HasSubstr("map.tif: does not parse: it is broken"),
                      HasSubstr("what lies below it is shown")));
}

// What a forked process asks for comes from a reader of its own, and both go on.
TEST_F(MapHelper, AForkedProcessReadsByItself) {
    GroundMapConfig config = map();
    config.bounds_deg = {-180, -90, 180, 90};
    const auto raster = open_map_by_helper(config, moon_);
    std::vector<float> values(64, 1);
    const pid_t child = fork();
    if (child == 0) {
        raster->read(0, 0, 0, 8, 8, values);
        _exit(values[63] == 0 && raster->failed_reads() == 0 ? 0 : 1);
    }
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
    raster->read(0, 0, 0, 8, 8, values);
    EXPECT_EQ(values[63], 0);
    EXPECT_EQ(raster->failed_reads(), 0u);
}

// Returns the readers that a process has started.
std::vector<pid_t> readers_of(pid_t parent) {
    std::vector<pid_t> out;
    for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
        std::ifstream in(entry.path() / "stat");
        std::string number, name, state;
        pid_t of = 0;
        if (in >> number >> name >> state >> of && name.starts_with("(hilcam-read-map") && of == parent)
            out.push_back(std::stoi(number));
    }
    return out;
}

TEST_F(MapHelper, TheReaderEndsWithTheMap) {
    GroundMapConfig config = map();
    config.bounds_deg = {-180, -90, 180, 90};
    auto raster = open_map_by_helper(config, moon_);
    EXPECT_EQ(readers_of(getpid()).size(), 1u);
    raster.reset();
    EXPECT_EQ(readers_of(getpid()).size(), 0u);
}

// It is under a filter of calls that it cannot leave, and has nothing open but its own, the map and PROJ's table.
TEST_F(MapHelper, TheReaderIsConfined) {
    GroundMapConfig config = map();
    config.bounds_deg = {-180, -90, 180, 90};
    const int foreign = open("/etc/passwd", O_RDONLY);  // as one that is not closed when programs start
    const auto raster = open_map_by_helper(config, moon_);
    close(foreign);
    const std::vector<pid_t> readers = readers_of(getpid());
    ASSERT_EQ(readers.size(), 1u);
    const std::filesystem::path process = "/proc/" + std::to_string(readers[0]);
    for (const auto& fd : std::filesystem::directory_iterator(process / "fd")) {
        const std::string target = std::filesystem::read_symlink(fd.path()).string();
        EXPECT_TRUE(target == "/dev/null" || target.starts_with("socket:") ||
                    target.starts_with("/memfd:hilcam") || target.starts_with(folder_.string()) ||
                    target.ends_with("/proj.db"))
            << target;
    }
    if (!confinement_here().seccomp) GTEST_SKIP() << "this kernel has no seccomp";
    std::ifstream status(process / "status");
    const std::string text{std::istreambuf_iterator<char>(status), {}};
    EXPECT_THAT(text, AllOf(HasSubstr("Seccomp:\t2"), HasSubstr("NoNewPrivs:\t1")));
}

}  // namespace
}  // namespace hilcam
