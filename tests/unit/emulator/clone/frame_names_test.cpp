#include "emulator/clone/frame_names.h"

#include <gtest/gtest.h>

#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

TEST(FrameNames, SayHowAFrameWasTaken) {
    const auto dark = settings_in_name("dark_20ms_-10c/0001");
    ASSERT_TRUE(dark);
    EXPECT_EQ(dark->kind, SeriesKind::kDark);
    EXPECT_DOUBLE_EQ(dark->exposure_s, 0.02);
    EXPECT_TRUE(dark->has_temperature_c);
    EXPECT_EQ(dark->temperature_c, -10);
    const auto flat = settings_in_name("lab/Flat_250us_6dB_light0.5_frame_007");
    ASSERT_TRUE(flat);
    EXPECT_EQ(flat->kind, SeriesKind::kFlat);
    EXPECT_DOUBLE_EQ(flat->exposure_s, 250e-6);
    EXPECT_FALSE(flat->has_temperature_c);
    EXPECT_EQ(flat->gain_db, 6);
    EXPECT_EQ(flat->light, 0.5);
    EXPECT_DOUBLE_EQ(settings_in_name("bias_1.5s")->exposure_s, 1.5);
}

TEST(FrameNames, EdgesBoardsAndLagAreKnown) {
    const auto board = settings_in_name("chessboard_9x6_2ms/0001");
    ASSERT_TRUE(board);
    EXPECT_EQ(board->kind, SeriesKind::kChessboard);
    EXPECT_EQ(board->corners, (std::vector<double>{9, 6}));
    EXPECT_EQ(settings_in_name("edge_left/1")->kind, SeriesKind::kEdge);
    EXPECT_EQ(settings_in_name("lag_5ms/1")->kind, SeriesKind::kLag);
    EXPECT_TRUE(settings_in_name("chessboard_2x6/1")->corners.empty());
    EXPECT_TRUE(settings_in_name("chessboard_9x/1")->corners.empty());
}

TEST(FrameNames, OthersAreOfNothing) {
    EXPECT_FALSE(settings_in_name("readme"));
    EXPECT_FALSE(settings_in_name("20ms_25c_0001"));
    EXPECT_FALSE(settings_in_name(""));
    EXPECT_EQ(settings_in_name("dark_0001")->exposure_s, 0);
}

TEST(FrameNames, ContradictionsAreRefused) {
    const auto message = [](const char* name) -> std::string {
        try {
            settings_in_name(name);
        } catch (const InputError& error) {
            return error.what();
        }
        return "accepted";
    };
    EXPECT_EQ(message("dark_20ms/flat_1"),
              "dark_20ms/flat_1: found two kinds of frames; accepted: one of them");
    EXPECT_EQ(message("dark_20ms/5ms_1"), "dark_20ms/5ms_1: found two exposures; accepted: one, as 20ms");
    EXPECT_EQ(message("dark_20ms/20ms_1"), "accepted");
    EXPECT_EQ(message("flat_lightdim"),
              "flat_lightdim: found 'lightdim'; accepted: a positive number, as light0.5");
}

}  // namespace
}  // namespace hilcam
