#include "render/visibility/screen_bounds.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

ImageGeometry geometry_of(double field_rad, LensDistortion distortion = {}) {
    constexpr int kSide_px = 256;
    const double half = std::tan(field_rad / 2);
    const double edge = distortion.none() ? half : distortion.distorted({half, 0}).x;
    return {kSide_px, kSide_px, 8, 0.5 * kSide_px / edge, distortion, {}};
}
// At an angle from the boresight, turned about it.
Vec3d direction_at(double from_boresight_rad, double about_rad) {
    return {std::sin(from_boresight_rad) * std::cos(about_rad),
            std::sin(from_boresight_rad) * std::sin(about_rad), std::cos(from_boresight_rad)};
}

// Pixels with the directions of their middles.
struct Place {
    int x, y;
    Vec3d dir;
};
std::vector<Place> places_of(const ImageGeometry& camera) {
    std::vector<Place> out;
    for (int y = 0; y < camera.padded_height(); y += 3)
        for (int x = 0; x < camera.padded_width(); x += 3)
            out.push_back(
                {x, y,
                 normalized(camera.direction_camera(x + 0.5 - camera.guard_px, y + 0.5 - camera.guard_px))});
    return out;
}

// The Sun at a right angle to the boresight: half of its disk is before the camera, and far beside the picture.
TEST(ScreenBounds, AreEmptyOfWhatPassesTheCamerasPlaneBesideThePicture) {
    const double sun_rad = 4.65e-3;
    for (int i = 0; i < 12; ++i)
        EXPECT_TRUE(
            screen_bounds_of_cone(geometry_of(0.6), {}, direction_at(kPi / 2, i * kPi / 6), std::cos(sun_rad))
                .empty());
}

TEST(ScreenBounds, HoldEveryPixelThatAConeCovers) {
    const std::vector<ImageGeometry> cameras{
        geometry_of(0.6), geometry_of(1.4), geometry_of(1.0, {.k1 = -0.2, .k2 = 0.05}),
        geometry_of(2.2, {.k1 = -0.02, .projection = Projection::kFisheye})};
    int not_empty = 0, not_all = 0;
    for (const ImageGeometry& camera : cameras) {
        const std::vector<Place> places = places_of(camera);
        for (int from = 0; from <= 18; ++from)
            for (int half = 1; half <= 8; ++half) {
                const Vec3d axis = direction_at(from * kPi / 18, 0.4 + from);
                const double cosine = std::cos(half * kPi / 18 - 0.01);
                const PixelBox box = screen_bounds_of_cone(camera, {}, axis, cosine);
                not_empty += box.empty() ? 0 : 1;
                not_all += box.overlaps({0, 0, 1, 1}) && box.overlaps({271, 271, 272, 272}) ? 0 : 1;
                for (const auto& [x, y, dir] : places) {
                    if (dot(dir, axis) < cosine) continue;
                    ASSERT_TRUE(box.overlaps({x, y, x + 1, y + 1}))
                        << from << ' ' << half << ' ' << x << ' ' << y;
                }
            }
    }
    EXPECT_GT(not_empty, 100);
    EXPECT_GT(not_all, 100);
}

// A wide body, part of it behind the camera, whose limb is seen at the picture's right.
TEST(ScreenBounds, EndWhereABodyThatPassesTheCamerasPlaneEnds) {
    const PixelBox box =
        screen_bounds_of_cone(geometry_of(0.6), {}, direction_at(kPi / 2 - 0.1, 0), std::cos(kPi / 2 - 0.3));
    EXPECT_EQ(box.x1, 272);
    EXPECT_GT(box.x0, 272 / 2);
    EXPECT_FALSE(box.empty());
}

}  // namespace
}  // namespace hilcam
