// What lies between the loop and the wire: ring, block ids, queue, pace, faults.

#include "io/gige/stream/gige_ring.h"

#include <gmock/gmock.h>

#include <set>
#include <thread>
#include <vector>

#include "io/gige/stream/gige_frame_writer.h"
#include "io/gige/stream/pacer.h"
#include "io/gige/stream/packet_batch.h"
#include "io/system/bounded_queue.h"

namespace hilcam {
namespace {

GigeSlot* put(GigeRing& ring, std::uint64_t block, std::uint64_t acquisition = 1) {
    GigeSlot* slot = ring.claim();
    if (!slot) return nullptr;
    slot->acquisition = acquisition;
    slot->frame.block = block;
    slot->bytes[0] = static_cast<std::uint8_t>(block);
    ring.publish(*slot);
    return slot;
}
void send_all(GigeRing& ring) {
    while (GigeSlot* slot = ring.next()) ring.done(*slot);
}

TEST(GigeRing, KeepsTheNewestFramesAndAtLeastEight) {
    GigeRing ring(GigeRing::kMinSlots, 1);
    for (std::uint64_t block = 1; block <= 40; ++block) {
        ASSERT_TRUE(put(ring, block));
        send_all(ring);
    }
    std::uint64_t oldest = 0;
    for (std::uint64_t block = 1; block <= 40; ++block) {
        GigeSlot* slot = ring.find(1, block, oldest);
        EXPECT_EQ(slot != nullptr, block > 40 - GigeRing::kMinSlots) << block;
        if (!slot) {
            EXPECT_EQ(oldest, 29u);
            continue;
        }
        EXPECT_EQ(slot->bytes[0], block);
        ring.keep(*slot);
    }
    EXPECT_FALSE(ring.find(2, 40, oldest));
    EXPECT_EQ(oldest, 0u);
    // Waiting, being sent and being written at once: eight are still kept.
    for (std::uint64_t block = 41; block <= 43; ++block) ASSERT_TRUE(put(ring, block));
    ASSERT_TRUE(ring.next());
    EXPECT_FALSE(ring.claim());
    for (std::uint64_t block = 41 - GigeRing::kMinKept; block <= 40; ++block) {
        GigeSlot* slot = ring.find(1, block, oldest);
        ASSERT_TRUE(slot) << block;
        ring.keep(*slot);
    }
}

TEST(GigeRing, FramesThatWaitAreDroppedNotWaitedFor) {
    GigeRing ring(GigeRing::kMinSlots, 1);
    EXPECT_TRUE(put(ring, 1) && put(ring, 2) && put(ring, 3));
    EXPECT_FALSE(put(ring, 4));
    GigeSlot* first = ring.next();
    ASSERT_TRUE(first);
    EXPECT_EQ(first->frame.block, 1u);
    EXPECT_FALSE(put(ring, 4));  // being sent is not sent
    ring.done(*first);
    EXPECT_TRUE(put(ring, 5));
    EXPECT_EQ(ring.next()->frame.block, 2u);
}

TEST(GigeRing, AFrameThatIsReadIsPassedOver) {
    GigeRing ring(GigeRing::kMinSlots, 1);
    for (std::uint64_t block = 1; block <= GigeRing::kMinSlots; ++block) {
        put(ring, block);
        send_all(ring);
    }
    std::uint64_t oldest = 0;
    GigeSlot* held = ring.find(1, 1, oldest);  // the one to be written over next
    ASSERT_TRUE(held);
    for (std::uint64_t block = 100; block < 140; ++block) {
        EXPECT_NE(put(ring, block), held);
        send_all(ring);
    }
    EXPECT_EQ(held->frame.block, 1u);
    ring.keep(*held);
    EXPECT_EQ(put(ring, 140), held);
}

// Loop and sender at once: what is read is never half of another frame. Runs under TSan too.
TEST(GigeRing, ReaderAndWriterNeverMeet) {
    constexpr std::size_t kBytes = 4096;
    GigeRing ring(GigeRing::kMinSlots, kBytes);
    constexpr std::uint64_t kReads = 1000;
    std::atomic<bool> enough{false};
    std::thread loop([&] {
        for (std::uint64_t block = 1; !enough; ++block) {
            GigeSlot* slot = ring.claim();
            if (!slot) {
                std::this_thread::yield();
                continue;
            }
            slot->acquisition = 1;
            slot->frame.block = block;
            std::fill(slot->bytes.begin(), slot->bytes.end(), static_cast<std::uint8_t>(block));
            ring.publish(*slot);
        }
    });
    const auto whole = [](const GigeSlot& slot) {
        const auto byte = static_cast<std::uint8_t>(slot.frame.block);
        return std::all_of(slot.bytes.begin(), slot.bytes.end(),
                           [byte](std::uint8_t b) { return b == byte; });
    };
    std::uint64_t newest = 0;
    for (std::uint64_t reads = 0; reads < kReads;) {
        if (GigeSlot* slot = ring.next()) {
            EXPECT_TRUE(whole(*slot));
            EXPECT_GT(slot->frame.block, newest);
            ++reads;
            newest = slot->frame.block;
            ring.done(*slot);
        }
        std::uint64_t oldest = 0;
        if (GigeSlot* slot = ring.find(1, newest - std::min<std::uint64_t>(newest, 9), oldest)) {
            EXPECT_TRUE(whole(*slot));
            ring.keep(*slot);
        }
    }
    enough = true;
    loop.join();
}

TEST(GigeBlocks, ShortIdsSkipZeroExtendedOnesGoOn) {
    BlockIds ids;
    EXPECT_EQ(ids.take(false, false), 1u);
    EXPECT_EQ(ids.take(false, true), 65530u);
    std::vector<std::uint64_t> next;
    for (int i = 0; i < 7; ++i) next.push_back(ids.take(false, false));
    EXPECT_THAT(next, testing::ElementsAre(65531, 65532, 65533, 65534, 65535, 1, 2));
    EXPECT_EQ(ids.take(true, true), 65530u);
    for (int i = 0; i < 5; ++i) ids.take(true, false);
    EXPECT_EQ(ids.take(true, false), 65536u);
    ids.restart();
    EXPECT_EQ(ids.take(true, false), 1u);
    EXPECT_EQ(blocks_behind(2, 65535, false), 2);
    EXPECT_EQ(blocks_behind(65535, 2, false), -2);
    EXPECT_EQ(blocks_behind(65540, 65530, true), 10);
}

TEST(GigeBlocks, WhyABlockIsNotThereIsToldApart) {
    for (const bool extended : {false, true}) {
        BlockHistory history;
        history.restart(extended);
        EXPECT_EQ(history.why_missing(1, 0), gvsp::kUnavailable);  // nothing was ever sent
        for (std::uint64_t block = 1; block <= 400; ++block)
            if (block != 397) history.sent(block);
        EXPECT_EQ(history.why_missing(401, 389), gvsp::kNotYetAvailable);
        EXPECT_EQ(history.why_missing(397, 389), gvsp::kUnavailable);  // never sent
        EXPECT_EQ(history.why_missing(388, 389), gvsp::kRemovedWithAllBefore);
        EXPECT_EQ(history.why_missing(3, 389), gvsp::kRemovedWithAllBefore);  // beyond the history
        EXPECT_EQ(history.why_missing(395, 389), gvsp::kRemoved);             // an older one is still there
        EXPECT_EQ(history.why_missing(400, 0), gvsp::kRemovedWithAllBefore);
        EXPECT_EQ(history.why_missing(0, 389), gvsp::kUnavailable);
    }
}

TEST(BoundedQueue, GivesEachThingOnceInOrderOfEachThread) {
    BoundedQueue<std::uint64_t, 64> queue;
    for (std::uint64_t i = 0; i < 64; ++i) EXPECT_TRUE(queue.push(i));
    EXPECT_FALSE(queue.push(64));
    std::uint64_t value = 0;
    for (std::uint64_t i = 0; i < 64; ++i) {
        ASSERT_TRUE(queue.pop(value));
        EXPECT_EQ(value, i);
    }
    EXPECT_FALSE(queue.pop(value));

    constexpr std::uint64_t kEach = 20000;
    std::vector<std::thread> writers;
    for (std::uint64_t w = 0; w < 3; ++w)
        writers.emplace_back([&queue, w] {
            for (std::uint64_t i = 0; i < kEach; ++i)
                while (!queue.push(w << 32 | i)) std::this_thread::yield();
        });
    std::array<std::uint64_t, 3> next{};
    for (std::uint64_t got = 0; got < 3 * kEach;) {
        if (!queue.pop(value)) {
            std::this_thread::yield();
            continue;
        }
        ++got;
        ASSERT_EQ(value & 0xFFFFFFFF, next[value >> 32]++);
    }
    for (std::thread& writer : writers) writer.join();
}

TEST(Pacer, BytesArePaidForWithTime) {
    Pacer p;
    p.begin({.bytes_s = 100e6}, 1'000'000);
    p.sent(5, 50'000, 1'000'000);
    EXPECT_EQ(p.ready_ns(), 1'500'000);
    // On time, or a little late: the rate holds on average.
    p.sent(5, 50'000, 1'700'000);
    EXPECT_EQ(p.ready_ns(), 2'000'000);
    // Very late: a millisecond is made up for, no more.
    p.sent(5, 50'000, 50'000'000);
    EXPECT_EQ(p.ready_ns(), 49'500'000);
    // Nothing is saved up between frames.
    p.begin({.bytes_s = 100e6}, 90'000'000);
    EXPECT_EQ(p.ready_ns(), 90'000'000);
    // A frame that ended early does not begin the next one early either.
    p.begin({.bytes_s = 100e6}, 89'000'000);
    EXPECT_EQ(p.ready_ns(), 90'000'000);
}

TEST(Pacer, ADelayIsPerPacket) {
    Pacer p;
    p.begin({.bytes_s = 1e9, .delay_ns = 200'000}, 0);
    p.sent(3, 3000, 0);
    EXPECT_EQ(p.ready_ns(), 3000 + 600'000);
    EXPECT_EQ(p.batch_bytes(), 1u);  // one at a time
    p.begin({.bytes_s = 1e6}, 10'000'000);
    EXPECT_EQ(p.batch_bytes(), 300u);
}

TEST(StreamFaults, ReorderingSwapsPairsAndLosesNothing) {
    FaultBoard faults(5);
    faults.order({.kind = FaultKind::kPacketReorder, .rate = 0.3});
    PacketOrder order(100);
    std::vector<std::uint32_t> ids;
    while (!order.done()) ids.push_back(order.next(faults, 7));
    int swapped = 0;
    for (std::uint32_t i = 0; i < ids.size(); ++i) {
        EXPECT_LE(std::abs(static_cast<int>(ids[i]) - static_cast<int>(i)), 1);
        swapped += ids[i] != i;
    }
    EXPECT_GT(swapped, 0);
    EXPECT_EQ(std::set<std::uint32_t>(ids.begin(), ids.end()).size(), 101u);
    EXPECT_EQ(ids.size(), 101u);
}

TEST(StreamFaults, EachStrikesWhatItsNameSays) {
    using enum FaultKind;
    const auto fate = [](FaultKind kind, double value, std::uint32_t id) {
        FaultBoard faults;
        faults.order({.kind = kind, .rate = 1, .value = value});
        return fate_of_packet(faults, 3, id, 10);
    };
    for (const std::uint32_t id : {0u, 1u, 10u}) {
        EXPECT_TRUE(fate(kPacketDrop, 0, id).lost);
        EXPECT_TRUE(fate(kLinkDown, 0, id).lost);
        EXPECT_EQ(fate(kLeaderLost, 0, id).lost, id == 0);
        EXPECT_EQ(fate(kTrailerLost, 0, id).lost, id == 10);
        EXPECT_TRUE(fate(kPacketDuplicate, 0, id).twice);
        EXPECT_EQ(fate(kPacketCorrupt, 0, id).corrupt, id == 1);
        EXPECT_EQ(fate(kPacketDelay, 2.5, id).delay_ns, 2'500'000);
        EXPECT_EQ(fate(kPacketWrongId, -1, id).id_error, -1);
        EXPECT_EQ(fate(kPacketTruncate, 12, id).cut_bytes, 12u);
        // What strikes resends leaves the first sending alone, and the other way round.
        EXPECT_FALSE(fate(kResendRefused, 0, id).lost);
    }
    FaultBoard faults;
    faults.order({.kind = kPacketDrop, .rate = 1});
    EXPECT_FALSE(fate_of_resend(faults, 3, 1).lost);
    faults.order({.kind = kResendWrongId, .rate = 1, .value = 4});
    faults.order({.kind = kResendDelayed, .rate = 1, .value = 3});
    EXPECT_EQ(fate_of_resend(faults, 3, 1).id_error, 4);
    EXPECT_EQ(fate_of_resend(faults, 3, 1).delay_ns, 3'000'000);
    faults.order({.kind = kResendRefused, .rate = 1});
    EXPECT_TRUE(fate_of_resend(faults, 3, 1).lost);
}

TEST(StreamFaults, TimeStampsStepDriftAndFreeze) {
    FaultBoard faults;
    StampClock clock;
    std::uint64_t seen = 0;
    constexpr std::int64_t kNow = 5'000'000'000'000;
    EXPECT_EQ(clock.stamp(faults, 1, kNow, {0, 37, 0}, seen), std::uint64_t{kNow + 37});
    EXPECT_EQ(seen, 0u);
    faults.order({.kind = FaultKind::kTimestampStep, .rate = 1, .value = -2});
    EXPECT_EQ(clock.stamp(faults, 2, kNow, {}, seen), std::uint64_t{kNow - 2'000'000});
    EXPECT_EQ(seen, bit_of(FaultKind::kTimestampStep));
    faults.clear_all();
    faults.order({.kind = FaultKind::kTimestampDrift, .rate = 1, .value = 100});
    const std::int64_t began = faults.since_monotonic_ns(FaultKind::kTimestampDrift);
    EXPECT_EQ(clock.stamp(faults, 3, began + 1'000'000'000, {}, seen),
              static_cast<std::uint64_t>(began + 1'000'100'000));
    faults.clear_all();
    faults.order({.kind = FaultKind::kTimestampFreeze, .rate = 1});
    EXPECT_EQ(clock.stamp(faults, 4, began + 2'000'000'000, {}, seen),
              static_cast<std::uint64_t>(began + 1'000'100'000));
    faults.clear_all();
    EXPECT_EQ(clock.stamp(faults, 5, kNow, {}, seen), std::uint64_t{kNow});
}

}  // namespace
}  // namespace hilcam
