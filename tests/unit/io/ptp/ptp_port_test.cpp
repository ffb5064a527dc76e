// The port, the choice of masters and the servo against masters on a simulated network.

#include "io/ptp/ptp_port.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/io/ptp/ptp_bench.h"

namespace hilcam {
namespace {

using ::testing::HasSubstr;
using Kind = PtpNote::Kind;

constexpr OscillatorConfig kDrifting{.rate = 50e-6};

SimMaster other_master(std::uint8_t priority1 = 128) {
    SimMaster m;
    m.identity = {0x00AABBFFFE000001, 1};
    m.announce.grandmaster = m.identity.clock;
    m.announce.priority1 = priority1;
    return m;
}

// --- convergence: the bounds of the room's promise

TEST(PtpPort, From50PpmAnd1SItIsBelow1UsWithoutNoise) {
    SimMaster master;
    PtpBench b(kDrifting, master.time_ns(PtpBench::kBegin_ns) + kSimSecond);
    const SimMaster& m = b.add(master);
    EXPECT_EQ(b.state(), PtpState::kListening);
    b.run(60);
    EXPECT_EQ(b.state(), PtpState::kSlave);
    EXPECT_LT(b.errors(m, 60).back(), 1'000);
    EXPECT_EQ(b.port.data_set().steps, 1u);
    EXPECT_NEAR(static_cast<double>(b.port.data_set().mean_path_delay_ns), PtpBench::kDelay_ns, 100);
    EXPECT_NEAR(b.port.data_set().rate_correction, -50e-6, 0.01e-6);
}

TEST(PtpPort, From50PpmAnd1SItIsBelow100UsWith50UsOfJitter) {
    SimMaster master;
    PtpBench b(kDrifting, master.time_ns(PtpBench::kBegin_ns) + kSimSecond);
    b.jitter_ns = 50'000;
    const SimMaster& m = b.add(master);
    b.run(60);
    EXPECT_EQ(b.state(), PtpState::kSlave);
    const auto errors = b.errors(m, 600);
    RecordProperty("p50_ns", static_cast<int>(errors[errors.size() / 2]));
    RecordProperty("p99_ns", static_cast<int>(errors[errors.size() * 99 / 100]));
    EXPECT_LT(errors[errors.size() * 99 / 100], 100'000);
}

TEST(PtpPort, FromPowerUpItStepsToTheMastersTimeOnce) {
    PtpBench b;
    const SimMaster& m = b.add({});
    b.run(20);
    EXPECT_LT(std::abs(b.error_ns(m)), 1'000);
    EXPECT_EQ(b.count(Kind::kStep), 1);
}

TEST(PtpPort, EachFormOfSyncGivesTheSameClock) {
    for (const int form : {0, 1, 2, 3, 4}) {
        SimMaster master;
        master.two_step = form != 0;
        master.follow_up_first = form == 1;
        if (form == 2) master.log_sync = -3;
        if (form == 3) master.correction_ns = 300'000;
        if (form == 4) master.log_sync = 2;
        PtpBench b(kDrifting);
        const SimMaster& m = b.add(master);
        b.run(60);
        EXPECT_EQ(b.state(), PtpState::kSlave) << form;
        EXPECT_LT(b.errors(m, 20).back(), 1'000) << form;
        EXPECT_NEAR(static_cast<double>(b.port.data_set().mean_path_delay_ns), PtpBench::kDelay_ns, 200)
            << form;
    }
}

TEST(PtpPort, AFifthOfTheSyncsMayBeLost) {
    PtpBench b(kDrifting);
    b.lost_syncs = 0.2;
    b.jitter_ns = 50'000;
    const SimMaster& m = b.add({});
    b.run(60);
    const auto errors = b.errors(m, 300);
    EXPECT_LT(errors[errors.size() * 99 / 100], 100'000);
    EXPECT_EQ(b.state(), PtpState::kSlave);
    EXPECT_EQ(b.count(Kind::kStep), 1);
}

TEST(PtpPort, OutliersDoNotMoveTheClock) {
    PtpBench b(kDrifting);
    const SimMaster& m = b.add({});
    b.run(40);
    int n = 0;
    b.late = [&] { return ++n % 6 == 0 ? 20 * kSimMs : std::int64_t{0}; };  // one Sync in six waits 20 ms
    const auto errors = b.errors(m, 120);
    EXPECT_LT(errors.back(), 20'000);
    EXPECT_EQ(b.count(Kind::kStep), 1);
    EXPECT_EQ(b.state(), PtpState::kSlave);
}

TEST(PtpPort, ASlowWalkOfTheRateIsFollowed) {
    PtpBench b({.rate = -20e-6, .wander = 0.01e-6, .seed = 5});
    const SimMaster& m = b.add({});
    b.run(60);
    EXPECT_LT(b.errors(m, 300).back(), 10'000);
}

// --- what masters do

TEST(PtpPort, AMastersStepIsFollowedByOneStep) {
    PtpBench b(kDrifting);
    SimMaster& m = b.add({});
    b.run(60);
    m.ahead_ns += kSimSecond;
    b.run(2);
    EXPECT_LT(b.error_ns(m), -900 * kSimMs);  // two Syncs could be outliers
    b.run(12);
    EXPECT_LT(std::abs(b.error_ns(m)), 1'000);
    EXPECT_EQ(b.count(Kind::kStep), 2);
    EXPECT_EQ(b.state(), PtpState::kSlave);
    EXPECT_NEAR(static_cast<double>(b.port.data_set().mean_path_delay_ns), PtpBench::kDelay_ns, 100);
}

TEST(PtpPort, ABetterMasterTakesOver) {
    PtpBench b(kDrifting);
    b.add({});
    b.run(30);
    SimMaster better = other_master(127);
    better.ahead_ns += 300'000;
    const SimMaster& m = b.add(better);
    b.run(40);
    EXPECT_EQ(b.port.data_set().parent_id, m.identity.clock);
    EXPECT_EQ(b.state(), PtpState::kSlave);
    EXPECT_LT(b.errors(m, 20).back(), 5'000);
    EXPECT_EQ(b.count(Kind::kStep), 1);  // 300 us are slewed
    EXPECT_EQ(b.count(Kind::kMaster), 2);
}

TEST(PtpPort, AWorseMasterIsNotFollowedUntilTheBetterOneIsGone) {
    PtpBench b(kDrifting);
    SimMaster& good = b.add({});
    SimMaster& worse = b.add(other_master(200));
    b.run(60);
    EXPECT_EQ(b.port.data_set().parent_id, good.identity.clock);
    good.alive = false;
    b.run(30);
    EXPECT_EQ(b.port.data_set().parent_id, worse.identity.clock);
    EXPECT_EQ(b.state(), PtpState::kSlave);
}

TEST(PtpPort, WithoutItsMasterItHoldsTheRate) {
    PtpBench b(kDrifting);
    SimMaster& m = b.add({});
    b.run(60);
    m.alive = false;
    b.run(4);                                // the last Announce was at 58.1 s
    EXPECT_EQ(b.state(), PtpState::kSlave);  // until three Announce intervals of 2 s have passed
    b.run(1);
    EXPECT_EQ(b.state(), PtpState::kListening);
    EXPECT_EQ(b.port.data_set().servo_locked, 0u);
    EXPECT_EQ(b.port.data_set().parent_id, 0u);
    b.run(600);
    // 50 ppm would be 30 ms by now.
    EXPECT_LT(std::abs(b.error_ns(m)), 10'000);
    m.alive = true;
    b.run(20);
    EXPECT_EQ(b.state(), PtpState::kSlave);
    EXPECT_EQ(b.count(Kind::kStep), 1);
}

TEST(PtpPort, SyncsThatStopAloneUnlockTheServo) {
    PtpBench b(kDrifting);
    b.add({});
    b.run(60);
    b.lost_syncs = 1;
    b.run(15);
    EXPECT_EQ(b.state(), PtpState::kUncalibrated);
    EXPECT_EQ(b.port.data_set().servo_locked, 0u);
}

TEST(PtpPort, SequencesWrap) {
    SimMaster master;
    master.sequence = 65'530;
    PtpBench b(kDrifting);
    const SimMaster& m = b.add(master);
    b.run(40);
    EXPECT_LT(std::abs(b.error_ns(m)), 1'000);
    EXPECT_LT(m.sequence, 100);
}

// --- Announce that is not to be believed

TEST(PtpPort, MastersThatDoNotCountAreNotFollowed) {
    const auto followed = [](const SimMaster& master) {
        PtpBench b;
        b.add(master);
        b.run(30);
        return b.state() != PtpState::kListening || b.requests > 0;
    };
    EXPECT_TRUE(followed({}));
    SimMaster m;
    m.announce.steps_removed = 255;
    EXPECT_FALSE(followed(m));
    m.announce.steps_removed = 254;
    EXPECT_TRUE(followed(m));
    m = {};
    m.domain = 1;
    EXPECT_FALSE(followed(m));
    m = {};
    m.identity.clock = PtpBench::kOwn;
    EXPECT_FALSE(followed(m));
    m = {};
    m.announce.grandmaster = PtpBench::kOwn;
    EXPECT_FALSE(followed(m));
    m = {};
    m.flags |= ptp::flag::kAlternateMaster;
    EXPECT_FALSE(followed(m));
}

TEST(PtpPort, OneAnnounceIsNotEnough) {
    PtpBench b;
    SimMaster& m = b.add({});
    b.run(1);
    EXPECT_EQ(b.state(), PtpState::kListening);
    m.alive = false;
    b.run(20);
    m.alive = true;
    b.run(1.5);
    EXPECT_EQ(b.state(), PtpState::kListening);
    b.run(3);
    EXPECT_EQ(b.state(), PtpState::kUncalibrated);
}

TEST(PtpPort, AFloodOfMastersDoesNotPushOutTheOneThatIsFollowed) {
    PtpBench b(kDrifting);
    const SimMaster& m = b.add({});
    b.run(30);
    for (std::uint64_t i = 1; i < 2'000; ++i) {
        SimMaster flood = other_master(0);
        flood.identity.clock += i;
        flood.announce.grandmaster = flood.identity.clock;
        ptp::Message announce = PtpBench::message(flood, ptp::MessageType::kAnnounce);
        announce.announce = flood.announce;
        b.give(announce);
        b.run(0.005);
    }
    EXPECT_EQ(b.port.data_set().parent_id, m.identity.clock);
    EXPECT_EQ(b.state(), PtpState::kSlave);
}

TEST(PtpPort, WhatOthersSayToOthersIsIgnored) {
    PtpBench b(kDrifting);
    SimMaster& m = b.add({});
    b.run(40);
    const PtpDataSet before = b.port.data_set();
    // A Sync of one that is not the master, a response to another slave's request, and one with another number.
    ptp::Message sync = PtpBench::message(other_master(), ptp::MessageType::kSync);
    sync.time_ns = 5;
    b.give(sync, b.now_ns);
    ptp::Message response = PtpBench::message(m, ptp::MessageType::kDelayResp);
    response.requester = {PtpBench::kOwn + 1, 1};
    for (std::uint16_t i = 0; i < 100; ++i) response.sequence = i, b.give(response);
    response.requester = {PtpBench::kOwn, 1};
    response.sequence = 40'000;
    b.give(response);
    b.run(0.01);
    EXPECT_EQ(b.port.data_set().mean_path_delay_ns, before.mean_path_delay_ns);
    EXPECT_EQ(b.port.data_set().steps, before.steps);
    EXPECT_LT(std::abs(b.error_ns(m)), 1'000);
}

TEST(PtpPort, ASyncWithoutAnArrivalOrFollowUpIsNotUsed) {
    PtpBench b;
    SimMaster master;
    master.alive = false;
    b.add(master);
    ptp::Message announce = PtpBench::message(master, ptp::MessageType::kAnnounce);
    announce.announce = master.announce;
    for (int i = 0; i < 3; ++i) b.give(announce), b.run(1);
    ptp::Message sync = PtpBench::message(master, ptp::MessageType::kSync);
    b.give(sync);  // no stamp
    sync.flags = ptp::flag::kTwoStep;
    b.give(sync, b.now_ns);
    b.run(0.5);
    EXPECT_EQ(b.requests, 0);
    EXPECT_EQ(b.port.data_set().steps, 0u);
}

// --- the choice between masters: IEEE 1588-2008, figures 27 and 28

TEST(ForeignMasters, AreComparedInTheOrderOfTheStandard) {
    const ForeignMaster base{{10, 1},
                             0,
                             {.priority1 = 128,
                              .clock_class = 135,
                              .accuracy = 0x22,
                              .variance = 1000,
                              .priority2 = 128,
                              .grandmaster = 100,
                              .steps_removed = 2},
                             0,
                             0,
                             true};
    const auto better = [&](const std::function<void(ForeignMaster&)>& change) {
        ForeignMaster other = base;
        change(other);
        EXPECT_NE(is_better(other, base), is_better(base, other));
        return is_better(other, base);
    };
    const auto other_grandmaster = [](ForeignMaster& m) { m.announce.grandmaster = 200; };
    EXPECT_FALSE(better([&](ForeignMaster& m) { other_grandmaster(m); }));
    EXPECT_TRUE(better([&](ForeignMaster& m) { other_grandmaster(m), m.announce.priority2 = 127; }));
    EXPECT_FALSE(better([&](ForeignMaster& m) {
        other_grandmaster(m), m.announce.priority2 = 1, m.announce.variance = 1001;
    }));
    EXPECT_FALSE(better([&](ForeignMaster& m) {
        other_grandmaster(m), m.announce.variance = 1, m.announce.accuracy = 0x23;
    }));
    EXPECT_FALSE(better([&](ForeignMaster& m) {
        other_grandmaster(m), m.announce.accuracy = 0x20, m.announce.clock_class = 136;
    }));
    EXPECT_TRUE(better([&](ForeignMaster& m) {
        other_grandmaster(m), m.announce.clock_class = 248, m.announce.priority1 = 127;
    }));
    // The same grandmaster by two ways: the shorter one, then the sender with the lower identity.
    EXPECT_TRUE(better([](ForeignMaster& m) { m.sender = {99, 1}, m.announce.steps_removed = 1; }));
    EXPECT_FALSE(better([](ForeignMaster& m) { m.sender = {9, 1}, m.announce.steps_removed = 3; }));
    EXPECT_TRUE(better([](ForeignMaster& m) { m.sender = {9, 1}; }));
    EXPECT_FALSE(better([](ForeignMaster& m) { m.sender = {10, 2}; }));
}

// --- scales of time, and what is said

TEST(PtpPort, TheScaleIsTheMasters) {
    PtpBench b;
    EXPECT_EQ(b.port.data_set().scale, TimeScale::kDevice);
    b.add({});
    b.run(3);
    EXPECT_EQ(b.port.data_set().scale, TimeScale::kDevice);  // not yet taken over
    b.run(20);
    EXPECT_EQ(b.port.data_set().scale, TimeScale::kTai);
    EXPECT_EQ(b.port.data_set().utc_offset_s, 37);
    EXPECT_EQ(b.count(Kind::kUtcOffset) + b.count(Kind::kArbitraryScale), 0);
}

TEST(PtpPort, AScaleThatIsNotTaiIsSaidOnce) {
    PtpBench b;
    SimMaster master;
    master.flags = 0;
    b.add(master);
    b.run(60);
    EXPECT_EQ(b.port.data_set().scale, TimeScale::kArbitrary);
    EXPECT_EQ(b.count(Kind::kArbitraryScale), 1);
}

TEST(PtpPort, LeapSecondsThatCannotBeRightAreSaidOnce) {
    for (const bool valid : {false, true}) {
        PtpBench b;
        SimMaster master;
        master.announce.utc_offset_s = valid ? 0 : 37;
        master.flags = ptp::flag::kPtpTimescale;
        if (valid) master.flags |= ptp::flag::kUtcOffsetValid;
        b.add(master);
        b.run(30);
        EXPECT_EQ(b.count(Kind::kUtcOffset), 1);
        EXPECT_EQ(b.port.data_set().scale, TimeScale::kTai);
    }
}

TEST(PtpNote, SaysWhatHappenedInWords) {
    EXPECT_EQ(format_clock_id(0x7A3C1FFFFE0D2B40), "7a3c1f.fffe.0d2b40");
    const PtpNote lost{Kind::kState, PtpState::kListening, PtpState::kSlave};
    EXPECT_TRUE(is_warning(lost));
    EXPECT_THAT(text_of(lost), HasSubstr("Listening (was Slave): no master"));
    const PtpNote slave{Kind::kState, PtpState::kSlave, PtpState::kUncalibrated, 0x7A3C1FFFFE0D2B40};
    EXPECT_FALSE(is_warning(slave));
    EXPECT_THAT(text_of(slave), HasSubstr("master 7a3c1f.fffe.0d2b40"));
    EXPECT_THAT(text_of({.kind = Kind::kUtcOffset, .value = 0, .valid = false}),
                HasSubstr("currentUtcOffset 0 s, not marked as valid"));
    EXPECT_THAT(text_of({.kind = Kind::kStep, .value = -5}), HasSubstr("stepped by -5 ns"));
    EXPECT_TRUE(is_warning({.kind = Kind::kArbitraryScale}));
    EXPECT_THAT(text_of({.kind = Kind::kArbitraryScale}), HasSubstr("not TAI"));
    EXPECT_THAT(text_of({.kind = Kind::kNoTransmitStamps}), HasSubstr("transmit"));
}

// --- states

TEST(PtpPort, StatesAreThoseOfItsOrders) {
    PtpBench b(kDrifting);
    const SimMaster& m = b.add({});
    b.run(40);
    b.port.disable(b.now_ns);
    EXPECT_EQ(b.state(), PtpState::kDisabled);
    EXPECT_EQ(b.port.data_set().scale, TimeScale::kDevice);
    b.run(10);  // at its own rate again: 50 ppm
    EXPECT_NEAR(static_cast<double>(b.error_ns(m)), 500'000, 5'000);
    b.port.initialize();
    EXPECT_EQ(b.state(), PtpState::kInitializing);
    b.port.fail();
    EXPECT_EQ(b.state(), PtpState::kFaulty);
    b.run(5);
    EXPECT_EQ(b.state(), PtpState::kFaulty);
    b.port.listen(b.now_ns);
    b.run(30);
    EXPECT_EQ(b.state(), PtpState::kSlave);
    EXPECT_LT(std::abs(b.error_ns(m)), 1'000);
}

}  // namespace
}  // namespace hilcam
