// Looks at a map: what a footprint sees, that it does not flicker, and where its ends meet.

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "render/earth/earth_map.h"
#include "render/earth/earth_model.h"

namespace hilcam {
namespace {

template <class Value>
EarthMap map_of(int height, const Value& value) {
    EarthMap::Level level{2 * height, height, {}};
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < 2 * height; ++x) {
            EarthMap::Texel texel{};
            texel[EarthSample::kWater] = value(x, y);
            level.texels.push_back(texel);
        }
    return EarthMap(EarthMap::halves(std::move(level)));
}

TEST(EarthMap, AWideLookSeesTheMean) {
    const EarthMap map = map_of(256, [](int x, int y) { return std::uint8_t((x + y) % 2 ? 255 : 0); });
    EXPECT_NEAR(map.sample(0.3f, 0.4f, 0.1f).water(), 0.5f, 0.01f);
    EXPECT_NEAR(map.sample(0.3f, 0.4f, MapFootprint{0.05f, 0, 0, 0.1f}).water(), 0.5f, 0.01f);
}

TEST(EarthMap, ItsEndsMeetAtTheDateLine) {
    const EarthMap map = map_of(64, [](int x, int) { return std::uint8_t(x == 0 ? 255 : 0); });
    const float left = map.sample(0.001f, 0.5f, 0.0f).water(), right = map.sample(0.999f, 0.5f, 0.0f).water();
    EXPECT_GT(left, 0.3f);
    EXPECT_GT(right, 0.3f);
    // A turn more is the same place, to the digits that are left of it.
    EXPECT_NEAR(map.sample(1.001f, 0.5f, 0.0f).water(), left, 1e-4f);
}

// A random map under footprints ten times as long as wide, as at a limb, that move by a tenth of their width: samples change
// by no more than the mean of as many texels can. Without a footprint they change several times as much.
TEST(EarthMap, LongFootprintsDoNotFlicker) {
    std::mt19937 random(3);
    const EarthMap map = map_of(512, [&](int, int) { return std::uint8_t(random() % 2 ? 255 : 0); });
    const float texel = 1.0f / 512;
    double steady = 0, bare = 0;
    constexpr int kLooks = 500;
    for (int i = 0; i < kLooks; ++i) {
        const float u = static_cast<float>(i) * 0.0017f, v = 0.3f + static_cast<float>(i) * 0.0005f;
        const MapFootprint f{0, 20 * texel, texel, 0};
        const float step = 0.2f * texel;
        const auto squared = [](float d) { return static_cast<double>(d * d); };
        steady += squared(map.sample(u, v + 10 * step, f).water() - map.sample(u, v, f).water());
        bare += squared(map.sample(u, v + 10 * step, MapFootprint{}).water() -
                        map.sample(u, v, MapFootprint{}).water());
    }
    EXPECT_LT(std::sqrt(steady / kLooks), 0.12);
    EXPECT_GT(std::sqrt(bare / kLooks), 0.3);
}

TEST(EarthMap, InventedCloudsAreTheSeedsOwnAndCoverHalfOfTheEarth) {
    const EarthMap a = seeded_clouds(1, 128), again = seeded_clouds(1, 128), b = seeded_clouds(2, 128);
    int covered = 0, other = 0, looks = 0;
    for (float v = 0.1f; v < 0.9f; v += 0.02f)
        for (float u = 0; u < 1; u += 0.02f, ++looks) {
            const float c = a.sample(u, v, 0.0f).cloud();
            EXPECT_EQ(c, again.sample(u, v, 0.0f).cloud());
            covered += c > 0.05f;
            other += std::abs(c - b.sample(u, v, 0.0f).cloud()) > 0.05f;
        }
    EXPECT_GT(covered, looks * 0.4);
    EXPECT_LT(covered, looks * 0.85);
    EXPECT_GT(other, looks * 0.3);
}

}  // namespace
}  // namespace hilcam
