#pragma once
// A folder of its own for each test that writes files.

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "render/vocabulary/check.h"

namespace hilcam {

class FilesTest : public testing::Test {
  protected:
    std::filesystem::path folder_ =
        std::filesystem::temp_directory_path() / ("hilcam_test_" + std::to_string(getpid()));
    void SetUp() override { std::filesystem::create_directories(folder_); }
    void TearDown() override { std::filesystem::remove_all(folder_); }
    std::filesystem::path write(const std::string& name, const std::string& text) {
        std::ofstream(folder_ / name, std::ios::binary) << text;
        return folder_ / name;
    }
    // What an InputError says that f() throws.
    template <class F>
    std::string error_of(F&& f) {
        try {
            f();
        } catch (const InputError& error) {
            return error.what();
        }
        return "no error";
    }
};

}  // namespace hilcam
