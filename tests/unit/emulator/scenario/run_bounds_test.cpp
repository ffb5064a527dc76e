#include "emulator/scenario/run_bounds.h"

#include <gtest/gtest.h>

#include "tests/support/plate.h"

namespace hilcam {
namespace {

template <class Action>
std::string refusal(const Action& action) {
    try {
        action();
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

class RunBoundsOfAScenario : public PlateTest {
  protected:
    RunBounds read(const std::vector<std::string>& overrides) {
        return load_scenario(scenario("", ""), overrides).loop.fail_on;
    }
};

TEST_F(RunBoundsOfAScenario, NoneIsSetUnlessItIsGiven) {
    EXPECT_FALSE(read({}).any());
    const RunBounds bounds = read({"loop.fail_on={latency_ms: 50, missed_exposures: 0}"});
    EXPECT_DOUBLE_EQ(bounds.latency_s, 0.05);
    EXPECT_EQ(bounds.missed_exposures, 0);
    EXPECT_LT(bounds.dropped_packets, 0);
    EXPECT_EQ(bounds.from_frame, 11);
    EXPECT_FALSE(read({"loop.fail_on.latency_ms=50", "loop.fail_on.latency_ms=none"}).any());
}

TEST_F(RunBoundsOfAScenario, InLockstepTheClockHasNoBounds) {
    const auto in_lockstep = [&](const std::string& bound) {
        return refusal([&] { read({"mode=lockstep", "loop.fail_on." + bound}); });
    };
    for (const std::string key :
         {"latency_ms", "latency_p999_ms", "exposure_latency_ms", "missed_exposures"}) {
        const std::string message = in_lockstep(key + "=5");
        EXPECT_NE(message.find("loop.fail_on." + key + ": found 5; accepted with 'mode: lockstep': none"),
                  std::string::npos)
            << message;
    }
    EXPECT_EQ(in_lockstep("dropped_packets=0"), "");
    EXPECT_EQ(in_lockstep("dropped_frames=0"), "");
}

TEST(RunBounds, AReplayHasTheRecordingsExposures) {
    RunBounds bounds;
    bounds.dropped_frames = 0;
    EXPECT_EQ(refusal([&] { require_replay(bounds); }), "");
    bounds.missed_exposures = 3;
    EXPECT_EQ(
        refusal([&] { require_replay(bounds); }),
        "loop.fail_on.missed_exposures: found 3; accepted: none with --replay, which has the recording's "
        "exposures (--set loop.fail_on.missed_exposures=none)");
}

TEST(RunBounds, ALatencyNeedsAnOutputThatTakesTimes) {
    RunBounds bounds;
    bounds.missed_exposures = 3;
    EXPECT_EQ(refusal([&] { require_timed_output(bounds, false); }), "");
    bounds.latency_p999_s = 0.25;
    EXPECT_EQ(refusal([&] { require_timed_output(bounds, true); }), "");
    EXPECT_EQ(
        refusal([&] { require_timed_output(bounds, false); }),
        "loop.fail_on.latency_p999_ms: found 250; accepted: none without outputs.gige, v4l2, uvc, shm or "
        "packets to a socket, "
        "which alone say when a frame has left");
}

}  // namespace
}  // namespace hilcam
