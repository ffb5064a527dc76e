#include "io/images/view_picture.h"

#include <gtest/gtest.h>

#include <cmath>

#include "render/sky/sun.h"
#include "sensor/optics.h"

namespace hilcam {
namespace {

// 12 bits, black at 100 DN, saturated at 4095.
PictureRun plain_run() {
    PictureRun run;
    run.model.bits = 12;
    run.model.offset_dn = 100;
    run.model.full_well_e = 1e5;
    run.model.gain_dn_e = 1;
    return run;
}
FrameRecord plain_record() {
    FrameRecord record;
    record.black_level_dn = 100;
    record.bits = 12;
    return record;
}
std::uint8_t code_of(const PictureSamples& view, std::size_t pixel) { return view.bytes[pixel]; }

// A hundred lit pixels of 1000 DN over black, one glint, and space.
DnImage small_target() {
    DnImage frame(100, 100);
    for (std::uint16_t& dn : frame.all()) dn = 100;
    for (std::size_t i = 0; i < 200; ++i) frame.all()[i] = 1100;
    frame.all()[0] = 4095;
    return frame;
}

TEST(PictureView, BlackIsTheCamerasAndWhiteIsThatOfTheTarget) {
    PictureView view(plain_run());
    const DnImage frame = small_target();
    const PictureSamples out = view.make(frame, plain_record());
    EXPECT_EQ(out.kind, SampleKind::kGray8);
    EXPECT_EQ(code_of(out, 0), 255);  // the glint is the brightest 0.5 % of what is lit
    EXPECT_EQ(code_of(out, 1), 255);
    EXPECT_EQ(code_of(out, 5000), 0);
    DnImage half = small_target();
    half.all()[150] = 100 + 500;
    EXPECT_EQ(code_of(view.make(half, plain_record()), 150), std::lround(255 * std::pow(0.5, 1 / 2.2)));
}

TEST(PictureView, ADarkFrameStaysDark) {
    PictureView view(plain_run());
    DnImage frame(256, 64);
    for (std::size_t i = 0; i < frame.pixels(); ++i)
        frame.all()[i] = static_cast<std::uint16_t>(97 + i % 7);  // noise of 2 DN
    const PictureSamples out = view.make(frame, plain_record());
    // White is a 16th of the way up: 3 DN of 249.7.
    for (const std::uint8_t code : out.bytes)
        EXPECT_LE(code, std::lround(255 * std::pow(3 / 249.0, 1 / 2.2)));
}

TEST(PictureView, ABrightFrameIsWhiteWhereItSaturates) {
    PictureView view(plain_run());
    DnImage frame(10, 10);
    for (std::uint16_t& dn : frame.all()) dn = 4095;
    frame.all()[3] = 2100;
    const PictureSamples out = view.make(frame, plain_record());
    EXPECT_EQ(code_of(out, 0), 255);
    EXPECT_EQ(code_of(out, 3), std::lround(255 * std::pow(2000 / 3995.0, 1 / 2.2)));
}

// Red lets a third through, green all of it, blue a half.
PictureRun colour_run() {
    PictureRun run = plain_run();
    run.model.color_filter.pattern = "RG GB";
    run.model.color_filter.filters = {{"R", {{0.59, 0.60}, {0, 0.33}, {}}},
                                      {"G", {{0.49, 0.50, 0.59, 0.60}, {0, 1, 1, 0}, {}}},
                                      {"B", {{0.49, 0.50}, {0.5, 0}, {}}}};
    run.grid = SpectralGrid({0.4, 0.5, 0.6, 0.7});
    return run;
}

TEST(PictureView, AWhiteSurfaceInSunlightIsGreyAndSaturationIsWhite) {
    const PictureRun run = colour_run();
    const Spectrum sun = solar_irradiance_1au_w_m2_um(run.grid);
    std::array<double, 3> collected{};
    for (std::size_t c = 0; c < 3; ++c) {
        const Spectrum response = electrons_per_s_per_irradiance(
            run.model, run.grid, &run.model.color_filter.filters[c].transmission);
        for (int b = 0; b < 3; ++b) collected[c] += response[b] * sun[b];
    }
    DnImage frame(16, 16);
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 16; ++x) {
            const std::size_t c = y % 2 == 0 ? (x % 2 == 0 ? 0 : 1) : (x % 2 == 0 ? 1 : 2);
            const double dn = 100 + 1500 * collected[c] / collected[1];
            frame.row(y)[static_cast<std::size_t>(x)] =
                y < 8 ? static_cast<std::uint16_t>(std::lround(dn)) : std::uint16_t{4095};
        }
    PictureView view(run);
    const PictureSamples out = view.make(frame, plain_record());
    ASSERT_EQ(out.kind, SampleKind::kRgb8);
    const std::uint8_t* const grey = out.bytes.data() + 3 * (4 * 16 + 8);
    // The balance is exact; DN are rounded.
    EXPECT_NEAR(grey[0], grey[1], 1);
    EXPECT_NEAR(grey[2], grey[1], 1);
    EXPECT_GT(grey[1], 100);
    const std::uint8_t* const white = out.bytes.data() + 3 * (12 * 16 + 8);
    EXPECT_EQ(white[0] + white[1] + white[2], 3 * 255);
    FrameRecord mirrored = plain_record();
    mirrored.reverse_x = true;
    EXPECT_EQ(view.make(frame, mirrored).kind, SampleKind::kGray8);
}

// A scene of one bluish brightness whose blue is balanced up by far: none of it is cut off, as white is what the balanced blue has.
TEST(PictureView, WhiteIsTheLevelOfTheBalancedColours) {
    PictureRun run = colour_run();
    run.model.color_filter.filters[2].transmission = Curve::constant(0.2);
    DnImage frame(256, 64);
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 256; ++x)
            // Blue falls along the row, by a share that its balance does not bring to saturation.
            frame.row(y)[static_cast<std::size_t>(x)] =
                static_cast<std::uint16_t>(y % 2 == 1 && x % 2 == 1 ? 600 - x : 300);
    PictureView view(run);
    const PictureSamples out = view.make(frame, plain_record());
    int cut = 0;
    for (std::size_t i = 0; i < out.bytes.size(); ++i) cut += out.bytes[i] == 255;
    EXPECT_GT(cut, 0);
    EXPECT_LT(cut, 0.01 * static_cast<double>(out.bytes.size()));
    // Greens are levels of their own below it.
    EXPECT_LT(out.bytes[3 * (32 * 256 + 128) + 1], 200);
}

}  // namespace
}  // namespace hilcam
