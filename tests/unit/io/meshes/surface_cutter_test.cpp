// Triangles that are cut along a picture: what is kept of them is where the picture says so, whatever way it goes on beyond its edge, and
// no part is lost or there twice.
#include "io/meshes/surface_cutter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace hilcam {
namespace {

constexpr int kPictureSize = 16;

// A picture of noise: about half of its texels are there.
KindSource noise(std::uint32_t seed, std::array<TextureWrap, 2> wrap) {
    std::mt19937 random(seed);
    KindSource source;
    source.alpha = {kPictureSize, kPictureSize, {}};
    for (int i = 0; i < kPictureSize * kPictureSize; ++i)
        source.alpha.values.push_back(random() % 2 == 0 ? 0 : 255);
    source.wrap = wrap;
    source.smooth = false;
    return source;
}

// A triangle of 2 m2 with normals and colours, whose corners lie anywhere in a field of four pictures by four.
Mesh triangle(std::uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> place(-2, 2);
    Mesh mesh;
    mesh.vertices_m = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}};
    mesh.normals = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    mesh.colors = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (int i = 0; i < 3; ++i) mesh.uvs.push_back({place(random), place(random)});
    mesh.triangles = {{0, 1, 2}};
    mesh.surface_of_triangle = {0};
    mesh.surfaces.resize(2);
    return mesh;
}

double area_of_surface_m2(const Mesh& mesh, std::uint16_t surface) {
    double sum = 0;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
        if (mesh.surface_of_triangle[i] == surface) sum += area_vector(mesh, mesh.triangles[i]).z;
    return sum;
}

// The share of a triangle of which the picture says that it is there, by looks at many of its places.
double share_by_looks(const Mesh& mesh, const KindSource& source, int looks, std::mt19937& random) {
    std::uniform_real_distribution<double> one(0, 1);
    int there = 0;
    for (int i = 0; i < looks; ++i) {
        const double root = std::sqrt(one(random)), v = one(random) * root, u = root - v, w = 1 - root;
        const auto at = [&](auto part) {
            return w * part(mesh.uvs[0]) + u * part(mesh.uvs[1]) + v * part(mesh.uvs[2]);
        };
        const auto texel = [](double place) {
            return static_cast<std::int64_t>(std::floor(place * kPictureSize));
        };
        const int x = wrapped(texel(at([](Vec2f p) { return static_cast<double>(p.x); })), kPictureSize,
                              source.wrap[0]),
                  y = wrapped(texel(at([](Vec2f p) { return static_cast<double>(p.y); })), kPictureSize,
                              source.wrap[1]);
        there += source.alpha.at(x, y) >= source.cutoff;
    }
    return static_cast<double>(there) / looks;
}

TEST(SurfaceCutter, WhatIsKeptIsWhereThePictureSaysSo) {
    constexpr int kLooks = 20000;
    std::mt19937 random(1);
    for (const TextureWrap along : {TextureWrap::kRepeat, TextureWrap::kClamp, TextureWrap::kMirror})
        for (const TextureWrap down : {TextureWrap::kRepeat, TextureWrap::kClamp, TextureWrap::kMirror})
            for (std::uint32_t seed = 1; seed <= 4; ++seed) {
                const SurfaceCut cut{0, {1, 0}, noise(seed, {along, down}), {}};
                Mesh mesh = triangle(seed);
                const double share = share_by_looks(mesh, cut.source, kLooks, random);
                EXPECT_EQ(cut_surfaces(mesh, {&cut, 1}, 100000), 0);
                // All of it is there once, as one kind or the other, facing the same way.
                EXPECT_NEAR(area_of_surface_m2(mesh, 0) + area_of_surface_m2(mesh, 1), 2, 1e-4);
                // 4.5 standard errors: one false alarm in 4000 runs of these 36.
                const double error = std::sqrt(0.25 / kLooks);
                EXPECT_NEAR(area_of_surface_m2(mesh, 0) / 2, share, 4.5 * error) << seed;
            }
}

