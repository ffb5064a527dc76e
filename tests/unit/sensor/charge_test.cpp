// Charge on its way out of the detector, and what particles add.

#include <gtest/gtest.h>

#include <cmath>

#include "sensor/ccd.h"
#include "sensor/cosmic_rays.h"
#include "tests/support/cameras.h"
#include "tests/support/statistics.h"

namespace hilcam {
namespace {

TEST(Blooming, ExcessGoesUpAndDownTheColumnAndNoneIsLost) {
    ElectronImage q(300, 101);
    q.row(50)[280] = 11000;
    bloom(q, 1000);
    for (int y = 45; y <= 55; ++y) EXPECT_FLOAT_EQ(q.row(y)[280], 1000) << y;
    EXPECT_EQ(q.row(44)[280], 0);
    EXPECT_EQ(q.row(56)[280], 0);
    EXPECT_EQ(q.row(50)[281], 0);
    EXPECT_NEAR(sum(q), 11000, 1e-2);
}

TEST(Blooming, WhatReachesTheEdgeDrains) {
    ElectronImage q(4, 11);
    q.row(5)[1] = 1e5f;
    bloom(q, 1000);
    for (int y = 0; y < 11; ++y) EXPECT_FLOAT_EQ(q.row(y)[1], 1000);
    ElectronImage below(4, 11);
    for (float& v : below.all()) v = 999;
    bloom(below, 1000);
    for (const float v : below.all()) ASSERT_EQ(v, 999);
}

// After n transfers of efficiency 1 - c a packet has kept (1 - c)^n; the next pixel has n c of it.
TEST(Transfer, APacketTrailsAsItsTransfersSay) {
    CcdConfig config;
    config.parallel_inefficiency = 1e-4;
    ElectronImage q(5, 1000);
    q.row(799)[2] = 10000;
    ChargeTransfer(config, 5, 1000).apply(q);
    EXPECT_NEAR(static_cast<double>(q.row(799)[2]), 10000 * std::pow(1 - 1e-4, 800), 1e-1);
    EXPECT_NEAR(static_cast<double>(q.row(800)[2]), 10000 * 800 * 1e-4 * std::pow(1 - 1e-4, 800), 1e-1);
    EXPECT_EQ(q.row(798)[2], 0);
    EXPECT_NEAR(sum(q), 10000, 1e-1);
    ElectronImage along(1000, 3);
    along.row(1)[499] = 10000;
    CcdConfig serial;
    serial.serial_inefficiency = 1e-4;
    ChargeTransfer(serial, 1000, 3).apply(along);
    EXPECT_NEAR(static_cast<double>(along.row(1)[500]), 10000 * 500 * 1e-4 * std::pow(1 - 1e-4, 500), 1e-1);
}

// Flux times area times exposure; a track's mean charge is depth over the mean of its cosine: for cos^2
// uniform, <1 / cos> = 2.
TEST(CosmicRays, TracksHaveTheirRateAndCharge) {
    CosmicRayConfig c;
    c.rate_cm2_s = 100, c.depth_um = 10, c.electrons_per_um = 80, c.spread_fraction = 0.3;
    ElectronImage q(500, 500);
    double total = 0;
    constexpr int kFrames = 400;
    for (std::uint64_t frame = 1; frame <= kFrames; ++frame) {
        std::fill(q.all().begin(), q.all().end(), 0.0f);
        add_tracks(c, 10e-6, 1.0, {1, frame}, q);
        total += sum(q);
    }
    // 25 tracks a frame, 10,000 in all. 1 / cos has no variance of its own (its second moment grows with the
    // logarithm of the steepest), so the bound is wide; tracks that leave the detector lose a little.
    EXPECT_NEAR(total / kFrames, 25 * 1600, 0.12 * 25 * 1600);
    // None without exposure, and the same again.
    std::fill(q.all().begin(), q.all().end(), 0.0f);
    add_tracks(c, 10e-6, 0.0, {1, 1}, q);
    EXPECT_EQ(sum(q), 0);
    ElectronImage again(500, 500);
    add_tracks(c, 10e-6, 1.0, {1, 1}, q);
    add_tracks(c, 10e-6, 1.0, {1, 1}, again);
    EXPECT_TRUE(std::equal(q.all().begin(), q.all().end(), again.all().begin()));
    EXPECT_GT(sum(q), 0);
}

// The same 1e5 tracks with and without a spread s have the same light within four times s sqrt(sum w^2) / sum w, where w are
// their lengths: 1 / cos with cos^2 uniform, of which <w>^2 = 4 and <w^2> is about ln(1e5) = 11.5, so s / 186.
TEST(CosmicRays, AWideSpreadIsNoBrighter) {
    for (const double spread : {0.3, 1.0, 2.0}) {
        CosmicRayConfig c;
        // It is so thin that only tracks that are nearly level leave the detector at its sides.
        c.rate_cm2_s = 1e6, c.depth_um = 0.1, c.electrons_per_um = 80, c.spread_fraction = spread;
        ElectronImage narrow(100, 100), wide(100, 100);
        add_tracks(c, 100e-6, 0.1, {1, 1}, wide);
        c.spread_fraction = 0;
        add_tracks(c, 100e-6, 0.1, {1, 1}, narrow);
        EXPECT_NEAR(sum(wide) / sum(narrow), 1, 4 * spread / 186) << spread;
    }
}

}  // namespace
}  // namespace hilcam
