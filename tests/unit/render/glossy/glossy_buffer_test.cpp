#include "render/glossy/glossy_buffer.h"

#include <gtest/gtest.h>

#include <set>

namespace hilcam {
namespace {

GlossyRay& add_ray(GlossyBuffer::Part& part, std::uint32_t pixel) {
    GlossyPoint* const point = part.add_point();
    point->pixel = pixel;
    return *part.add_ray(*point);
}
std::size_t rays_at(const GlossyBuffer& buffer, int x, int y) {
    std::size_t count = 0;
    buffer.for_each_ray(x, y, [&](const GlossyStart&, const GlossyRay&) { ++count; });
    return count;
}

TEST(GlossyBuffer, RaysAreFoundAtTheirPixelsWhenAllHaveComeBack) {
    GlossyBuffer buffer(8, 4, 2, 16);
    GlossyBuffer::Part& right = buffer.begin(1, {4, 0, 8, 4}, 1);
    add_ray(right, 1 * 4 + 2);  // x 6, y 1
    add_ray(right, 1 * 4 + 2);
    EXPECT_EQ(rays_at(buffer, 6, 1), 0U);
    buffer.link(right);
    EXPECT_EQ(rays_at(buffer, 6, 1), 2U);
    EXPECT_EQ(rays_at(buffer, 2, 1), 0U);
}

// Rays that come after others have been linked join them, and each light becomes a radiance once.
TEST(GlossyBuffer, LaterRaysJoinThoseThatAreLinked) {
    GlossyBuffer buffer(4, 4, 1, 16);
    GlossyBuffer::Part& part = buffer.begin(0, {0, 0, 4, 4}, 1);
    GlossyPoint* const point = part.add_point();
    point->pixel = 5, point->per_light = 2;
    for (int round = 1; round < 4; ++round) {
        part.add_ray(*point)->light[0] = 3;
        buffer.link(part);
        EXPECT_EQ(rays_at(buffer, 1, 1), static_cast<std::size_t>(round));
        buffer.for_each_ray(1, 1,
                            [](const GlossyStart&, const GlossyRay& ray) { EXPECT_EQ(ray.light[0], 6); });
    }
}

TEST(GlossyBuffer, APartThatBeginsAnewHasNothingOfTheFrameBefore) {
    GlossyBuffer buffer(4, 4, 1, 16);
    add_ray(buffer.begin(0, {0, 0, 4, 4}, 1), 5);
    buffer.link(buffer.begin(0, {0, 0, 4, 4}, 1));
    EXPECT_EQ(rays_at(buffer, 1, 1), 0U);
    GlossyBuffer::Part& part = buffer.begin(0, {0, 0, 4, 4}, 1);
    add_ray(part, 5);
    buffer.link(part);
    EXPECT_EQ(rays_at(buffer, 1, 1), 1U);
    buffer.skip(0);
    EXPECT_EQ(rays_at(buffer, 1, 1), 0U);
    EXPECT_TRUE(buffer.part(0).points().empty());
}

TEST(GlossyBuffer, APartWithoutRoomSaysSo) {
    GlossyBuffer buffer(2, 1, 1, 2);
    GlossyBuffer::Part& part = buffer.begin(0, {0, 0, 2, 1}, 1);
    EXPECT_NE(part.add_point(), nullptr);
    GlossyPoint* const last = part.add_point();
    ASSERT_NE(last, nullptr);
    EXPECT_EQ(part.add_point(), nullptr);
    std::set<GlossyRay*> rays;
    while (GlossyRay* const ray = part.add_ray(*last)) rays.insert(ray);
    EXPECT_EQ(rays.size(), 8U) << "four for each sample";
    for (const GlossyRay* ray : rays) EXPECT_EQ(&part.point_of(*ray), last);
}

}  // namespace
}  // namespace hilcam
