// The spectra of stars, through the passbands of Johnson and Cousins.

#include "render/sky/star_spectra.h"

#include <gtest/gtest.h>

#include <cmath>

#include "render/vocabulary/table.h"

namespace hilcam {
namespace {

// A passband, for means of energy (Bessell, PASP 102, 1181, 1990), and the flux of magnitude 0 (Bessell, Castelli & Plez, A&A 333,
// 231, 1998) [1e-8 W m^-2 um^-1].
struct Band {
    double first_um;
    std::vector<double> share;  // a hundredth of a micrometre apart
    double zero;
};
const Band kB{0.36,
              {0,    .030, .134, .567, .920, .978, 1,    .978, .935, .853, .740,
               .640, .536, .424, .325, .235, .150, .095, .043, .009, 0},
              6.32};
const Band kV{0.47,
              {0,    .030, .163, .458, .780, .967, 1,    .973, .898, .792, .684, .574,
               .461, .359, .270, .197, .135, .081, .045, .025, .017, .013, .009, 0},
              3.631};
const Band kI{0.70,
              {0,    .024, .232, .555, .785, .910, .965, .985, .990, .995, 1, 1,
               .990, .980, .950, .910, .860, .750, .560, .330, .150, .030, 0},
              1.126};

// Bins of a hundredth of a micrometre, as many at a time as a grid has.
double magnitude(const Band& band, double v, const StarSpectra::Colors& colors) {
    double sum = 0, weights = 0;
    Table shares;
    for (std::size_t i = 0; i < band.share.size(); ++i) {
        shares.x.push_back(band.first_um + 0.01 * static_cast<double>(i));
        shares.y.push_back(band.share[i]);
    }
    for (double from_um = band.first_um; from_um < shares.x.back() - 1e-9; from_um += 0.04) {
        std::vector<double> edges;
        for (int i = 0; i <= 8; ++i) edges.push_back(from_um + 0.005 * i);
        const SpectralGrid grid(edges);
        const Spectrum light = StarSpectra(grid).irradiance_w_m2_um(v, colors);
        for (int b = 0; b < grid.size(); ++b) {
            if (grid.center_um(b) > shares.x.back()) continue;
            const double share = shares.at(grid.center_um(b));
            sum += share * static_cast<double>(light[b]), weights += share;
        }
    }
    return -2.5 * std::log10(sum / weights / (1e-8 * band.zero));
}

TEST(StarSpectra, HaveTheirMagnitudesInBVAndI) {
    // B-V and V-I of dwarfs and giants from B0 to M6, and of reddened ones.
    const std::vector<std::array<double, 2>> colors{
        {-0.30, -0.31}, {-0.20, -0.17}, {0, 0},       {0.15, 0.16}, {0.30, 0.38}, {0.44, 0.50}, {0.65, 0.72},
        {0.82, 0.87},   {1.00, 0.97},   {1.16, 1.12}, {1.50, 1.55}, {1.57, 1.65}, {1.60, 1.86}, {1.60, 2.20},
        {1.55, 2.50},   {1.50, 2.93},   {1.64, 3.20}, {1.40, 3.50}, {0.40, 0.55}, {1.86, 2.50}};
    for (const auto& [b_v, v_i] : colors)
        for (const double v : {0.0, 5.0}) {
            const StarSpectra::Colors both{b_v, v_i};
            EXPECT_NEAR(magnitude(kV, v, both), v, 0.01) << b_v << ' ' << v_i;
            EXPECT_NEAR(magnitude(kV, v, both) - magnitude(kI, v, both), v_i, 0.01) << b_v << ' ' << v_i;
            EXPECT_NEAR(magnitude(kB, v, both) - magnitude(kV, v, both), b_v, 0.05) << b_v << ' ' << v_i;
        }
}

// The zero points in words: 3.63e-8 and 1.13e-8 W m^-2 um^-1 for a star of magnitude 0 in V and Ic.
TEST(StarSpectra, AStarOfNoColourHasVegasFluxes) {
    EXPECT_NEAR(magnitude(kV, 0, {0, 0}), 0, 0.01);
    EXPECT_NEAR(magnitude(kI, 0, {0, 0}), 0, 0.01);
    EXPECT_NEAR(magnitude(kI, 0, {0, {}}), 0, 0.02);
}

// V-Ic of the classes, as PyGaia quotes Pickles 1998, and B-V of the same classes (Schmidt-Kaler 1982).
TEST(StarSpectra, BvAloneGivesTheClasssVi) {
    const std::vector<std::array<double, 2>> classes{
        {-0.30, -0.31}, {-0.26, -0.24}, {-0.17, -0.08}, {-0.02, 0.01}, {0.15, 0.16}, {0.30, 0.38},
        {0.58, 0.67},   {0.63, 0.72},   {0.68, 0.74},   {0.81, 0.87},  {1.07, 1.04}, {1.56, 1.65}};
    for (const auto& [b_v, v_i] : classes) {
        EXPECT_NEAR(v_i_of_b_v(b_v), v_i, 0.03) << b_v;
        const StarSpectra::Colors only{b_v, {}};
        EXPECT_NEAR(magnitude(kV, 3, only) - magnitude(kI, 3, only), v_i, 0.03) << b_v;
    }
}

TEST(StarSpectra, WhatNoStarHasIsTheLastSpectrumThatThereIs) {
    const SpectralGrid grid({0.25, 0.4, 0.55, 0.8, 1.1, 2.5});
    for (const double b_v : {-3.0, 10.0})
        for (const double v_i : {-3.0, 15.0}) {
            const Spectrum light = StarSpectra(grid).irradiance_w_m2_um(0, {b_v, v_i});
            for (int b = 0; b < grid.size(); ++b) {
                EXPECT_GT(light[b], 0);
                EXPECT_LT(light[b], 1e-5);
            }
        }
}

}  // namespace
}  // namespace hilcam
