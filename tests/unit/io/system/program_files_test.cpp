// The build tree has the source tree's configs where an installed one has its data. The installed tree
// itself: tests/install/install_test.py.

#include "io/system/program_files.h"

#include <fstream>

#include "io/config/config_yaml.h"
#include "tests/support/files.h"

namespace hilcam {
namespace {

namespace fs = std::filesystem;
using ProgramFiles = FilesTest;

const fs::path kConfigs = fs::canonical(HILCAM_SOURCE_DIR "/configs");

TEST_F(ProgramFiles, ShippedFilesAreFoundByTheirPathThere) {
    EXPECT_EQ(data_folder(), kConfigs);
    EXPECT_EQ(shipped_file("cameras/lorri.yaml"), kConfigs / "cameras/lorri.yaml");
    EXPECT_EQ(shipped_file("configs/cameras/lorri.yaml"), kConfigs / "cameras/lorri.yaml");
    EXPECT_EQ(shipped_file("cameras/../cameras/lorri.yaml"), kConfigs / "cameras/lorri.yaml");
    for (const char* none :
         {"", "cameras", "cameras/no.yaml", "../README.md", "configs/../../README.md", "/etc/passwd"})
        EXPECT_EQ(shipped_file(none), fs::path()) << none;
}

TEST_F(ProgramFiles, TheProgramIsFoundWithoutProc) {
    const fs::path by_proc = program_file_by("/proc/self/exe");
    EXPECT_TRUE(fs::is_regular_file(by_proc)) << by_proc;
    EXPECT_EQ(program_file(), by_proc);
    EXPECT_EQ(program_file_by(folder_ / "no_proc"), by_proc);
    EXPECT_EQ(fs::canonical(own_program()), by_proc);
}

TEST_F(ProgramFiles, WhatLiesInTheDataFolderIsShipped) {
    EXPECT_TRUE(is_shipped(kConfigs / "scenarios"));
    EXPECT_TRUE(is_shipped(kConfigs / "cameras/../scenarios"));
    EXPECT_FALSE(is_shipped(kConfigs / ".."));
    EXPECT_FALSE(is_shipped(folder_));
}

struct Paths {
    fs::path file;
};
Fields fields(Paths& p) { return {path("file", p.file, "a file")}; }

TEST_F(ProgramFiles, AFileNamesWhatLiesBesideItOrWhatIsShipped) {
    Paths paths;
    const auto read_in = [&](const fs::path& folder, const std::string& name) {
        read_config_text("file: " + name, "test.yaml", folder, section_of(paths));
        return paths.file;
    };
    EXPECT_EQ(read_in(folder_, "stars/hipparcos.csv"), kConfigs / "stars/hipparcos.csv");
    EXPECT_EQ(read_in(folder_, "mesh.glb"), folder_ / "mesh.glb");
    fs::create_directories(folder_ / "stars");
    write("stars/hipparcos.csv", "");
    EXPECT_EQ(read_in(folder_, "stars/hipparcos.csv"), folder_ / "stars/hipparcos.csv");
    // What a shipped file names and is not shipped is the user's.
    EXPECT_EQ(read_in(kConfigs / "scenarios", "../stars/hipparcos.csv"),
              kConfigs / "scenarios/../stars/hipparcos.csv");
    EXPECT_EQ(read_in(kConfigs / "scenarios", "out/small"), fs::current_path() / "out/small");
}

}  // namespace
}  // namespace hilcam
