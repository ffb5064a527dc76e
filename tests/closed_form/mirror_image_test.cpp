// What a flat mirror shows of the parts about it, where light is cached, against random paths.

#include <gtest/gtest.h>

#include <cmath>

#include "render/scene/brdf.h"
#include "tests/support/stage.h"

namespace hilcam {
namespace {

MaterialConfig metal(double roughness, double reflectance = 0.9) {
    MaterialConfig m;
    m.model = kModel<brdf::Metal>;
    m.reflectance = Curve::constant(reflectance);
    m.roughness = roughness;
    return m;
}

// A mirror of two metres that faces the camera, four metres away, before the Sun, which lights what stands a metre above it,
// to the right of the picture: the picture's right side shows it.
class MirrorImage {
  public:
    Stage s;

    MirrorImage(const char* model, int samples, int size_px, int buffer_samples = 16) {
        s.quality.path_model = model;
        s.quality.max_depth = 3;
        s.quality.contribution_threshold = 0.01f;
        s.quality.facets_behind_diffuse = 0;
        s.quality.samples_per_axis = samples;
        s.quality.visibility = s.quality.path_model == "cached" ? "buffer" : "rays";
        s.quality.buffer_samples = buffer_samples;
        s.quality.rays_across = 0;
        s.camera(size_px, 0.2);
        s.sun({0.5, 0, 1});
    }
    void render(const SceneObject& shown, double reflectance = 0.9) {
        render(shown, object_of({{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}, {{0, 1, 2}, {0, 2, 3}},
                                metal(0.07, reflectance), s.grid));
    }
    void render(const SceneObject& shown, const SceneObject& mirror) {
        s.add(joined(mirror, shown), {0, 0, 4});
        s.render();
    }
    // The mirror as tiles of 10 mm that lean by half a milliradian in turns: no two of them are one plane.
    SceneObject tiles() const {
        constexpr int kAcross = 200;
        std::vector<Vec3f> v;
        std::vector<std::array<std::uint32_t, 3>> t;
        for (int i = 0; i < kAcross * kAcross; ++i) {
            const float x = 0.01f * static_cast<float>(i % kAcross) - 1,
                        y = 0.01f * static_cast<float>(i / kAcross) - 1;
            const float lean = (i % kAcross + i / kAcross) % 2 ? 2.5e-6f : -2.5e-6f;
            const auto first = static_cast<std::uint32_t>(v.size());
            v.insert(
                v.end(),
                {{x, y, -lean}, {x + 0.01f, y, lean}, {x + 0.01f, y + 0.01f, lean}, {x, y + 0.01f, -lean}});
            t.push_back({first, first + 1, first + 2}), t.push_back({first, first + 2, first + 3});
        }
        return object_of(v, t, metal(0.07), s.grid);
    }
};

// A strip of 10 mm, aslant to the pixels: its light by cached light, of that by paths. Hardly a place of the mirror has a
// direction, of sixty, that meets it.
double light_of_strip(const MaterialConfig& material) {
    const auto light = [&](const char* model, int samples) {
        MirrorImage m(model, samples, 144, 64);
        m.render(object_of({{0.8f, -0.3f, 1}, {0.81f, -0.3f, 1}, {0.91f, 0.3f, 1}, {0.9f, 0.3f, 1}},
                           {{0, 1, 2}, {0, 2, 3}}, material, m.s.grid));
        return m.s.mean();
    };
    const double paths = light("path", 8);
    EXPECT_GT(paths, 0);
    return light("cached", 1) / paths;
}
TEST(MirrorImage, AStripThatNoDirectionMeetsIsSeen) { EXPECT_NEAR(light_of_strip(lambert(0.9)), 1, 0.1); }

// The mirror blurs it over pixels whose middles pass it by.
TEST(MirrorImage, ABlurredStripHasAllItsLight) { EXPECT_NEAR(light_of_strip(metal(0.6)), 1, 0.1); }

// Strips of bare metal, 7 mm wide, which lean to the Sun and away from it in turns: six of them are as wide as a pixel of the
// mirror. What a pixel shows is nearly their mean, and not what one of them sends. Returns the root mean square of what is
// wrong, of what is right.
double error_of_strips(int buffer_samples, bool tiled = false, double reflectance = 0.9) {
    const auto image = [&](const char* model, int samples) {
        MirrorImage m(model, samples, 48, buffer_samples);
        std::vector<Vec3f> v;
        std::vector<std::array<std::uint32_t, 3>> t;
        constexpr int kStrips = 86;
        for (std::uint32_t i = 0; i <= kStrips; ++i) {
            const float x = 0.6f + 0.007f * static_cast<float>(i), z = i % 2 ? 1.0014f : 1.0f;
            v.push_back({x, -0.4f, z}), v.push_back({x + 0.13f, 0.4f, z});
            if (i == 0) continue;
            t.push_back({2 * i - 2, 2 * i, 2 * i + 1}), t.push_back({2 * i - 2, 2 * i + 1, 2 * i - 1});
        }
        const SceneObject strips = object_of(v, t, metal(0.6), m.s.grid);
        if (tiled)
            m.render(strips, m.tiles());
        else
            m.render(strips, reflectance);
        return std::vector<float>(m.s.radiance.plane(0).begin(), m.s.radiance.plane(0).end());
    };
    const std::vector<float> kept = image("cached", 1), paths = image("path", 16);
    double squares = 0, truth = 0;
    for (std::size_t i = 0; i < paths.size(); ++i) {
        const auto off = static_cast<double>(kept[i]) - static_cast<double>(paths[i]);
        squares += off * off;
        truth += static_cast<double>(paths[i] * paths[i]);
    }
    EXPECT_GT(truth, 0);
    return std::sqrt(squares / truth);
}
TEST(MirrorImage, APixelShowsTheMeanOfSmallFacets) {
    EXPECT_LT(error_of_strips(16), 0.15);
    EXPECT_LT(error_of_strips(64), 0.13);
}

// Each ray of such a mirror has less than the threshold, all of a pixel's together have more.
TEST(MirrorImage, ADimMirrorShowsThemAsWell) { EXPECT_LT(error_of_strips(64, false, 0.15), 0.13); }

// A pixel of 33 mm has some eleven tiles of the mirror, which together are what it shows.
TEST(MirrorImage, APixelShowsWhatAllTilesInItMirror) { EXPECT_LT(error_of_strips(64, true), 0.13); }

// Bars that face away from the Sun, some pixels of the mirror wide: their light, and how many rays went along paths.
struct Bars {
    double light;
    std::uint64_t rays;
};
Bars bars_in_the_shade(double reflectance, const char* model, int samples) {
    MirrorImage m(model, samples, 48, 64);
    m.s.sun({-0.5, 0, -1});
    std::vector<Vec3f> v;
    std::vector<std::array<std::uint32_t, 3>> t;
    for (std::uint32_t i = 0; i < 12; ++i) {
        const float x = 0.5f + 0.05f * static_cast<float>(i);
        v.insert(v.end(), {{x, -0.4f, 1}, {x + 0.02f, -0.4f, 1}, {x + 0.05f, 0.4f, 1}, {x + 0.03f, 0.4f, 1}});
        t.push_back({4 * i, 4 * i + 1, 4 * i + 2}), t.push_back({4 * i, 4 * i + 2, 4 * i + 3});
    }
    m.render(object_of(v, t, lambert(reflectance), m.s.grid));
    return {m.s.mean(), m.s.stats.secondary_rays};
}
TEST(MirrorImage, FewRaysAreEnoughForWhatIsDark) {
    const Bars dark = bars_in_the_shade(0.08, "cached", 1);
    EXPECT_LT(2 * dark.rays, bars_in_the_shade(0.9, "cached", 1).rays);
    EXPECT_NEAR(dark.light / bars_in_the_shade(0.08, "path", 16).light, 1, 0.15);
}

}  // namespace
}  // namespace hilcam
