#include "io/config/key_places.h"

#include <gmock/gmock.h>

#include "io/config/config_yaml.h"
#include "tests/support/files.h"

namespace hilcam {
namespace {

struct PlacedLens {
    double focal_length_m = 1, pitch_m = 1;
};
Fields fields(PlacedLens& lens) {
    return {number("focal_length_mm", lens.focal_length_m, 1e-3, {}, ""),
            number("pitch_um", lens.pitch_m, 1e-6, {}, "")};
}
struct PlacedBench {
    PlacedLens lens, other;
};
Fields fields(PlacedBench& bench) {
    return {section("lens", bench.lens, ""), section("other", bench.other, "")};
}

class KeyPlacesTest : public FilesTest {};

TEST_F(KeyPlacesTest, AKeyIsWhereItWasGivenOrWhereWhatHoldsItWas) {
    const auto lens = write("lens.yaml", "focal_length_mm: 3\n");
    const auto file = write("bench.yaml", "lens: lens.yaml\nother:\n  pitch_um: 4\n");
    PlacedBench bench;
    KeyPlaces places(file.string());
    const std::vector<std::string> set = {"other.focal_length_mm=8"};
    read_config(file, section_of(bench), set, &places);
    EXPECT_EQ(places.of("lens"), file.string() + ":1:7");
    EXPECT_EQ(places.of("lens.focal_length_mm"), lens.string() + ":1:18");
    EXPECT_EQ(places.of("lens.pitch_um"), file.string() + ":1:7");  // not given
    EXPECT_EQ(places.of("other.pitch_um"), file.string() + ":3:13");
    EXPECT_EQ(places.of("other.focal_length_mm"), "--set other.focal_length_mm");
    EXPECT_EQ(places.of("third.key"), file.string());
    EXPECT_EQ(places.at("lens", "is dark"), file.string() + ":1:7: is dark");
    EXPECT_EQ(places.with("lens.", "other.").of("lens.pitch_um"), file.string() + ":3:13");
    EXPECT_EQ(places.labelled("camera 2").at("lens", "is dark"), file.string() + ":1:7: camera 2: is dark");
    EXPECT_EQ(KeyPlaces().at("lens", "is dark"), "is dark");
}

TEST_F(KeyPlacesTest, AFileOfASectionHasKeysOfThatSection) {
    const auto file = write("lens.yaml", "focal_length_mm: 3\n");
    PlacedLens lens;
    KeyPlaces places(file.string(), "lens.");
    read_config(file, section_of(lens), {}, &places);
    EXPECT_EQ(places.of("lens.focal_length_mm"), file.string() + ":1:18");
    EXPECT_EQ(places.of("lens.pitch_um"), file.string());
}

}  // namespace
}  // namespace hilcam
