// Parts by their names, in the build tree, which has the source tree's configs. Configurations that take them:
// tests/unit/io/config/config_yaml_test.cpp.

#include "io/system/shipped_parts.h"

#include <gmock/gmock.h>

#include "tests/support/files.h"

namespace hilcam {
namespace {

namespace fs = std::filesystem;
using ShippedParts = FilesTest;
using testing::Contains;
using testing::HasSubstr;

const fs::path kShipped = fs::canonical(HILCAM_SOURCE_DIR "/configs");

TEST_F(ShippedParts, AConfigurationIsAPathOrAName) {
    EXPECT_EQ(named_config("small"), kShipped / "scenarios/small.yaml");
    EXPECT_EQ(named_config("lorri"), kShipped / "cameras/lorri.yaml");
    EXPECT_EQ(named_config("nothing"), "nothing");
    EXPECT_EQ(named_config("no/small"), "no/small");
    EXPECT_EQ(named_config("small.yml"), "small.yml");
    // What is there comes first.
    write("small", "name: mine\n");
    const fs::path before = fs::current_path();
    fs::current_path(folder_);
    EXPECT_EQ(named_config("small"), "small");
    fs::current_path(before);
}

TEST_F(ShippedParts, APartIsFoundByItsKindAndName) {
    const ShippedKind& qualities = *shipped_kind("qualities");
    EXPECT_EQ(shipped_part(qualities, "realtime"), kShipped / "quality/realtime.yaml");
    EXPECT_EQ(shipped_part(*shipped_kind("filters"), "rggb"), kShipped / "filters/RGGB.yaml");
    EXPECT_EQ(shipped_part(*shipped_kind("meshes"), "asteroid"), kShipped / "meshes/asteroid.ply");
    for (const char* const none : {"", "lorri", "realtime.yaml", "../quality/realtime", "quality/realtime"})
        EXPECT_EQ(shipped_part(qualities, none), fs::path()) << none;
    EXPECT_EQ(shipped_kind("lenses"), nullptr);
}

TEST_F(ShippedParts, AKeyTakesPartsOfItsKindAtAnyPlace) {
    const auto words = [](const char* key) {
        const ShippedKind* const kind = kind_of_key(key);
        return kind ? kind->words : std::string_view("none");
    };
    EXPECT_EQ(words("quality"), "qualities");
    EXPECT_EQ(words("loop.levels.2"), "qualities");
    EXPECT_EQ(words("more_cameras.0.camera"), "cameras");
    EXPECT_EQ(words("objects.3.materials.surfaces.0.material"), "materials");
    EXPECT_EQ(words("camera.color_filter.filters"), "filters");
    EXPECT_EQ(words("earth.albedo_map"), "maps");
    for (const char* const none :
         {"name", "camera.filters", "camera_motion.tle.file", "my_camera", "outputs.files.folder"})
        EXPECT_EQ(words(none), "none") << none;
}

TEST_F(ShippedParts, EveryPartOfAConfigurationSaysWhatItIs) {
    for (const ShippedKind& kind : shipped_kinds()) {
        const std::vector<ShippedPart> parts = shipped_parts(kind);
        EXPECT_FALSE(parts.empty()) << kind.words;
        for (const ShippedPart& part : parts) {
            if (part.file.extension() == ".yaml") {
                EXPECT_GT(part.about.size(), 10u) << part.file;
            }
            EXPECT_LT(part.about.size(), 210u) << part.file << ": " << part.about;
        }
    }
    EXPECT_THAT(shipped_names(*shipped_kind("scenarios")), Contains("geo_inspection"));
}

TEST_F(ShippedParts, AFilesFirstSentenceIsThatOfItsComment) {
    EXPECT_EQ(first_sentence_of("# yaml-language-server: $schema=x\n# A lens after Smith et al. 2011, of\n# "
                                "glass. It is dear.\nname: x\n"),
              "A lens after Smith et al. 2011, of glass");
    EXPECT_EQ(first_sentence_of("# Run it:\n#   hilcam run it\n# More.\n"), "Run it:");
    EXPECT_EQ(first_sentence_of("ply\nformat ascii 1.0\ncomment A cube.\nelement vertex 8\n"), "A cube");
    for (const char* const none : {"", "name: x\n# late\n", "\x89PNG\r\n"})
        EXPECT_EQ(first_sentence_of(none), "") << none;
}

}  // namespace
}  // namespace hilcam
