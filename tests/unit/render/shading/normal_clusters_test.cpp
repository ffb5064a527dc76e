#include "render/shading/normal_clusters.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <vector>

#include "render/brdf/microfacet.h"
#include "tests/support/vector_widths.h"

namespace hilcam {
namespace {

constexpr float kAlpha = 0.2f;

Material material_of(std::size_t model) {
    MaterialConfig config;
    config.model = model;
    config.reflectance = Curve::constant(0.7);
    config.roughness = 0.6;
    return make_material(config, SpectralGrid({0.5, 0.6, 0.7}));
}

// Shading points of several materials and of two objects, each with some facets, of which half stand for others.
struct Foil {
    static constexpr std::size_t kVertices = 60, kFacets = 7;
    std::vector<Material> materials = {material_of(kModel<brdf::Metal>), material_of(kModel<brdf::Lambert>),
                                       material_of(kModel<brdf::Dielectric>),
                                       material_of(kModel<brdf::OrenNayar>)};
    FrameContext frame;
    std::vector<LodNormals> flattened;
    std::vector<NormalCluster> facets;
    std::vector<ShadingPoint> points;
    std::vector<SunlitPoint> sunny;

    Foil() {
        std::mt19937 engine(7);
        std::normal_distribution<float> any;
        const auto about = [&](float spread) {
            return normalized(Vec3f{spread * any(engine), spread * any(engine), 1});
        };
        const Mat3f plain{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
            turned{{0, -0.6f, 0.8f}, {1, 0, 0}, {0, 0.8f, 0.6f}};
        frame.world_from_body = {plain, turned};
        flattened.reserve(kVertices * kFacets), facets.reserve(kVertices * kFacets), points.resize(kVertices);
        for (std::size_t v = 0; v < kVertices; ++v) {
            ShadingPoint& at = points[v];
            at.object = static_cast<std::uint32_t>(v % 2),
            at.surface_number = static_cast<std::uint16_t>(v % 4);
            at.back = v % 3 == 0;
            const Material& material = materials[v % 4];
            at.surface = {&material, material.has_facets() ? kAlpha : 0, material.base, material.highlight};
            at.view_dir = about(0.7f), at.throughput.bin.fill(0.5f);
            for (std::size_t k = 0; k <= v % kFacets; ++k) {
                NormalCluster facet;
                facet.geometric_normal = about(1.0f), facet.normal = about(1.0f);
                facet.samples = 1 + static_cast<float>(k);
                if (k % 2 == 0) {
                    std::array<LodNormals::Normal, LodNormals::kMax> parts{};
                    for (LodNormals::Normal& part : parts)
                        part = {0.5f * Vec3f{any(engine), any(engine), any(engine)}, 0.25f};
                    flattened.push_back(LodNormals::of(parts, k % 4 == 0 ? 0.3f : 0.0f));
                    facet.flattened = &flattened.back();
                }
                facet.next = at.clusters;
                facets.push_back(facet);
                at.clusters = &facets.back();
            }
            sunny.push_back({&at, about(0.7f), at.surface.alpha});
        }
    }
    std::vector<ClusterLight> lit() const {
        std::vector<ClusterLight> out(sunny.size());
        lit_clusters(frame, sunny, out);
        return out;
    }
    // What one facet reflects, part by part, times its samples.
    Spectrum reflected(const SunlitPoint& from, const NormalCluster& facet) const {
        const ShadingPoint& at = *from.at;
        LodNormals::Leans lean{};
        LodNormals::Floats share{1}, seen{}, no{}, ni{};
        if (facet.flattened) lean = facet.flattened->leans(), share = facet.flattened->shares();
        Vec3f area{};
        float all_seen = 0, all_lit = 0;
        for (std::size_t j = 0; j < LodNormals::kMax; ++j) {
            const Vec3f own = (at.back ? -1.0f : 1.0f) * Vec3f{lean.x[j], lean.y[j], lean.z[j]};
            const Vec3f normal = normalized(facet.normal + frame.world_from_body[at.object] * own);
            const float length_of = length(facet.normal + frame.world_from_body[at.object] * own);
            no[j] = dot(normal, at.view_dir), ni[j] = std::max(dot(normal, from.dir), 0.0f);
            seen[j] = share[j] * std::max(no[j], 0.0f), no[j] = std::max(no[j], 1e-4f);
            area = area + share[j] * normal;
            all_seen += seen[j], all_lit += share[j] * ni[j];
            EXPECT_GT(length_of, 1e-3f);
        }
        const float flat = dot(facet.geometric_normal, from.dir);
        float each = facet.samples;
        if (facet.flattened && flat > 0 && all_lit > 0) each *= std::min(flat * length(area) / all_lit, 2.0f);
        Spectrum sum;
        for (std::size_t j = 0; j < LodNormals::kMax; ++j) {
            const float weight = each * (all_seen > 0 ? seen[j] / all_seen : share[j]) * ni[j];
            Bsdf surface = at.surface;
            surface.alpha = widened(from, facet, no[j], ni[j]);
            sum += weight * brdf_value(surface, {no[j], ni[j], dot(at.view_dir, from.dir)});
        }
        return sum;
    }
    static float widened(const SunlitPoint& from, const NormalCluster& facet, float no, float ni) {
        if (!(from.alpha > 0) || !facet.flattened) return from.alpha;
        const float own = from.alpha * from.alpha,
                    rougher = facet.flattened->alpha() * facet.flattened->alpha();
        const float nh = half_vector({no, ni, dot(from.at->view_dir, from.dir)}).nh;
        const float slope = (1 - nh * nh) / (nh * nh), both = own + rougher;
        return std::min(std::sqrt(own + rougher * 4 * both / (2 * both + slope)), 1.0f);
    }
};

TEST(NormalClusters, PacketsReflectWhatTheirFacetsDoOneByOne) {
    const Foil foil;
    const std::vector<ClusterLight> lit = foil.lit();
    for (std::size_t v = 0; v < Foil::kVertices; ++v) {
        const ShadingPoint& at = foil.points[v];
        Spectrum sum;
        float samples = 0, brightest = 0;
        for (const NormalCluster* facet = at.clusters; facet; facet = facet->next) {
            samples += facet->samples;
            if (!facet->flattened && dot(facet->geometric_normal, foil.sunny[v].dir) <= 0) continue;
            const Spectrum light = foil.reflected(foil.sunny[v], *facet);
            sum += light;
            brightest = std::max(brightest, std::accumulate(light.bin.begin(), light.bin.end(), 0.0f));
        }
        const float expected = 0.5f / samples * sum[0];
        EXPECT_NEAR(lit[v].reflected[0], expected, 1e-4f * expected + 1e-7f) << v;
        EXPECT_NEAR(lit[v].share[0], brightest, 1e-4f * brightest + 1e-6f) << v;
    }
}

TEST(NormalClusters, EveryWidthOfVectorsReflectsTheSame) {
    const Foil foil;
    expect_same_by_any_width([&] {
        std::vector<float> all;
        for (const ClusterLight& light : foil.lit()) {
            all.push_back(light.reflected[0]), all.push_back(light.reflected[1]);
            all.insert(all.end(), light.share.begin(), light.share.end());
        }
        return all;
    });
}

// Two facets in a pixel, as large and as much in the light: the one in its right half mirrors it to the viewer. So that is where
// light comes from, and where rays begin that ask for shadows.
TEST(NormalClusters, LightComesFromTheFacetThatReflectsIt) {
    const Material metal = material_of(kModel<brdf::Metal>);
    FrameContext frame;
    frame.world_from_body = {Mat3f{}};
    frame.samples = PixelSamples(8);
    constexpr SampleMask kLeft = 0x0000FFFF0000FFFF, kRight = ~kLeft;
    const Vec3f up{0, 0, 1}, dir = normalized(Vec3f{-0.4f, 0, 1});
    // It leans aside, by as much to the light.
    const Vec3f aside = normalized(Vec3f{-0.19f, 0.6f, 1});
    const NormalCluster left{up, aside, {}, 8, kLeft}, right{up, up, {}, 8, kRight, nullptr, false, &left};
    ShadingPoint at{};
    at.view_dir = normalized(Vec3f{0.4f, 0, 1});
    at.throughput.bin.fill(1);
    at.surface = {&metal, 0.04f, metal.base, metal.highlight};
    at.clusters = &right;
    const SunlitPoint sunny{&at, dir, 0.04f};
    ClusterLight light;
    lit_clusters(frame, {&sunny, 1}, {&light, 1});
    EXPECT_EQ(light.brightest[0], &right);
    EXPECT_GT(light.share[0], 100 * light.share[1]);
    EXPECT_NEAR(light.moments.across, 1, 0.02);
    EXPECT_NEAR(light.moments.down, 0, 1e-6);
}

}  // namespace
}  // namespace hilcam
