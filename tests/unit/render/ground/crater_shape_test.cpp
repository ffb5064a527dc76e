#include "render/ground/crater_shape.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/support/ground_maps.h"
#include "tests/support/vector_widths.h"

namespace hilcam {
namespace {

// A square of ground of so many places, 10 m apart, and a crater of 40 m radius beside its middle.
struct Square {
    CraterProfile profile;
    CraterShape crater;
    std::vector<Vec3d> places;
    std::vector<double> heights_m;
    std::vector<Vec3f> colors;
    int side;

    explicit Square(int side_of) : side(side_of) {
        const Vec3d middle = place_on_sphere(30, 20);
        const auto [east, north] = axes_along(middle);
        const auto at = [&](double x_m, double y_m) {
            return normalized(middle + x_m / kMoonRadius_m * east + y_m / kMoonRadius_m * north);
        };
        for (int y = 0; y < side; ++y)
            for (int x = 0; x < side; ++x) places.push_back(at(10.0 * (x - side / 2), 10.0 * (y - side / 2)));
        heights_m.assign(places.size(), 0), colors.assign(places.size(), Vec3f{1, 1, 1});
        crater.place = at(33, -21), crater.axes = axes_along(crater.place);
        crater.radius_m = 40, crater.body_radius_m = kMoonRadius_m, crater.depth_m = 16;
        crater.profile = profile.at(0.05);
    }
    void add() {
        const GroundPatch patch{
            side, places, heights_m, colors, places[places.size() / 2], 10.0 * side / kMoonRadius_m, 10};
        add_crater(crater, patch);
    }
};

TEST(CraterShape, IsTheSameWithVectorsOfAnyWidth) {
    expect_same_by_any_width([] {
        Square square(41);
        square.crater.wave_cos = {0.02, -0.01, 0.01, 0}, square.crater.wave_sin = {0.01, 0.02, 0, -0.01};
        square.crater.bright = 0.5;
        square.add();
        std::vector<double> out = square.heights_m;
        for (const Vec3f& color : square.colors) out.push_back(static_cast<double>(color.y));
        return out;
    });
}

// A round crater has its profile's heights at each place of a patch of any width, and nothing beyond its reach.
TEST(CraterShape, ARoundCraterHasItsProfile) {
    for (const int side : {3, 5, 11, 41}) {
        Square square(side);
        square.add();
        for (std::size_t i = 0; i < square.places.size(); ++i) {
            const double radii =
                length(square.places[i] - square.crater.place) * kMoonRadius_m / square.crater.radius_m;
            EXPECT_NEAR(square.heights_m[i], square.crater.depth_m * square.profile.height(radii, 0.05), 1e-9)
                << side << ' ' << i;
            EXPECT_EQ(square.colors[i].x, 1.0f);
        }
    }
}

// Rays brighten the ground out to six radii, most within the rim, and darken none.
TEST(CraterShape, RaysBrighten) {
    Square square(61);
    square.crater.bright = 0.5;
    square.add();
    int bright = 0;
    for (std::size_t i = 0; i < square.places.size(); ++i) {
        const double radii =
            length(square.places[i] - square.crater.place) * kMoonRadius_m / square.crater.radius_m;
        const float color = square.colors[i].x;
        if (radii < 0.99) {
            EXPECT_NEAR(color, 1.3f, 1e-6f);
        }
        if (radii > 6) {
            EXPECT_EQ(color, 1.0f);
        }
        EXPECT_GE(color, 1.0f);
        bright += radii > 1.01 && color > 1.02f ? 1 : 0;
    }
    EXPECT_GT(bright, 100);
}

}  // namespace
}  // namespace hilcam
