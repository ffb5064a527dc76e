#include "io/system/durable_file.h"

#include <gmock/gmock.h>

#include <algorithm>

#include "tests/support/files.h"

namespace hilcam {
namespace {

class DurableFileTest : public FilesTest {
  protected:
    std::string text_of(const std::string& name) const {
        std::ifstream in(folder_ / name, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
    std::size_t files() const {
        const std::filesystem::recursive_directory_iterator all(folder_);
        return static_cast<std::size_t>(
            std::count_if(begin(all), end(all), [](const auto& entry) { return entry.is_regular_file(); }));
    }
};

TEST_F(DurableFileTest, TakesItsPlaceWholeAndReplacesWhatWasThere) {
    write_durably(folder_ / "deep/file.txt", "one");
    write_durably(folder_ / "deep/file.txt", "two");
    EXPECT_EQ(text_of("deep/file.txt"), "two");
    EXPECT_EQ(files(), 1u);
}

TEST_F(DurableFileTest, WhatIsNotCommittedIsNotThere) {
    {
        DurableFiles unfinished;
        std::ofstream(unfinished.begin(folder_ / "a.png")) << "half";
        EXPECT_TRUE(unfinished.begin(folder_ / "b.png").string().ends_with("b.png"));
        EXPECT_EQ(files(), 1u);
    }
    EXPECT_EQ(files(), 0u);
    DurableFiles finished;
    std::ofstream(finished.begin(folder_ / "a.png")) << "whole";
    finished.commit();
    EXPECT_EQ(text_of("a.png"), "whole");
}

TEST_F(DurableFileTest, AFolderThatCannotBeIsToldWithItsName) {
    write("file", "x");
    EXPECT_THROW(write_durably(folder_ / "file/below.txt", "y"), DeviceError);
}

TEST_F(DurableFileTest, LeftoversOfAKilledProgramGoAndNothingElse) {
    write(".unfinished-host-1-a.png", "x");
    write(".hidden", "y");
    remove_unfinished(folder_);
    EXPECT_EQ(files(), 1u);
}

}  // namespace
}  // namespace hilcam