TEST(SurfaceCutter, NewCornersHaveTheirShareOfAllThatCornersHave) {
    const SurfaceCut cut{0, {SurfaceCut::kNothing, 0}, noise(3, {}), {}};
    Mesh mesh = triangle(3);
    cut_surfaces(mesh, {&cut, 1}, 100000);
    ASSERT_GT(mesh.triangles.size(), 20u);
    ASSERT_EQ(mesh.normals.size(), mesh.vertices_m.size());
    ASSERT_EQ(mesh.colors.size(), mesh.vertices_m.size());
    ASSERT_EQ(mesh.uvs.size(), mesh.vertices_m.size());
    for (std::size_t i = 0; i < mesh.vertices_m.size(); ++i) {
        const Vec3f p = mesh.vertices_m[i], share{1 - 0.5f * (p.x + p.y), 0.5f * p.x, 0.5f * p.y};
        EXPECT_LT(length(mesh.colors[i] - share), 1e-5f);
        EXPECT_LT(length(mesh.normals[i] - normalized(share)), 1e-4f);
        const Vec2f uv{share.x * mesh.uvs[0].x + share.y * mesh.uvs[1].x + share.z * mesh.uvs[2].x,
                       share.x * mesh.uvs[0].y + share.y * mesh.uvs[1].y + share.z * mesh.uvs[2].y};
        EXPECT_NEAR(mesh.uvs[i].x, uv.x, 1e-5f);
        EXPECT_NEAR(mesh.uvs[i].y, uv.y, 1e-5f);
    }
}

// Where the borders would make too many triangles the picture is taken coarser: at last it is of one kind.
TEST(SurfaceCutter, PicturesThatCostTooMuchAreTakenCoarser) {
    const SurfaceCut cut{0, {1, 0}, noise(5, {}), {}};
    for (const std::size_t most : {std::size_t{0}, std::size_t{30}, std::size_t{100000}}) {
        Mesh mesh = triangle(5);
        for (Vec2f& uv : mesh.uvs) uv = {1000 * uv.x, 1000 * uv.y};
        const int halvings = cut_surfaces(mesh, {&cut, 1}, most);
        EXPECT_GT(halvings, 0);
        EXPECT_LE(mesh.triangles.size(), 1 + most);
        EXPECT_NEAR(area_of_surface_m2(mesh, 0) + area_of_surface_m2(mesh, 1), 2, 1e-3);
    }
}

// A triangle that lies wholly in one kind stays as it is.
TEST(SurfaceCutter, TrianglesOfOneKindAreNotCut) {
    SurfaceCut cut{0, {1, 0}, {}, {}};
    cut.source.alpha = {2, 1, {0, 255}};
    cut.source.smooth = false;
    Mesh mesh = triangle(7);
    mesh.uvs = {{0.6f, 0.1f}, {0.9f, 0.1f}, {0.6f, 0.9f}};
    const Mesh before = mesh;
    cut_surfaces(mesh, {&cut, 1}, 100);
    EXPECT_EQ(mesh.triangles, before.triangles);
    EXPECT_EQ(mesh.vertices_m.size(), 3u);
    EXPECT_EQ(mesh.surface_of_triangle[0], 0);
}

TEST(KindPicture, TexelsBeyondTheEdgeAreFoundAsItGoesOn) {
    const auto row = [](TextureWrap wrap) {
        std::string out;
        for (int i = -4; i < 8; ++i) out += static_cast<char>('0' + wrapped(i, 4, wrap));
        return out;
    };
    EXPECT_EQ(row(TextureWrap::kRepeat), "012301230123");
    EXPECT_EQ(row(TextureWrap::kClamp), "000001233333");
    EXPECT_EQ(row(TextureWrap::kMirror), "321001233210");
}

// Metal and paint are told apart by one half, roughness by four bands; the mean of each that occurs is its look.
TEST(KindPicture, KindsAreTheLooksThatOccur) {
    KindSource source;
    source.metallic = {4, 1, {255, 255, 0, 255}};
    source.roughness = {4, 1, {10, 30, 255, 10}};
    source.metallic_factor = 0.8f;
    source.cutoff = 0;
    source.smooth = false;
    const std::vector<LookKind> kinds = kinds_of(source);
    ASSERT_EQ(kinds.size(), 2u);
    EXPECT_NEAR(kinds[0].metallic, 0.8f, 1e-6f);
    EXPECT_NEAR(kinds[0].roughness, 50 / 3.0f / 255, 1e-6f);
    EXPECT_NEAR(kinds[1].metallic, 0, 1e-6f);
    EXPECT_NEAR(kinds[1].roughness, 1, 1e-6f);
    EXPECT_EQ(kind_picture(source, kinds, 0).kinds, (std::vector<std::uint8_t>{1, 1, 2, 1}));
    // Halved, its right half is of 0.4 and so no metal.
    EXPECT_EQ(kind_picture(source, kinds, 1).kinds, (std::vector<std::uint8_t>{1, 2}));
    EXPECT_TRUE(kinds_of({}).empty());
}

}  // namespace
}  // namespace hilcam
