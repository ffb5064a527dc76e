// Pixels between places: what Keys' cubic convolution reproduces (up to parabolas) is exact, nothing is below nothing, and boxes
// whose places are not known are left alone.

#include "render/ground_shading/ground_upsampler.h"

#include <gtest/gtest.h>

#include "render/vocabulary/tile_grid.h"

namespace hilcam {
namespace {

constexpr int kWidth_px = 101, kHeight_px = 90;  // neither is a whole number of tiles, one is odd

float middle(int place) { return GroundUpsampler::kStep_px * (static_cast<float>(place) + 0.5f); }

// Light as a function of the place in the picture [px], known everywhere.
template <class Light>
GroundUpsampler places_of(const RadianceImage& picture, const Light& light) {
    GroundUpsampler places(picture);
    RadianceImage& at = places.light();
    for (int plane = 0; plane < at.planes(); ++plane)
        for (int y = 0; y < at.height(); ++y)
            for (int x = 0; x < at.width(); ++x)
                at.row(y, plane)[static_cast<std::size_t>(x)] = light(middle(x), middle(y), plane);
    const TileGrid tiles(at.width(), at.height(), GroundUpsampler::kTile);
    for (int i = 0; i < tiles.size(); ++i) places.set_known(tiles[i], true);
    return places;
}
void fill(const GroundUpsampler& places, RadianceImage& picture) {
    const TileGrid boxes(picture.width(), picture.height(), RadianceImage::kBlock_px);
    for (int i = 0; i < boxes.size(); ++i) EXPECT_TRUE(places.give(boxes[i], picture));
}

TEST(GroundUpsampler, ParabolasAreExactInsideThePicture) {
    const auto light = [](float x, float y, int plane) {
        return 5 + static_cast<float>(plane) + 0.1f * x + 0.01f * x * x + 0.02f * y * y - 0.003f * x * y;
    };
    RadianceImage picture(kWidth_px, kHeight_px, 2);
    fill(places_of(picture, light), picture);
    for (int plane = 0; plane < 2; ++plane)
        for (int y = 4; y + 4 < kHeight_px; ++y)
            for (int x = 4; x + 4 < kWidth_px; ++x) {
                const float truth = light(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f, plane);
                ASSERT_NEAR(picture.row(y, plane)[static_cast<std::size_t>(x)], truth, 1e-5f * truth)
                    << x << " " << y;
            }
}

TEST(GroundUpsampler, EvenLightIsEvenToTheEdge) {
    RadianceImage picture(kWidth_px, kHeight_px, 1);
    fill(places_of(picture, [](float, float, int) { return 3.0f; }), picture);
    for (const float value : picture.all()) ASSERT_NEAR(value, 3, 1e-6);
}

TEST(GroundUpsampler, NothingIsBelowNothing) {
    RadianceImage picture(kWidth_px, kHeight_px, 1);
    fill(places_of(picture, [](float x, float, int) { return x < 50 ? 0.0f : 100.0f; }), picture);
    for (const float value : picture.all()) ASSERT_GE(value, 0);
    EXPECT_EQ(picture.row(40)[20], 0);
    EXPECT_FLOAT_EQ(picture.row(40)[80], 100);
}

TEST(GroundUpsampler, ABoxWhosePlacesAreNotKnownIsLeftAlone) {
    RadianceImage picture(192, 64, 1);
    GroundUpsampler places = places_of(picture, [](float, float, int) { return 1.0f; });
    places.set_known({64, 0, 96, 32}, false);
    // Two places from it a box has what it takes, nearer it does not.
    EXPECT_TRUE(places.give({64, 0, 96, 32}, picture));
    EXPECT_FALSE(places.give({96, 0, 128, 32}, picture));
    EXPECT_FALSE(places.give({160, 32, 192, 64}, picture));
    EXPECT_EQ(picture.row(10)[70], 1);
    EXPECT_EQ(picture.row(10)[100], 0);
}

TEST(GroundUpsampler, HasRoomForThePicturesOfOneKind) {
    const GroundUpsampler places{RadianceImage(kWidth_px, kHeight_px, 2)};
    EXPECT_TRUE(places.has_room_for(RadianceImage(kWidth_px, kHeight_px, 2)));
    EXPECT_FALSE(places.has_room_for(RadianceImage(kWidth_px + 2, kHeight_px, 2)));
    EXPECT_FALSE(places.has_room_for(RadianceImage(kWidth_px, kHeight_px, 1)));
    EXPECT_FALSE(places.has_room_for(RadianceImage(kWidth_px, kHeight_px, {Spectrum{}, Spectrum{}})));
}

}  // namespace
}  // namespace hilcam
