// The generated satellite's surfaces face outwards, as whoever reads its mesh takes for granted.

#include <gtest/gtest.h>

#include <map>

#include "tools/make_spacecraft/design.h"

namespace spacecraft {
namespace {

// Six times the volume that patches enclose (the divergence theorem over their triangles): below zero where
// they face inwards.
double enclosed(const std::vector<Patch>& patches, std::size_t first, std::size_t count) {
    Surface surface;
    for (std::size_t i = first; i < first + count; ++i) append(patches[i], 0, surface);
    const Vec3d from = hilcam::to_double(surface.positions[0]);
    double sum = 0;
    for (const auto& [a, b, c] : surface.triangles)
        sum += dot(hilcam::to_double(surface.positions[a]) - from,
                   cross(hilcam::to_double(surface.positions[b]) - from,
                         hilcam::to_double(surface.positions[c]) - from));
    return sum;
}

// The middle of a patch and the direction in which it faces there.
std::pair<Vec3d, Vec3d> middle_of(const Patch& patch) {
    constexpr double kStep = 1e-4;
    const Vec3d at = patch.at(0.5, 0.5);
    return {at, normalized(cross(patch.at(0.5 + kStep, 0.5) - at, patch.at(0.5, 0.5 + kStep) - at))};
}

TEST(SpacecraftDesign, PanelsOfBothWingsAreClosedOutwards) {
    const std::vector<Patch> patches = design({});
    std::map<std::string, int> boxes;
    for (std::size_t i = 0; i < patches.size(); ++i) {
        if (patches[i].material != "panel_back" || !patches[i].part.starts_with("wing")) continue;
        EXPECT_NEAR(enclosed(patches, i, 6), 6 * 2.4 * 2.45 * 0.028, 1e-4) << patches[i].part << i;
        ++boxes[patches[i].part];
        i += 5;
    }
    EXPECT_EQ(boxes["wing_north"], 4);
    EXPECT_EQ(boxes["wing_south"], 4);
}

TEST(SpacecraftDesign, DishesFaceTheirFeeds) {
    int dishes = 0;
    for (const Patch& patch : design({})) {
        if (patch.part != "dish" || (patch.material != "dish_white" && patch.material != "panel_back"))
            continue;
        const auto [at, facing] = middle_of(patch);
        const bool rim = std::abs(facing.z) < 0.5;
        if (rim) continue;
        EXPECT_EQ(facing.z > 0, patch.material == "dish_white");
        ++dishes;
    }
    EXPECT_EQ(dishes, 4);
}

// Circles about their axis, on either side of the deck.
TEST(SpacecraftDesign, BafflesAreRound) {
    int baffles = 0;
    for (const Patch& patch : design({})) {
        if (patch.part != "star_trackers") continue;
        const Vec3d middle = 0.5 * (patch.at(0, 0.5) + patch.at(0.5, 0.5));
        for (const double u : {0.1, 0.3, 0.6, 0.9})
            EXPECT_NEAR(length(patch.at(u, 0.5) - middle), length(patch.at(0, 0.5) - middle), 1e-9) << u;
        const auto [at, facing] = middle_of(patch);
        EXPECT_GT(dot(facing, at - middle), 0);
        ++baffles;
    }
    EXPECT_EQ(baffles, 2);
}

}  // namespace
}  // namespace spacecraft
