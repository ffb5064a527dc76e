// Albedos as surfaces see them: what the painted texture gives at points of facets.

#include "io/meshes/albedo_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "render/scene/color_bands.h"
#include "tests/support/files.h"

namespace hilcam {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

// Two facets of a square, areas 1 and 3 m^2.
Mesh two_facets() {
    Mesh mesh;
    mesh.surfaces.resize(1);
    mesh.vertices_m = {{0, 0, 0}, {2, 0, 0}, {0, 1, 0}, {0, -3, 0}};
    mesh.normals.assign(4, {0, 0, 1});
    mesh.triangles = {{0, 1, 2}, {0, 3, 1}};
    mesh.surface_of_triangle = {0, 0};
    return mesh;
}

// Returns the albedo at a place in a triangle as the renderer does: the texture at the corners' interpolated coordinates.
float factor_at(const Mesh& mesh, std::size_t triangle, float u, float v) {
    const MipTexture texture(mesh.textures.at(0));
    const auto& t = mesh.triangles[triangle];
    const auto along = [&](auto part) {
        return (1 - u - v) * part(mesh.uvs[t[0]]) + u * part(mesh.uvs[t[1]]) + v * part(mesh.uvs[t[2]]);
    };
    return texture.sample(along([](Vec2f p) { return p.x; }), along([](Vec2f p) { return p.y; }), 0).y;
}

class AlbedoFile : public FilesTest {};

TEST_F(AlbedoFile, HasANumberALine) {
    EXPECT_THAT(parse_albedos("# Bennu\n0.04\n\n  5e-2 \r\n+1\n", "a.txt"), ElementsAre(0.04f, 0.05f, 1.0f));
    EXPECT_THAT(read_albedos(write("a.txt", "1\n0\n")), ElementsAre(1.0f, 0.0f));
    EXPECT_THAT(error_of([] { parse_albedos("1\nhalf\n", "a.txt"); }),
                HasSubstr("a.txt:2: found 'half'; accepted: an albedo, 0 to 1000000"));
    EXPECT_THAT(error_of([] { parse_albedos("-0.1", "a.txt"); }), HasSubstr("a.txt:1: found '-0.1'"));
    EXPECT_THAT(error_of([] { parse_albedos("nan", "a.txt"); }), HasSubstr("a.txt:1: found 'nan'"));
    EXPECT_THAT(error_of([] { parse_albedos("# none\n", "a.txt"); }), HasSubstr("has no albedo"));
}

TEST_F(AlbedoFile, FacetsHaveTheirsAllOver) {
    for (const float other : {0.0f, 1e-4f, 0.0123f, 0.2f, 0.77777f, 0.99999f}) {
        Mesh mesh = two_facets();
        const double brightest = paint_albedos(mesh, {0.05f, 0.05f * other}, {}, "a.txt");
        // The mean by area is that of the materials as they are.
        EXPECT_NEAR(brightest, 1 / (0.25 + 0.75 * static_cast<double>(other)), 1e-6);
        for (const float u : {0.0f, 0.3f, 1.0f}) {
            EXPECT_NEAR(factor_at(mesh, 0, u, 0.0f), 1, 1e-6);
            EXPECT_NEAR(factor_at(mesh, 1, u, 0.0f), other, 2e-6) << other;
        }
        // The shape stays.
        EXPECT_EQ(mesh.vertices_m.size(), 6u);
        EXPECT_EQ(mesh.vertices_m[mesh.triangles[1][1]].y, -3);
        EXPECT_EQ(mesh.normals.size(), 6u);
    }
}

TEST_F(AlbedoFile, VerticesHaveTheirsAndFacetsWhatLiesBetween) {
    Mesh mesh = two_facets();
    EXPECT_NEAR(paint_albedos(mesh, {0.1f, 0.15f, 0.12f, 0.1f}, 0.1, "a.txt"), 1.5, 1e-6);
    EXPECT_EQ(mesh.vertices_m.size(), 4u);
    EXPECT_NEAR(factor_at(mesh, 0, 0, 0), 1 / 1.5, 1e-6);
    EXPECT_NEAR(factor_at(mesh, 0, 1, 0), 1, 1e-6);
    EXPECT_NEAR(factor_at(mesh, 0, 0, 1), 1.2 / 1.5, 1e-6);
    // The ramp lies at most 1.3 % below the line from 1 to 1.5.
    const double middle = static_cast<double>(factor_at(mesh, 0, 0.5f, 0)) * 1.5 / 1.25;
    EXPECT_LT(middle, 1);
    EXPECT_GT(middle, 0.987);
}

TEST_F(AlbedoFile, WhatDoesNotFitIsNamed) {
    const auto refusal = [this](Mesh mesh, const std::vector<float>& albedos) {
        return error_of([&] { paint_albedos(mesh, albedos, {}, "a.txt"); });
    };
    EXPECT_THAT(
        refusal(two_facets(), {1, 1, 1}),
        HasSubstr("a.txt: found 3 albedos; accepted: 2, one for each facet, or 4, one for each vertex"));
    EXPECT_THAT(refusal(two_facets(), {0, 0}), HasSubstr("all albedos are 0"));
    Mesh textured = two_facets();
    textured.textures.resize(1);
    EXPECT_THAT(refusal(textured, {1, 1}), HasSubstr("the mesh has textures"));
}

}  // namespace
}  // namespace hilcam
