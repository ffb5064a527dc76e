#include "render/glossy/glossy_reuse.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <random>

#include "render/brdf/microfacet.h"

namespace hilcam {
namespace {

Spectrum even(float value) {
    Spectrum out;
    out.bin.fill(value);
    return out;
}

// A plane of metal that faces the camera, 32 x 32 px of a millimetre each, with one ray a pixel.
struct Plane {
    static constexpr int kSize = 32;
    GlossyBuffer buffer{kSize, kSize, 1, kSize* kSize};
    GlossyBuffer::Part& part = buffer.begin(0, {0, 0, kSize, kSize}, 1);

    // met: what a ray from a point meets in a direction.
    struct Met {
        float light = 0;
        bool free = true;
        Vec3f place_m{};
        float towards = 0;
    };
    using Scene = std::function<Met(Vec3f point_m, Vec3f dir)>;

    explicit Plane(float alpha, const Scene& scene) {
        for (int y = 0; y < kSize; ++y)
            for (int x = 0; x < kSize; ++x) add(alpha, x, y, scene);
        buffer.link(part);
    }
    void add(float alpha, int x, int y, const Scene& scene) {
        GlossyPoint& point = *part.add_point();
        point = {};
        point.point_m = {1e-3f * static_cast<float>(x), 1e-3f * static_cast<float>(y), 0};
        point.normal = {0, 0, 1}, point.view_dir = normalized(Vec3f{0.5f, 0, 1});
        point.alpha = alpha, point.footprint_m = 1e-3f;
        point.surface = static_cast<std::uint16_t>(x >= kSize - 4 ? 1 : 0);
        point.pixel = static_cast<std::uint32_t>(y * kSize + x);
        point.weight = even(0.9f), point.cached = even(5), point.directions = 0, point.share = 1;
        point.bodies[0] = even(2), point.free[0] = 0.3f;
        point.reach_px = kGlossyPattern_px;
        const GlossyPlace place = glossy_place(x, y, 0, kGlossyPattern_px);
        const Frame local(point.normal);
        const Vec3f facet =
            local.to_world(sample_visible_normal(alpha, local.to_local(point.view_dir), place.u1, place.u2));
        const Vec3f dir = normalized(reflect(point.view_dir, facet));
        if (dir.z <= 0) return;
        GlossyRay& ray = *part.add_ray(point);
        const Met met = scene(point.point_m, dir);
        ray.met_m = dir, ray.light = even(met.light);
        if (!met.free) ray.set_met(met.place_m);
        ray.per_density_sr = 1 / ggx_density(alpha, dot(point.normal, point.view_dir), facet.z);
        ray.towards[0] = met.towards;
    }
    const GlossyPoint& point(int x, int y) const {
        return buffer.part(0).points()[static_cast<std::size_t>(y * kSize + x)];
    }
    GlossyLight light(int x, int y) const { return reused_light(buffer, point(x, y), x, y); }
    float error(int x, int y, const PixelBox& within = {0, 0, kSize, kSize}) const {
        return glossy_error(buffer, point(x, y), x, y, within);
    }
};

TEST(GlossyReuse, LightFromEverywhereIsTheLobesAlbedo) {
    for (const float alpha : {0.05f, 0.2f, 0.6f}) {
        const Plane plane(alpha, [](Vec3f point, Vec3f dir) {
            return Plane::Met{10, false, point + 100.0f * dir};
        });
        EXPECT_NEAR(plane.light(13, 17).surfaces[0], 9, 1e-3) << alpha;
        EXPECT_NEAR(plane.light(0, 0).surfaces[0], 9, 1e-3) << "in the picture's corner";
    }
}

// Half of what a lobe sees is lit, at a distance: the share is that of a sum over 200 x 200 of its directions, and it changes little
// from pixel to pixel, wherever these are in the pattern. Of N stratified places an edge is off by N^-0.75, 4 % of 64 (Mitchell, SIGGRAPH
// 96), and twice that is rare; places at random would be off by 11 %.
TEST(GlossyReuse, AnEdgeIsSmoothAndInPlace) {
    constexpr float kWidth = 0.2f;
    const auto is_lit = [](Vec3f dir) { return dir.x < -0.3f; };
    const Plane plane(kWidth, [&](Vec3f point, Vec3f dir) {
        return Plane::Met{is_lit(dir) ? 100.0f : 0.0f, false, point + 100.0f * dir};
    });
    const Vec3f view = normalized(Vec3f{0.5f, 0, 1});
    double lit = 0, all = 0;
    for (int i = 0; i < 200 * 200; ++i) {
        const Vec3f facet = sample_visible_normal(kWidth, view, (static_cast<float>(i % 200) + 0.5f) / 200,
                                                  (static_cast<float>(i / 200) + 0.5f) / 200);
        const Vec3f dir = reflect(view, facet);
        if (dir.z <= 0) continue;
        const double weight = static_cast<double>(ggx_sample_weight(kWidth, view.z, dir.z));
        all += weight, lit += is_lit(dir) ? weight : 0;
    }
    const double expected = 90 * lit / all;
    float least = 1e9f, most = 0;
    for (int y = 8; y < 20; ++y)
        for (int x = 8; x < 20; ++x) {
            const float light = plane.light(x, y).surfaces[0];
            least = std::min(least, light), most = std::max(most, light);
        }
    EXPECT_NEAR(least, expected, 0.08 * expected);
    EXPECT_NEAR(most, expected, 0.08 * expected);
    EXPECT_LT(most - least, 0.04f * most);
}

// Each ray meets light or none by chance: the error that a lobe's rays tell is the spread of its light between 200 pictures, which
// is known to 5 %.
TEST(GlossyReuse, TheErrorIsTheSpreadOfTheLight) {
    constexpr int kPictures = 200;
    double sum = 0, squares = 0, told = 0, told_by_some = 0;
    for (int picture = 0; picture < kPictures; ++picture) {
        std::mt19937 random(static_cast<std::uint32_t>(picture));
        const Plane plane(0.2f, [&](Vec3f point, Vec3f dir) {
            return Plane::Met{(random() & 1) != 0 ? 100.0f : 0.0f, false, point + 100.0f * dir};
        });
        const double light = static_cast<double>(plane.light(16, 16).surfaces[0]);
        sum += light, squares += light * light;
        told += static_cast<double>(plane.error(16, 16)) / kPictures;
        told_by_some += static_cast<double>(plane.error(16, 16, {13, 13, 20, 20})) / kPictures;
    }
    const double mean = sum / kPictures, spread = std::sqrt(squares / kPictures - mean * mean);
    EXPECT_NEAR(mean, 45, 3 * spread / std::sqrt(kPictures));
    EXPECT_NEAR(told, spread, 0.15 * spread);
    EXPECT_GT(told_by_some, 1.5 * told) << "49 of some 200 rays";
}

// The same for a body that half of the rays see.
TEST(GlossyReuse, ABodyThatIsHiddenHereAndThereHasAnError) {
    const auto error = [](std::uint32_t mask) {
        std::mt19937 random(1);
        const Plane plane(0.2f, [&](Vec3f point, Vec3f dir) {
            const bool hidden = (random() & mask) != 0;
            return Plane::Met{0, !hidden, hidden ? point + 100.0f * dir : Vec3f{}, 1};
        });
        return plane.error(16, 16);
    };
    // Half of 2, by the square root of some 100 rays; the cache's light of 5 counts as a ray.
    EXPECT_NEAR(error(1), 0.11f, 0.04f);
    EXPECT_LT(error(0), 0.06f);
}

TEST(GlossyReuse, EvenLightHasNoError) {
    const Plane plane(0.2f, [](Vec3f point, Vec3f dir) {
        return Plane::Met{5 / 0.9f, false, point + 100.0f * dir};
    });
    EXPECT_LT(plane.error(16, 16), 1e-2f);
}

TEST(GlossyReuse, OtherSurfacesAreNotAsked) {
    const Plane plane(0.2f, [](Vec3f point, Vec3f dir) {
        const bool other = point.x > 1e-3f * (Plane::kSize - 4.5f);
        return Plane::Met{other ? 1000.0f : 10.0f, false, point + 100.0f * dir};
    });
    EXPECT_NEAR(plane.light(Plane::kSize - 5, 16).surfaces[0], 9, 1e-3);
    EXPECT_NEAR(plane.light(Plane::kSize - 4, 16).surfaces[0], 900, 0.1);
}

// A body fills a half of the sky, of which another half is hidden: what is free of it counts by its radiance.
TEST(GlossyReuse, BodiesAreSeenWhereNothingIsInTheWay) {
    const Plane plane(0.3f, [](Vec3f point, Vec3f dir) {
        const bool hidden = dir.y < 0;
        return Plane::Met{0, !hidden, hidden ? point + 100.0f * dir : Vec3f{}, 1};
    });
    // By symmetry a half, and a little of the cache's 0.3.
    EXPECT_NEAR(plane.light(16, 16).bodies[0], 2 * 0.5f, 0.03f);
}

// What stands a pixel's width above the surface is met by the rays that begin below it, and not by those beside it.
TEST(GlossyReuse, WhatStandsNearIsSeenByNeighboursNoFurtherThanItStands) {
    const auto under = [](Vec3f point) { return point.x > 10.5e-3f; };
    const Plane plane(0.5f, [&](Vec3f point, Vec3f dir) {
        return under(point) ? Plane::Met{100, false, point + 1e-3f * dir} : Plane::Met{};
    });
    EXPECT_GT(plane.light(14, 16).surfaces[0], 80) << "four pixels in";
    EXPECT_LT(plane.light(5, 16).surfaces[0], 10) << "five pixels out";
}

TEST(GlossyReuse, WithoutRaysTheCacheHasTheLight) {
    GlossyBuffer buffer(4, 4, 1, 16);
    GlossyBuffer::Part& part = buffer.begin(0, {0, 0, 4, 4}, 1);
    GlossyPoint& point = *part.add_point();
    point = {};
    point.normal = point.view_dir = {0, 0, 1};
    point.alpha = 0.2f, point.cached = even(5), point.share = 1, point.reach_px = 8;
    point.bodies[1] = even(2), point.free[1] = 0.25f;
    const GlossyLight light = reused_light(buffer, point, 0, 0);
    EXPECT_EQ(light.surfaces[0], 5);
    EXPECT_EQ(light.bodies[0], 0.5f);
}

// Any window of 8 x 8 px with a ray each, or of 4 x 4 px with four, has each place of the pattern once, and each coordinate in 64
// different strips.
TEST(GlossyPlace, EachWindowHasAllOfThePattern) {
    for (const int size : {8, 4})
        for (const int corner : {0, 3, 13}) {
            const int rays = 64 / (size * size);
            std::array<int, 64> squares{}, strips{};
            for (int i = 0; i < size * size; ++i)
                for (int ray = 0; ray < rays; ++ray) {
                    const GlossyPlace place =
                        glossy_place(corner + i % size, 2 * corner + i / size, ray, size);
                    ++squares[static_cast<std::size_t>(static_cast<int>(8 * place.u1) +
                                                       8 * static_cast<int>(8 * place.u2))];
                    ++strips[static_cast<std::size_t>(64 * place.u1)];
                }
            for (const int count : squares) EXPECT_EQ(count, 1) << rays;
            for (const int count : strips) EXPECT_EQ(count, 1) << rays;
        }
}

}  // namespace
}  // namespace hilcam
