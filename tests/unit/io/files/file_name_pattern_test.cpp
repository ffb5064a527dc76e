#include "io/files/file_name_pattern.h"

#include <gmock/gmock.h>

#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

using testing::HasSubstr;

// As camera 2, "NAC L/R", would name its frame 123 taken at 7 ns.
std::string name_by(const std::string& pattern, const std::string& ending = ".png") {
    FrameRecord record;
    record.id = 123;
    record.exposure_mid = {7};
    const FileNamePattern names(pattern, ending);
    return names.stem(record, {2, "NAC L/R"}) + names.ending();
}
std::string refusal_of(const std::string& pattern) {
    try {
        name_by(pattern);
    } catch (const InputError& error) {
        return error.what();
    }
    return "no error";
}

TEST(FileNamePattern, NumbersAndFieldsStandWhereThePatternHasThem) {
    EXPECT_EQ(name_by("frame_%08d"), "frame_00000123.png");
    EXPECT_EQ(name_by("frame_%06d.png"), "frame_000123.png");
    EXPECT_EQ(name_by("%d"), "123.png");
    EXPECT_EQ(name_by("%2d"), "123.png");
    EXPECT_EQ(name_by("{camera}_{frame:5}", ".tiff"), "2_00123.tiff");
    EXPECT_EQ(name_by("{camera_name}-{frame}-{time_tai_ns}.fits", ".fits"), "NAC_L_R-123-7.fits");
    EXPECT_EQ(name_by("100%%_{{%d}}"), "100%_{123}.png");
}

TEST(FileNamePattern, WhatWouldOverwriteItselfOrIsNoNameIsRefused) {
    EXPECT_EQ(
        refusal_of("frame.png"),
        "name: found 'frame.png'; each frame would be written over the one before; accepted: a name with the "
        "frame's number, as %08d or {frame:8}");
    EXPECT_THAT(refusal_of("{camera}_{time_tai_ns}"), HasSubstr("written over the one before"));
    EXPECT_THAT(refusal_of("%%d"), HasSubstr("written over the one before"));
    EXPECT_THAT(refusal_of("%08d.tiff"),
                HasSubstr("its ending is not that of `format`; accepted: '.png', or none"));
    EXPECT_THAT(refusal_of("day1/%08d"), HasSubstr("a name without folders, which is `folder`"));
    EXPECT_THAT(refusal_of("%s_%d"), HasSubstr("has a % that begins no number; accepted: %d, %08d, and %%"));
    EXPECT_THAT(refusal_of("%08"), HasSubstr("has a % that begins no number"));
    EXPECT_THAT(refusal_of("{frame"), HasSubstr("has a { without its }"));
    EXPECT_THAT(refusal_of("{number}"),
                HasSubstr("found the field 'number'; accepted: {frame}, {frame:8}, {camera}"));
    EXPECT_THAT(refusal_of("%99d"), HasSubstr("has a number of '99' digits; accepted: 1 to 20"));
    EXPECT_THAT(refusal_of("{frame:x}"), HasSubstr("has a number of 'x' digits"));
    EXPECT_THAT(refusal_of("%0d"), HasSubstr("accepted: 1 to 20"));
    EXPECT_THAT(refusal_of(""), HasSubstr("accepted: 1 to 200 characters"));
    EXPECT_THAT(refusal_of(std::string(201, 'a')), HasSubstr("accepted: 1 to 200 characters"));
}

}  // namespace
}  // namespace hilcam
