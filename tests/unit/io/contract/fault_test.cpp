#include "io/contract/fault.h"

#include <gtest/gtest.h>

#include <bit>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <string>
#include <thread>
#include <vector>

namespace hilcam {
namespace {

TEST(Faults, EveryKindHasANameAMeaningAndABitOfItsOwn) {
    std::set<std::string_view> names;
    std::set<std::uint64_t> bits;
    for (const FaultKind kind : kAllFaults) {
        EXPECT_FALSE(meaning_of(kind).empty());
        EXPECT_EQ(fault_named(name_of(kind)), kind);
        names.insert(name_of(kind));
        bits.insert(bit_of(kind));
    }
    EXPECT_EQ(names.size(), kAllFaults.size());
    EXPECT_EQ(bits.size(), kAllFaults.size());
    EXPECT_EQ(bits.count(0), 0u);
    EXPECT_FALSE(fault_named("packet_lost"));
    EXPECT_FALSE(refusal_of({static_cast<FaultKind>(200), 1, 0, 0, 0, 0}).empty());
}

// Each enumerator of the header has its number; what stands in none of the table's rows would be no kind.
TEST(Faults, TheTableHasEveryKind) {
    std::ifstream in(std::string(HILCAM_SOURCE_DIR) + "/io/contract/fault_kinds.h");
    const std::string header{std::istreambuf_iterator<char>(in), {}};
    const std::regex enumerator(R"(\n    k\w+ = (\d+),)");
    std::set<int> numbers;
    for (std::sregex_iterator found(header.begin(), header.end(), enumerator), none; found != none; ++found)
        numbers.insert(std::stoi((*found)[1]));
    EXPECT_EQ(numbers.size(), kFaultTable.size());
    for (const FaultTraits& row : kFaultTable) EXPECT_EQ(numbers.count(static_cast<int>(row.kind)), 1u);
}

TEST(Faults, TheManualHasThemAll) {
    std::ifstream in(std::string(HILCAM_SOURCE_DIR) + "/docs/faults.md");
    const std::string manual{std::istreambuf_iterator<char>(in), {}};
    for (const FaultKind kind : kAllFaults) {
        const auto bit = std::to_string(std::countr_zero(bit_of(kind)));
        const std::string row =
            "| `" + std::string(name_of(kind)) + "` | " + bit + " | " + std::string(meaning_of(kind)) + " |";
        EXPECT_NE(manual.find(row), std::string::npos) << row;
    }
}

TEST(Faults, TheRateIsWhatWasAskedForAndTheSamePacketsAreStruck) {
    FaultBoard a(7), b(7), other(8);
    for (FaultBoard* board : {&a, &b, &other}) board->order({FaultKind::kPacketDrop, 0.02, 0, 0, 0, 0});
    int struck = 0, same_as_other = 0;
    constexpr int kFrames = 200, kPackets = 500;
    for (std::uint64_t frame = 1; frame <= kFrames; ++frame)
        for (std::uint64_t packet = 0; packet < kPackets; ++packet) {
            const bool hit = a.strikes(FaultKind::kPacketDrop, frame, packet).has_value();
            EXPECT_EQ(hit, b.would_strike(FaultKind::kPacketDrop, frame, packet).has_value());
            struck += hit;
            same_as_other += hit && other.would_strike(FaultKind::kPacketDrop, frame, packet);
        }
    // Binomial, 1e5 at 2 %: 2000, standard deviation 44; five of them. By chance 40 strike in both.
    EXPECT_NEAR(struck, 2000, 220);
    EXPECT_NEAR(same_as_other, 40, 35);
    EXPECT_EQ(a.strikes_of(FaultKind::kPacketDrop), static_cast<std::uint64_t>(struck));
    EXPECT_EQ(b.all_strikes(), 0u);
    // Another kind at the same rate strikes others.
    a.order({FaultKind::kPacketDuplicate, 0.02, 0, 0, 0, 0});
    int both = 0;
    for (std::uint64_t packet = 0; packet < 100'000; ++packet)
        both += a.would_strike(FaultKind::kPacketDrop, 1, packet) &&
                a.would_strike(FaultKind::kPacketDuplicate, 1, packet);
    EXPECT_NEAR(both, 40, 35);
}

TEST(Faults, SpansOfFramesAndOfTimeEndThem) {
    FaultBoard board;
    board.order({FaultKind::kFrameDrop, 1, 0, 10, 3, 0});
    for (std::uint64_t frame = 1; frame < 20; ++frame)
        EXPECT_EQ(board.strikes(FaultKind::kFrameDrop, frame).has_value(), frame >= 10 && frame < 13)
            << frame;
    EXPECT_TRUE(board.would_strike(FaultKind::kFrameDrop, 0));  // what belongs to no frame
    board.order({FaultKind::kControlSilence, 1, 0, 0, 0, 0.02});
    EXPECT_TRUE(board.strikes(FaultKind::kControlSilence, 0, 1));
    std::this_thread::sleep_for(std::chrono::milliseconds(30));
    EXPECT_FALSE(board.strikes(FaultKind::kControlSilence, 0, 2));
    EXPECT_FALSE(board.order_of(FaultKind::kControlSilence));
    ASSERT_TRUE(board.order_of(FaultKind::kFrameDrop));
    EXPECT_EQ(board.order_of(FaultKind::kFrameDrop)->from_frame, 10u);
    board.clear_all();
    EXPECT_FALSE(board.would_strike(FaultKind::kFrameDrop, 11));
}

TEST(Faults, SoManyFramesAtOnceAreTheNextThatBegin) {
    FaultBoard board;
    const auto struck = [&] {
        std::vector<std::uint64_t> frames;
        for (std::uint64_t frame = 1; frame < 200; ++frame)
            if (board.strikes(FaultKind::kImageBlack, frame)) frames.push_back(frame);
        return frames;
    };
    const FaultOrder three{FaultKind::kImageBlack, 1, 0, 0, 3, 0};
    board.order(three);  // before the first frame
    EXPECT_EQ(struck(), (std::vector<std::uint64_t>{1, 2, 3}));
    board.begin(100);
    EXPECT_EQ(board.next_frame(), 101u);
    board.order(three);
    EXPECT_EQ(struck(), (std::vector<std::uint64_t>{101, 102, 103}));
    // A first frame that is named, and an order without an end, stay as they are.
    board.order({FaultKind::kImageBlack, 1, 0, 7, 3, 0});
    EXPECT_EQ(board.order_of(FaultKind::kImageBlack)->from_frame, 7u);
    board.order({FaultKind::kImageBlack, 1, 0, 0, 0, 0});
    EXPECT_EQ(board.order_of(FaultKind::kImageBlack)->from_frame, 0u);
}

TEST(Faults, WhatStrikesOnceStrikesOncePerOrder) {
    FaultBoard board;
    for (int order = 0; order < 2; ++order) {
        board.order({FaultKind::kDeviceReset, 1, 0, 0, 0, 0});
        std::atomic<int> struck{0};
        std::vector<std::thread> threads;
        for (int i = 0; i < 4; ++i)
            threads.emplace_back([&] {
                for (int n = 0; n < 1000; ++n)
                    struck += board.strikes(FaultKind::kDeviceReset, 0).has_value();
            });
        for (std::thread& t : threads) t.join();
        EXPECT_EQ(struck.load(), 1);
    }
}

TEST(Faults, TheLogHasTheFirstStrikeOfEachFrameInOrder) {
    FaultBoard board;
    board.order({FaultKind::kPacketDelay, 1, 5, 0, 0, 0});
    for (std::uint64_t frame = 1; frame <= 3; ++frame)
        for (std::uint64_t packet = 0; packet < 10; ++packet)
            board.strikes(FaultKind::kPacketDelay, frame, packet);
    FaultBoard::Entry entry;
    for (std::uint64_t frame = 1; frame <= 3; ++frame) {
        ASSERT_TRUE(board.take_entry(entry));
        EXPECT_EQ(entry.kind, FaultKind::kPacketDelay);
        EXPECT_EQ(entry.frame, frame);
        EXPECT_EQ(entry.index, 0u);
        EXPECT_EQ(entry.value, 5);
    }
    EXPECT_FALSE(board.take_entry(entry));
    // More than it holds: the newest are there.
    for (std::uint64_t frame = 100; frame < 5000; ++frame) board.strikes(FaultKind::kPacketDelay, frame);
    std::uint64_t taken = 0;
    while (board.take_entry(entry)) ++taken;
    EXPECT_EQ(entry.frame, 4999u);
    EXPECT_EQ(taken, 1024u);
}

TEST(Faults, OrdersMayComeWhileOthersLook) {
    FaultBoard board;
    std::atomic<bool> done{false};
    std::thread looker([&] {
        while (!done) {
            const auto order = board.order_of(FaultKind::kWrongSizeY);
            // Each order has from_frame = value: halves of two orders never mix.
            if (order) {
                EXPECT_EQ(static_cast<double>(order->from_frame), order->value);
            }
        }
    });
    for (std::uint64_t i = 1; i < 60'000; ++i)
        board.order({FaultKind::kWrongSizeY, 1, static_cast<double>(i), i, 0, 0});
    done = true;
    looker.join();
}

}  // namespace
}  // namespace hilcam
