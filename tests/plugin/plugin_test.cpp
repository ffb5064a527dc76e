#include "render/frame/plugin.h"

#include <gmock/gmock.h>
#include <unistd.h>

#include <cstdlib>

#include "render/paths/path_plugin.h"
#include "render/vocabulary/check.h"
#include "tests/support/stage.h"

namespace hilcam {
namespace {

using testing::HasSubstr;

std::string error_of(const std::filesystem::path& file) {
    Modules modules;
    const std::vector<std::filesystem::path> files = {file};
    try {
        load_plugins(files, modules);
    } catch (const InputError& error) {
        return error.what();
    }
    return "no error";
}

TEST(Plugin, AModelFromALibraryIsChosenByItsName) {
    Modules modules;
    const std::vector<std::filesystem::path> files = {HILCAM_PLUGIN_DISTANCE};
    load_plugins(files, modules);
    Stage s;
    s.add(plate(lambert(0.5), s.grid), {0, 0, 3});
    s.quality.path_model = "distance";
    Renderer renderer(copy_of(s.scene), s.grid, s.geometry, s.quality, s.models, modules);
    s.points.reserve(renderer.max_points());
    renderer.render(s.world, {1, 1}, s.radiance, s.points, s.stats);
    EXPECT_NEAR(s.middle(), 3, 0.001);
    EXPECT_EQ(s.radiance.row(0)[0], 0);
}

TEST(Plugin, WhatDoesNotFitIsRefusedWithItsReason) {
    EXPECT_THAT(error_of(HILCAM_PLUGIN_OTHER_VERSION),
                HasSubstr("is for plug-in interface " + std::to_string(kPluginInterface + 1) +
                          "; this program has " + std::to_string(kPluginInterface)));
    EXPECT_THAT(error_of(HILCAM_PLUGIN_OTHER_PATH_VERSION),
                HasSubstr("is for path models' interface " + std::to_string(kPathPluginInterface + 1) +
                          "; this program has " + std::to_string(kPathPluginInterface)));
    EXPECT_THAT(error_of("no_such_plugin.so"), HasSubstr("no_such_plugin.so: there is no such file"));
    EXPECT_THAT(error_of(HILCAM_NO_PLUGIN), HasSubstr("is no hilcam plug-in"));
    EXPECT_THAT(error_of(__FILE__), HasSubstr("cannot be loaded"));
}

// A bare name is of the working directory, and not one of the system's libraries.
TEST(Plugin, ABareNameIsThatOfTheFolderOneStandsIn) {
    const std::filesystem::path plugin = HILCAM_PLUGIN_DISTANCE, before = std::filesystem::current_path();
    std::filesystem::current_path(plugin.parent_path());
    Modules modules;
    const std::vector<std::filesystem::path> files = {plugin.filename()};
    EXPECT_NO_THROW(load_plugins(files, modules));
    std::filesystem::current_path(before);
    EXPECT_TRUE(modules.paths.make("distance"));
}

// Wherever it is cut: what is left is refused, and the loader is not left to find the end of it (SIGBUS).
TEST(Plugin, ACutOneIsRefused) {
    const std::filesystem::path whole = HILCAM_PLUGIN_DISTANCE;
    const std::filesystem::path cut =
        std::filesystem::temp_directory_path() / ("hilcam_cut_" + std::to_string(getpid()) + ".so");
    const std::uintmax_t bytes = std::filesystem::file_size(whole);
    std::filesystem::copy_file(whole, cut, std::filesystem::copy_options::overwrite_existing);
    for (const std::uintmax_t left : {bytes - 1, bytes * 3 / 4, bytes / 2, bytes / 4, std::uintmax_t{4097},
                                      std::uintmax_t{200}, std::uintmax_t{64}}) {
        std::filesystem::resize_file(cut, left);
        EXPECT_THAT(error_of(cut), HasSubstr("found " + std::to_string(left) +
                                             " bytes, fewer than its headers tell of: it was cut"));
    }
    for (const std::uintmax_t left : {std::uintmax_t{63}, std::uintmax_t{10}, std::uintmax_t{0}}) {
        std::filesystem::resize_file(cut, left);
        EXPECT_THAT(error_of(cut), HasSubstr("cannot be loaded"));
    }
    std::filesystem::remove(cut);
}

TEST(Plugin, AnEntryThatGivesNothingIsRefused) {
    EXPECT_THAT(error_of(HILCAM_EMPTY_PLUGIN), HasSubstr("its hilcam_plugin() gives nothing"));
    setenv("HILCAM_EMPTY_PLUGIN", "1", 1);
    EXPECT_THAT(error_of(HILCAM_EMPTY_PLUGIN), HasSubstr("it has no function that adds models"));
    EXPECT_THAT(error_of(HILCAM_PLUGIN_OTHER_PATH_VERSION), HasSubstr("it has no path model"));
    unsetenv("HILCAM_EMPTY_PLUGIN");
}

TEST(Plugin, ANameIsTakenOnceAndAnUnknownOneListsTheKnown) {
    Modules modules;
    const std::vector<std::filesystem::path> twice = {HILCAM_PLUGIN_DISTANCE, HILCAM_PLUGIN_DISTANCE};
    try {
        load_plugins(twice, modules);
        FAIL();
    } catch (const InputError& error) {
        EXPECT_THAT(error.what(), HasSubstr("two models 'distance'"));
    }
    try {
        modules.paths.make("pathh");
        FAIL();
    } catch (const InputError& error) {
        EXPECT_STREQ(error.what(),
                     "quality.path_model: found 'pathh'; accepted: cached | direct | distance | path");
    }
}

// A scenario of a program that had the model is told where it is.
TEST(Plugin, AModelThatHasBecomeAPlugInIsNamedWithItsPlace) {
    Modules modules;
    try {
        make_path_model(modules, "hemisphere");
        FAIL();
    } catch (const InputError& error) {
        EXPECT_STREQ(
            error.what(),
            "quality.path_model: found 'hemisphere', which is the example of a plug-in now "
            "(tests/plugin/hemisphere_plugin.cpp, named under 'plugins'); accepted: cached | direct | "
            "path");
    }
    const std::vector<std::filesystem::path> files = {HILCAM_PLUGIN_HEMISPHERE};
    load_plugins(files, modules);
    EXPECT_TRUE(make_path_model(modules, "hemisphere"));
}

}  // namespace
}  // namespace hilcam
