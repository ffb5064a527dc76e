#include "io/lines/sequencer.h"

#include <gtest/gtest.h>

#include <vector>

namespace hilcam {
namespace {

constexpr std::int64_t kMs_ns = 1'000'000;
constexpr auto kAtBegin = LineEvent::kFrameStart;

// Sets 0, 1, 2 of 1, 2, 3 ms and 10, 20, 30 dB.
SequencerProgram three_sets() {
    SequencerProgram p;
    for (std::size_t i = 0; i < kSequencerSets; ++i) {
        p.sets[i].exposure_s = 1e-3 * static_cast<double>(i + 1);
        p.sets[i].gain_db = 10 * static_cast<double>(i + 1);
    }
    return p;
}
SequencerProgram cycle(LineEvent source) {
    SequencerProgram p = three_sets();
    for (std::uint8_t i = 0; i < 3; ++i)
        p.sets[i].paths[0] = {static_cast<std::uint8_t>((i + 1) % 3), source};
    return p;
}

struct Frames {
    Sequencer sequencer;
    CameraSettings settings{.exposure_s = 0.5, .gain_db = 1, .black_level_dn = 64};

    // A frame of so many ms; returns its set.
    std::int64_t frame(std::int64_t begin_ms, std::int64_t length_ms = 5) {
        CameraSettings s = settings;
        const std::int64_t set = sequencer.begin(begin_ms * kMs_ns, s);
        used = s;
        sequencer.begun(begin_ms * kMs_ns, (begin_ms + length_ms) * kMs_ns);
        return set;
    }
    std::vector<std::int64_t> frames(int count, std::int64_t from_ms = 0, std::int64_t length_ms = 5) {
        std::vector<std::int64_t> sets;
        for (int i = 0; i < count; ++i) sets.push_back(frame(from_ms + 10 * i, length_ms));
        return sets;
    }
    CameraSettings used;
};
using Sets = std::vector<std::int64_t>;

TEST(Sequencer, EachFrameUsesTheSetThatIsActiveWhenItBegins) {
    Frames f;
    EXPECT_EQ(f.frame(0), Sequencer::kNone);
    EXPECT_EQ(f.used.exposure_s, 0.5);
    f.sequencer.start(cycle(kAtBegin));
    EXPECT_EQ(f.sequencer.exposure_s(), 1e-3);
    EXPECT_EQ(f.frames(3, 10), (Sets{0, 1, 2}));
    EXPECT_EQ(f.used.exposure_s, 3e-3);
    EXPECT_EQ(f.used.gain_db, 30);
    EXPECT_EQ(f.sequencer.active(), 2u);
    EXPECT_EQ(f.frame(40), 0);
    EXPECT_EQ(f.used.exposure_s, 1e-3);
    f.sequencer.stop();
    EXPECT_EQ(f.frame(50), Sequencer::kNone);
    EXPECT_EQ(f.used.exposure_s, 0.5);
    EXPECT_FALSE(f.sequencer.exposure_s().has_value());
}

TEST(Sequencer, FeaturesThatAreNotEnabledStayTheCameras) {
    Frames f;
    SequencerProgram p = cycle(kAtBegin);
    p.features = bit_of(SequencerFeature::kGain);
    f.sequencer.start(p);
    EXPECT_EQ(f.frame(0), 0);
    EXPECT_EQ(f.used.exposure_s, 0.5);
    EXPECT_EQ(f.used.gain_db, 10);
    EXPECT_EQ(f.used.black_level_dn, 64);
    EXPECT_FALSE(f.sequencer.exposure_s().has_value());
    EXPECT_EQ(f.sequencer.longest_exposure_s(), 0);
}

TEST(Sequencer, AnExposureThatEndsAsTheNextBeginsHasEndedBefore) {
    Frames f;
    f.sequencer.start(cycle(LineEvent::kExposureEnd));
    EXPECT_EQ(f.frames(4, 0, 10), (Sets{0, 1, 2, 0}));
    // A rolling shutter's exposures overlap: the end of frame n is before the begin of frame n + 2.
    f.sequencer.start(cycle(LineEvent::kExposureEnd));
    EXPECT_EQ(f.frames(5, 0, 15), (Sets{0, 0, 1, 2, 0}));
}

TEST(Sequencer, APathWithoutAnEventIsNotTaken) {
    Frames f;
    SequencerProgram p = three_sets();
    p.start = 2;
    f.sequencer.start(p);
    EXPECT_EQ(f.frames(3), (Sets{2, 2, 2}));
    EXPECT_EQ(f.sequencer.longest_exposure_s(), 3e-3);
}

TEST(Sequencer, AnEdgeCountsForFramesThatBeginAfterIt) {
    Frames f;
    SequencerProgram p = cycle(LineEvent::kLine0);
    p.sets[1].paths[0].activation = TriggerActivation::kFallingEdge;
    f.sequencer.start(p);
    const auto edge = [&](bool level, std::int64_t at_ms) {
        EXPECT_TRUE(f.sequencer.post(LineEvent::kLine0, level, at_ms * kMs_ns));
    };
    EXPECT_EQ(f.frame(0), 0);
    edge(true, 10);
    EXPECT_EQ(f.frame(10), 0);  // at its very instant
    EXPECT_EQ(f.frame(20), 1);
    edge(true, 22);  // not the edge that set 1 waits for
    EXPECT_EQ(f.frame(30), 1);
    edge(false, 31);
    edge(true, 33);
    EXPECT_EQ(f.frame(40), 0);  // by set 2
    edge(true, 55);
    EXPECT_EQ(f.frame(50), 0);
    EXPECT_EQ(f.frame(60), 1);
}

TEST(Sequencer, OfTwoPathsTheOneWhoseEventComesIsTaken) {
    Frames f;
    SequencerProgram p = three_sets();
    p.sets[0].paths = {{{1, kAtBegin}, {2, event_of_line(3)}}};
    p.sets[1].paths = {{{0, kAtBegin}, {2, event_of_line(3)}}};
    f.sequencer.start(p);
    EXPECT_EQ(f.frames(3), (Sets{0, 1, 0}));
    f.sequencer.post(event_of_line(3), true, 25 * kMs_ns);
    EXPECT_EQ(f.frames(2, 30), (Sets{2, 2}));
}

// Four frames with each set, whenever other threads run.
TEST(Sequencer, ACounterOfFramesIsCountedByTheFrames) {
    Frames f;
    Sequencer::Counters counters;
    counters[0] = {.event = kAtBegin, .reset = LineEvent::kCounter0End, .duration = 4};
    f.sequencer.start(cycle(LineEvent::kCounter0End), counters);
    // Another thread that counts as well makes no difference.
    f.sequencer.post(LineEvent::kCounter0End, true, 1);
    EXPECT_EQ(f.frames(13), (Sets{0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 0}));
}

TEST(Sequencer, ACounterOfEdgesIsNot) {
    Frames f;
    Sequencer::Counters counters;
    counters[1] = {.event = LineEvent::kLine0, .duration = 1};
    f.sequencer.start(cycle(LineEvent::kCounter1End), counters);
    EXPECT_EQ(f.frames(2), (Sets{0, 0}));
    f.sequencer.post(LineEvent::kCounter1End, true, 12 * kMs_ns);
    EXPECT_EQ(f.frame(20), 1);
}

TEST(Sequencer, ARestartBeginsAtTheStartSetAndForgetsWhatWaits) {
    Frames f;
    SequencerProgram p = cycle(LineEvent::kLine0);
    p.start = 1;
    f.sequencer.start(p);
    EXPECT_EQ(f.frame(0), 1);
    f.sequencer.post(LineEvent::kLine0, true, 5 * kMs_ns);
    EXPECT_EQ(f.frame(10), 2);
    f.sequencer.post(LineEvent::kLine0, true, 15 * kMs_ns);
    f.sequencer.restart();
    EXPECT_EQ(f.frame(20), 1);
    f.sequencer.stop();
    f.sequencer.restart();  // stays off
    EXPECT_EQ(f.frame(30), Sequencer::kNone);
}

TEST(Sequencer, MoreEventsThanItsQueueHoldsAreRefusedAndThoseItDoesNotWaitForAreNot) {
    Sequencer s;
    s.start(cycle(LineEvent::kLine0));
    for (int i = 0; i < 64; ++i) EXPECT_TRUE(s.post(LineEvent::kLine0, true, i));
    EXPECT_FALSE(s.post(LineEvent::kLine0, true, 65));
    EXPECT_TRUE(s.post(LineEvent::kTimer0End, true, 65));
}

TEST(Sequencer, TheLongestExposureIsThatOfSetsThatCanFollow) {
    Sequencer s;
    s.start(cycle(kAtBegin));
    EXPECT_EQ(s.longest_exposure_s(), 3e-3);  // sets 3 to 15 are longer and never used
}

TEST(Sequencer, InLockstepOnlyTheCamerasOwnFramesAdvanceIt) {
    EXPECT_TRUE(is_sequencer_source(LineEvent::kExposureEnd, true));
    EXPECT_TRUE(is_sequencer_source(LineEvent::kCounter1End, true));
    EXPECT_FALSE(is_sequencer_source(LineEvent::kLine0, true));
    EXPECT_TRUE(is_sequencer_source(event_of_line(7), false));
    EXPECT_FALSE(is_sequencer_source(LineEvent::kFrameEnd, false));
}

}  // namespace
}  // namespace hilcam
