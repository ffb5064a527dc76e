#include "emulator/run/broken_bounds.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <optional>

#include "emulator/run/latency_report.h"
#include "emulator/run/report.h"
#include "tests/support/plate.h"

namespace hilcam {
namespace {

BoundedFigures figures() {
    BoundedFigures f;
    f.latency = {3, 41, 12'500'000};
    f.p999 = {1, 77, 12'500'000};
    f.exposure = {2, 40, 9'000'000};
    f.judged_commands = 100, f.judged_exposures = 300;
    f.p999_ms = 12;
    f.missed = 5, f.first_missed = 60;
    f.packets = 7, f.first_packet_frame = 13;
    f.frames = 2, f.first_dropped = 90;
    return f;
}

std::vector<BrokenBound> judged(double RunBounds::*bound, double value, const BoundedFigures& f = figures()) {
    RunBounds bounds;
    bounds.*bound = value;
    return broken_bounds(bounds, "wide", f);
}

TEST(BrokenBounds, WithoutBoundsNothingIsBroken) {
    EXPECT_TRUE(broken_bounds({}, "wide", figures()).empty());
}

TEST(BrokenBounds, EachHoldsAtItsValueAndBreaksBelow) {
    struct Case {
        double RunBounds::*bound;
        double holds, breaks;
        const char* text;
    };
    const Case cases[] = {
        {&RunBounds::latency_s, 12.5e-3, 12.4e-3,
         "loop.fail_on.latency_ms: wide: 12.5 ms, 12.4 allowed; first in frame 41, 3 frames in all"},
        {&RunBounds::latency_p999_s, 12e-3, 11e-3,
         "loop.fail_on.latency_p999_ms: wide: 12 ms, 11 allowed; first in frame 77, 1 frame in all"},
        {&RunBounds::exposure_latency_s, 9e-3, 1e-6,
         "loop.fail_on.exposure_latency_ms: wide: 9 ms, 0.001 allowed; first in frame 40, 2 frames in all"},
        {&RunBounds::missed_exposures, 5, 4,
         "loop.fail_on.missed_exposures: wide: 5 exposures, 4 allowed; first in frame 60"},
        {&RunBounds::dropped_packets, 7, 0,
         "loop.fail_on.dropped_packets: wide: 7 packets, 0 allowed; first in frame 13"},
        {&RunBounds::dropped_frames, 2, 1,
         "loop.fail_on.dropped_frames: wide: 2 frames, 1 allowed; first in frame 90"},
    };
    for (const Case& c : cases) {
        EXPECT_TRUE(judged(c.bound, c.holds).empty()) << c.text;
        const std::vector<BrokenBound> broken = judged(c.bound, c.breaks);
        ASSERT_EQ(broken.size(), 1u) << c.text;
        EXPECT_EQ(text_of(broken[0]), c.text);
    }
}

// A bound that nothing was measured for is not kept: a gate that never sees a frame would always be open.
TEST(BrokenBounds, NothingMeasuredIsNotKept) {
    const std::vector<BrokenBound> broken = judged(&RunBounds::latency_s, 1, {});
    ASSERT_EQ(broken.size(), 1u);
    EXPECT_FALSE(broken[0].value);
    EXPECT_EQ(
        text_of(broken[0]),
        "loop.fail_on.latency_ms: wide: nothing was measured, 1000 ms are allowed: no frame that counts "
        "was sent with a new command");
    EXPECT_EQ(failed_on_json(broken)[0]["value"], nullptr);
    EXPECT_EQ(judged(&RunBounds::exposure_latency_s, 1, {}).size(), 1u);
    EXPECT_TRUE(judged(&RunBounds::missed_exposures, 0, {}).empty());
}

TEST(BrokenBounds, TheReportHasValueBoundAndFirstFrame) {
    const nlohmann::json all = failed_on_json(judged(&RunBounds::latency_s, 12.4e-3));
    ASSERT_EQ(all.size(), 1u);
    EXPECT_EQ(all[0]["bound"], "latency_ms");
    EXPECT_EQ(all[0]["camera"], "wide");
    EXPECT_DOUBLE_EQ(all[0]["value"], 12.5);
    EXPECT_DOUBLE_EQ(all[0]["allowed"], 12.4);
    EXPECT_EQ(all[0]["first_frame"], 41);
    EXPECT_EQ(all[0]["count"], 3);
    RunBounds bounds;
    bounds.latency_s = 0.05, bounds.missed_exposures = 0;
    EXPECT_EQ(bounds_json(bounds).dump(), R"({"from_frame":11,"latency_ms":50.0,"missed_exposures":0.0})");
    EXPECT_EQ(bounds_json({}).dump(), "{}");
}

TEST(LatencyReport, AHistogramHasEveryRecordInItsQuarterOctave) {
    DurationHistogram histogram;
    for (int i = 0; i < 3; ++i) histogram.record(1'000'000);
    histogram.record(1'900'000);
    const nlohmann::json json = durations_json(histogram);
    EXPECT_EQ(json["count"], 4);
    EXPECT_DOUBLE_EQ(json["max"], 1.9);
    ASSERT_GE(json["histogram"].size(), 2u);
    std::uint64_t count = 0;
    for (std::size_t i = 0; i < json["histogram"].size(); ++i) {
        const double from_ms = json["histogram"][i][0];
        if (i > 0) {
            EXPECT_NEAR(from_ms / json["histogram"][i - 1][0].get<double>(), std::exp2(0.25), 1e-9);
        }
        count += json["histogram"][i][1].get<std::uint64_t>();
        if (from_ms <= 1 && from_ms * std::exp2(0.25) > 1) {
            EXPECT_EQ(json["histogram"][i][1], 3);
        }
    }
    EXPECT_EQ(count, 4u);
    EXPECT_EQ(durations_json({})["histogram"].size(), 0u);
}

// A camera that cannot keep its rate: frames come each 0.1 ms, and the machine takes longer for one.
class BoundsOfARun : public PlateTest {};

TEST_F(BoundsOfARun, MissedExposuresAreNamedByTheirIds) {
    const auto file =
        scenario(", frame_rate_hz: 10000, frame_rate_range_hz: [1, 10000], exposure_range_ms: [0.01, 1]",
                 "loop: {levels: fixed}\n");
    RunLimits limits;
    limits.frames = 30;
    const auto run = [&](const std::string& allowed) {
        Emulator emulator(
            load_scenario(file, {{"camera.exposure_ms=0.01", "loop.fail_on.missed_exposures=" + allowed,
                                  "outputs.files.folder=" + (folder_ / allowed).string()}}),
            limits);
        emulator.run([] {});
        return std::pair(run_outcome(emulator), run_report(emulator));
    };
    const auto [broken, report] = run("0");
    ASSERT_EQ(broken.broken.size(), 1u);
    EXPECT_EQ(broken.broken[0].key, "missed_exposures");
    EXPECT_GE(broken.broken[0].first_frame, 11u);
    EXPECT_EQ(report["failed_on"].size(), 1u);
    EXPECT_EQ(report["missed_exposures"]["exposures"], report["deadline_misses"]);
    // Gaps and frames fill the ids: every id is a frame's or a gap's.
    std::uint64_t in_gaps = 0;
    for (const auto& gap : report["missed_exposures"]["gaps"])
        in_gaps += gap["exposures"].get<std::uint64_t>();
    EXPECT_EQ(in_gaps, report["deadline_misses"].get<std::uint64_t>());
    const auto [kept, other] = run("1e9");
    EXPECT_TRUE(kept.broken.empty());
    EXPECT_EQ(other["failed_on"].size(), 0u);
    EXPECT_EQ(other["fail_on"]["missed_exposures"], 1e9);
}

}  // namespace
}  // namespace hilcam
