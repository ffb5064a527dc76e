// What is said of keys that are not known and of numbers in another unit.

#include "io/config/config_advice.h"

#include <gmock/gmock.h>

#include "io/config/config_keys.h"

namespace hilcam {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

struct Lens {
    double exposure_s = 1, f_number = 8;
};
Fields fields(Lens& l) {
    return {number("exposure_ms", l.exposure_s, 1e-3, {0, 10}, ""),
            number("f_number", l.f_number, 1, {0, 10}, "")};
}
struct Bench {
    Lens camera;
    std::vector<Lens> more;
};
Fields fields(Bench& b) { return {section("camera", b.camera, ""), sections("more", b.more, "")}; }

std::string advice(std::string_view key) {
    Bench bench;
    const Fields root = fields(bench);
    return advice_for(key, root, root);
}

TEST(ConfigAdvice, AllKeysHaveTheirWholeNames) {
    Bench bench;
    EXPECT_THAT(config_keys(fields(bench)), ElementsAre("camera", "camera.exposure_ms", "camera.f_number",
                                                        "more", "more.N.exposure_ms", "more.N.f_number"));
}

TEST(ConfigAdvice, AKeyThatBelongsElsewhereIsSentThere) {
    EXPECT_EQ(advice("exposure_ms"), "; there is camera.exposure_ms; known keys here: camera more");
    EXPECT_THAT(advice("exposure_us"), HasSubstr("; there is camera.exposure_ms; "));
    EXPECT_EQ(advice("cameras"), "; nearest known key: camera; known keys: camera more");
    EXPECT_EQ(advice("something_else"), "; known keys: camera more");
}

TEST(ConfigAdvice, AWholeKeyHasANearestOne) {
    Bench bench;
    EXPECT_EQ(key_advice("camera.f_numbr", fields(bench)), "; nearest: camera.f_number");
    EXPECT_EQ(key_advice("f_number", fields(bench)), "; there is camera.f_number");
    EXPECT_THAT(key_advice("something.else", fields(bench)), HasSubstr("; accepted: a key as"));
}

TEST(ConfigAdvice, ANumberInAnotherUnitIsRecognised) {
    EXPECT_EQ(unit_advice("wavelength_um", 550, {0.1, 100}), "; in nanometres? here it would be 0.55");
    EXPECT_EQ(unit_advice("focal_length_mm", 0.05, {0.1, 100000}), "; in metres? here it would be 50");
    EXPECT_EQ(unit_advice("quantum_efficiency", 65, {0, 1}), "; in percent? here it would be 0.65");
    EXPECT_EQ(unit_advice("quantum_efficiency", 6500, {0, 1}), "");
    EXPECT_EQ(unit_advice("albedo", -1, {0, 1}), "");
    EXPECT_EQ(unit_advice("bits", 1200, {8, 16}), "");
}

}  // namespace
}  // namespace hilcam
