#include "render/indirect/lobe_memo.h"

#include <gtest/gtest.h>

#include <cmath>

namespace hilcam {
namespace {

Vec3f leaning(float rad) { return {std::sin(rad), 0, std::cos(rad)}; }

ShadingPoint vertex_of(const Material& material) {
    ShadingPoint at{};
    at.object = 2, at.surface_number = 3;
    at.normal = at.geometric_normal = leaning(0);
    at.view_dir = leaning(0.5f);
    at.surface.material = &material, at.surface.alpha = 0.3f;
    return at;
}

TEST(LobeMemo, AreFoundAgainWithinADegree) {
    const Material material{};
    const ShadingPoint at = vertex_of(material);
    LobeMemo<int> lobes;
    EXPECT_EQ(lobes.find(at, 7), nullptr);
    EXPECT_EQ(lobes.keep(at, 7, 42), 42);
    ShadingPoint near = at;
    near.view_dir = leaning(0.51f);  // 0.6 degrees
    ASSERT_NE(lobes.find(near, 7), nullptr);
    EXPECT_EQ(*lobes.find(near, 7), 42);
    near.view_dir = leaning(0.53f);
    EXPECT_EQ(lobes.find(near, 7), nullptr);
}

TEST(LobeMemo, DifferByWhatTheyAreOf) {
    const Material material{};
    const ShadingPoint at = vertex_of(material);
    LobeMemo<int> lobes;
    lobes.keep(at, 7, 42);
    EXPECT_EQ(lobes.find(at, 8), nullptr);
    const auto differs = [&](auto&& change) {
        ShadingPoint other = at;
        change(other);
        return lobes.find(other, 7) == nullptr;
    };
    EXPECT_FALSE(differs([](ShadingPoint&) {}));
    EXPECT_TRUE(differs([](ShadingPoint& v) { v.object = 1; }));
    EXPECT_TRUE(differs([](ShadingPoint& v) { v.surface_number = 1; }));
    EXPECT_TRUE(differs([](ShadingPoint& v) { v.back = true; }));
    EXPECT_TRUE(differs([](ShadingPoint& v) { v.normal = leaning(0.03f); }));
    EXPECT_TRUE(differs([](ShadingPoint& v) { v.surface.alpha = 0.4f; }));
}

// More than there are slots: each takes the place of one before.
TEST(LobeMemo, KeepTheLastOfAnyNumber) {
    const Material material{};
    const ShadingPoint at = vertex_of(material);
    LobeMemo<int> lobes;
    for (std::uint32_t probe = 1; probe <= 3000; ++probe) {
        EXPECT_EQ(lobes.keep(at, probe, static_cast<int>(probe)), static_cast<int>(probe));
        ASSERT_NE(lobes.find(at, probe), nullptr);
        EXPECT_EQ(*lobes.find(at, probe), static_cast<int>(probe));
    }
    int kept = 0;
    for (std::uint32_t probe = 1; probe <= 3000; ++probe)
        if (const int* value = lobes.find(at, probe)) {
            EXPECT_EQ(*value, static_cast<int>(probe));
            ++kept;
        }
    EXPECT_GT(kept, 200);
    EXPECT_LE(kept, 256);
}

}  // namespace
}  // namespace hilcam
