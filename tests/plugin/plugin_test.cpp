#include "render/frame/plugin.h"

#include <gmock/gmock.h>

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
    EXPECT_THAT(error_of("no_such_plugin.so"), HasSubstr("no_such_plugin.so: there is no such file"));
    EXPECT_THAT(error_of(HILCAM_NO_PLUGIN), HasSubstr("is no hilcam plug-in"));
    EXPECT_THAT(error_of(__FILE__), HasSubstr("cannot be loaded"));
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
        EXPECT_STREQ(
            error.what(),
            "quality.path_model: found 'pathh'; accepted: direct | distance | hemisphere | kept | path");
    }
}

}  // namespace
}  // namespace hilcam
