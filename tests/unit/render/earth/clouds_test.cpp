// Light in clouds: phase functions, doubling and the tables against published values and each other.

#include <gtest/gtest.h>

#include <cmath>

#include "render/earth/adding_doubling.h"
#include "render/earth/cloud_table.h"
#include "render/earth/phase_function.h"
#include "render/vocabulary/units.h"

namespace hilcam {
namespace {

std::vector<double> powers(double g, int count) {
    std::vector<double> out;
    for (int l = 0; l < count; ++l) out.push_back(std::pow(g, l));
    return out;
}

const ScatteringLayer& layer_of(const ScatteringLayers& layers, double scaled) {
    for (const ScatteringLayer& layer : layers.layers)
        if (std::abs(layer.thickness / scaled - 1) < 1e-9) return layer;
    ADD_FAILURE() << "no layer of " << scaled;
    return layers.layers.front();
}

// Thickness 2, albedo 0.9, g = 0.75, light straight down: 0.09739 and 0.66096 in van de Hulst, Multiple Light
// Scattering (1980), as Wang, Jacques & Zheng, Comput. Methods Programs Biomed. 47, 131 (1995), table 1, quote him. The
// layer here is thicker by f = 1e-4 of itself.
TEST(Clouds, ASlabReflectsAndTransmitsWhatVanDeHulstTabulated) {
    const std::vector<double> cosines{1};
    const ScatteringLayers made = scattering_layers(powers(0.75, 40), 16, cosines, 0, 1, 0.9);
    EXPECT_NEAR(layer_of(made, 2).plane_albedo[0], 0.09739, 5e-5);
    EXPECT_NEAR(layer_of(made, 2).transmitted[0], 0.66096, 1.2e-4);
}

// Even scattering without loss, very thick: R(1, 1) = H(1)^2 / 8 with H(1) = 2.9078 (Chandrasekhar, Radiative Transfer,
// 1960; worked out anew from H's integral equation). A layer of thickness t lacks about (H-moment) 4 u^2 / (3 (t + 1.42)) of it, with u = 3^0.5 H / 4.
TEST(Clouds, AThickLayerThatScattersEvenlyHasChandrasekharsReflection) {
    const std::vector<double> cosines{1};
    std::vector<double> even(40, 0.0);
    even[0] = 1;
    const ScatteringLayers made = scattering_layers(even, 16, cosines, 8, 9);
    const double h = 2.9078, u = std::sqrt(3.0) * h / 4;
    const double lacking = 4 * u * u / (3 * (512 + 1.42));
    EXPECT_NEAR(layer_of(made, 512).reflection[0][0], h * h / 8 - lacking, 1e-3);
    EXPECT_GT(lacking, 3e-3);  // it can be told
}

TEST(Clouds, NoLightIsLostWithoutAbsorption) {
    const std::vector<double> cosines{1, 0.5, 0.1};
    const ScatteringLayers made = scattering_layers(powers(0.85, 40), 16, cosines, -6, 8);
    // The thinnest layer's one scattering errs by 2^-24 / 0.005 a doubling at most, of which a thick layer sees some.
    for (const ScatteringLayer& layer : made.layers)
        for (std::size_t i = 0; i < cosines.size(); ++i)
            EXPECT_NEAR(layer.plane_albedo[i] + layer.transmitted[i], 1, 3e-4) << layer.thickness;
}

TEST(Clouds, ReflectionIsTheSameBothWays) {
    const std::vector<double> cosines{0.9, 0.3};
    const ScatteringLayers made = scattering_layers(powers(0.85, 40), 16, cosines, 0, 4);
    for (const ScatteringLayer& layer : made.layers)
        for (const auto& mode : layer.reflection) EXPECT_NEAR(mode[1], mode[2], 1e-9);
}

// g of these droplets is 0.8640 by another program, which sums Mie's coefficients without going over angles (Bohren & Huffman, Absorption and
// Scattering of Light by Small Particles, 1983, appendix A and section 4.5). (Slingo, J. Atmos. Sci. 46, 1419, 1989, has 0.829 + 0.002482 r_e [um] = 0.854 from
// 0.25 to 0.69 um, over sizes of measured clouds: coefficients as climate models' sources have them.) The bow of large droplets lies at 138 to 143 degrees, the glory's first ring
// within 3 degrees of 180.
TEST(Clouds, DropletsHaveABowAndAGlory) {
    const PhaseFunction phase = PhaseFunction::droplets(0.55, 0, water_index(0.55), 10, 0.1);
    const std::vector<double> moments = phase.moments(2);
    EXPECT_NEAR(moments[0], 1, 1e-9);
    EXPECT_NEAR(moments[1], 0.8640, 0.001);
    const auto at = [&](double degrees) { return phase.at(static_cast<float>(degrees * kDegree_rad)); };
    EXPECT_GT(at(141), 2 * at(125));
    EXPECT_GT(at(141), 1.5f * at(155));
    float ring = 0;
    for (double d = 177; d < 179; d += 0.1) ring = std::max(ring, at(d));
    EXPECT_GT(ring, 2 * at(174));
    EXPECT_GT(ring, at(179.2));
    const PhaseFunction smooth = PhaseFunction::henyey_greenstein(0.85);
    EXPECT_NEAR(smooth.moments(4)[3], 0.85 * 0.85 * 0.85, 2e-3);
}

// All that the table reflects over the half sphere is what it does not let through: scattering once with the droplets'
// own phase function, and more than once by moments, make one whole. Steps of the tables: 2 %.
TEST(Clouds, TablesReflectWhatTheyDoNotTransmit) {
    const SpectralGrid grid({0.45, 0.55, 0.65});
    const CloudTable table(grid);
    for (const float c : {0.1f, 0.3f, 0.6f, 0.9f})
        for (const float mu0 : {1.0f, 0.6f, 0.25f}) {
            constexpr int kRings = 60, kSpokes = 72;
            double sum = 0;
            for (int i = 0; i < kRings; ++i)
                for (int j = 0; j < kSpokes; ++j) {
                    // Even shares of mu d mu.
                    const float mu = std::sqrt((static_cast<float>(i) + 0.5f) / kRings);
                    const double phi = 2 * kPi * (j + 0.5) / kSpokes;
                    const float cosine = mu * mu0 + std::sqrt((1 - mu * mu) * (1 - mu0 * mu0)) *
                                                        static_cast<float>(std::cos(phi));
                    EarthAspect aspect;
                    table.place(mu0, mu, cosine, aspect);
                    sum += static_cast<double>(CloudTable::reflected(aspect, c)[0]) / (kRings * kSpokes);
                }
            EXPECT_NEAR(sum, static_cast<double>(1 - table.transmitted(c, mu0)), 0.02) << c << " " << mu0;
        }
}

}  // namespace
}  // namespace hilcam
