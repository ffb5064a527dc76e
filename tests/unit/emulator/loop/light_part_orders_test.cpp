// Orders to take a frame apart: done, given up, shared, closed while somebody waits.

#include "emulator/loop/light_part_orders.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <future>
#include <new>
#include <thread>

namespace hilcam {
namespace {

using namespace std::chrono_literals;
using Picture = std::shared_ptr<const LightPartSource::Picture>;
using Wish = LightPartSource::Wish;

FrameRecord record_of(std::uint64_t id) {
    FrameRecord record;
    record.id = id;
    return record;
}

// Orders whose pictures are of one pixel, and have its light as their number.
struct Desk {
    LightPartOrders orders{""};
    std::atomic<int> made{0}, in_hand{0}, max_in_hand{0};

    Desk() {
        orders.serve({[this](LightPart part) {
                          ++made;
                          max_in_hand = std::max(max_in_hand.load(), ++in_hand);
                          return std::make_unique<PartsBuffer>(RadianceImage(1, 1), 1, part);
                      },
                      [this](const RadianceImage& light, const FrameRecord&) {
                          --in_hand;
                          DnImage numbers(1, 1);
                          numbers.row(0)[0] = static_cast<std::uint16_t>(light.row(0)[0]);
                          return numbers;
                      }});
    }
    // What the loop does with an order: a number that says which part and frame it was.
    static std::uint16_t number(LightPart part, std::uint64_t frame) {
        return static_cast<std::uint16_t>(1000 * static_cast<int>(part) + static_cast<int>(frame));
    }
    void finish(LightPartOrders::Order& order, std::uint64_t frame) {
        order.buffer->parts.of(order.part).row(0)[0] = number(order.part, frame);
        orders.done(record_of(frame));
    }
    LightPartOrders::Order* wait_for_order() {
        for (;; std::this_thread::yield())
            if (LightPartOrders::Order* const order = orders.begin()) return order;
    }
    std::future<Picture> ask(const Wish& wish, std::chrono::nanoseconds patience = 60s) {
        return std::async(std::launch::async, [=, this] { return orders.wait_for(wish, patience); });
    }
};

void expect_number(const Picture& picture, LightPart part, std::uint64_t frame) {
    ASSERT_TRUE(picture);
    EXPECT_EQ(picture->record.id, frame);
    EXPECT_EQ(picture->numbers.row(0)[0], Desk::number(part, frame));
}

TEST(LightPartOrders, WhoAsksGetsHisPartOfTheFrameThatBeginsNext) {
    Desk desk;
    EXPECT_EQ(desk.orders.begin(), nullptr) << "nobody has asked";
    auto asked = desk.ask({LightPart::kAir, 0, true});
    LightPartOrders::Order* const order = desk.wait_for_order();
    EXPECT_TRUE(order->with_truth);
    EXPECT_TRUE(order->buffer->parts.has(LightPart::kAir));
    EXPECT_FALSE(order->buffer->parts.has(LightPart::kSun)) << "memory for one part alone";
    EXPECT_EQ(desk.orders.begin(), nullptr) << "it is in work";
    desk.finish(*order, 7);
    expect_number(asked.get(), LightPart::kAir, 7);
    EXPECT_EQ(desk.orders.begin(), nullptr) << "it is done";
    // Another view of the same frame needs no other; who wants a newer one waits for it.
    expect_number(desk.orders.wait_for({LightPart::kAir}, 0s), LightPart::kAir, 7);
    EXPECT_EQ(desk.made, 1);
    EXPECT_EQ(desk.orders.wait_for({LightPart::kAir, 7}, 0s), nullptr);
    EXPECT_EQ(desk.orders.wait_for({LightPart::kSun}, 0s), nullptr) << "that is another part";
}

TEST(LightPartOrders, WhoGivesUpBeforeTheLoopBeginsTakesTheOrderBack) {
    Desk desk;
    EXPECT_EQ(desk.orders.wait_for({LightPart::kSun}, 5ms), nullptr);
    EXPECT_EQ(desk.made, 1);
    EXPECT_EQ(desk.orders.begin(), nullptr);
}

// Where frames take longer than patience lasts, they are shown all the same.
TEST(LightPartOrders, AFrameThatWasGivenUpInWorkIsForWhoAsksNext) {
    for (const LightPart next : {LightPart::kSun, LightPart::kAir}) {
        Desk desk;
        auto given_up = desk.ask({LightPart::kSun}, 50ms);
        LightPartOrders::Order* const order = desk.wait_for_order();
        EXPECT_EQ(given_up.get(), nullptr);
        EXPECT_EQ(desk.orders.wait_for({next}, 5ms), nullptr) << "it is the loop's still";
        EXPECT_EQ(desk.made, 1);
        auto asked = desk.ask({next});
        std::this_thread::sleep_for(5ms);
        desk.finish(*order, 3);
        if (next == LightPart::kAir) desk.finish(*desk.wait_for_order(), 4);
        expect_number(asked.get(), next, next == LightPart::kAir ? 4 : 3);
        EXPECT_EQ(desk.made, next == LightPart::kAir ? 2 : 1);
        EXPECT_EQ(desk.in_hand, 0);
    }
}

TEST(LightPartOrders, TheLoopsEndAnswersWhoWaits) {
    Desk desk;
    const auto begun = std::chrono::steady_clock::now();
    auto first = desk.ask({LightPart::kSun}), second = desk.ask({LightPart::kAir});
    while (desk.made == 0) std::this_thread::yield();
    desk.orders.close();
    EXPECT_EQ(first.get(), nullptr);
    EXPECT_EQ(second.get(), nullptr);
    EXPECT_EQ(desk.orders.wait_for({LightPart::kLamps}, 60s), nullptr) << "nor does anybody wait later";
    EXPECT_LT(std::chrono::steady_clock::now() - begun, 30s);
    EXPECT_EQ(desk.orders.begin(), nullptr);
}

TEST(LightPartOrders, AFrameThatEndsWithTheLoopIsStillGiven) {
    Desk desk;
    auto asked = desk.ask({LightPart::kSun});
    LightPartOrders::Order* const order = desk.wait_for_order();
    desk.finish(*order, 9);
    desk.orders.close();
    expect_number(asked.get(), LightPart::kSun, 9);
}

TEST(LightPartOrders, ManyAreServedOneByOne) {
    Desk desk;
    std::atomic<bool> over{false};
    std::uint64_t frame = 0;  // of those that are taken apart: no two have one number
    std::thread loop([&] {
        for (; !over; std::this_thread::yield())
            if (LightPartOrders::Order* const order = desk.orders.begin()) desk.finish(*order, ++frame);
        desk.orders.close();
    });
    const auto look = [&](LightPart part) {
        std::uint64_t last = 0;
        for (int i = 0; i < 200; ++i) {
            const Picture picture = desk.orders.wait_for({part, last}, 60s);
            ASSERT_TRUE(picture);
            EXPECT_NE(picture->record.id, last);
            last = picture->record.id;
            EXPECT_EQ(picture->numbers.row(0)[0], Desk::number(part, last));
        }
    };
    std::thread same([&] { look(LightPart::kSun); }), other([&] { look(LightPart::kAir); });
    look(LightPart::kSun);
    same.join(), other.join();
    over = true;
    loop.join();
    EXPECT_EQ(desk.max_in_hand, 1);
}

TEST(LightPartOrders, ACameraThatRefusesTakesNone) {
    LightPartOrders orders("quality.motion: found exact");
    EXPECT_EQ(orders.refusal(), "quality.motion: found exact");
    orders.serve({[](LightPart) -> std::unique_ptr<PartsBuffer> {
                      ADD_FAILURE() << "made";
                      return nullptr;
                  },
                  {}});
    EXPECT_EQ(orders.wait_for({LightPart::kSun}, 60s), nullptr);
}

TEST(LightPartOrders, WhoFindsNoMemoryLeavesTheTurnToOthers) {
    LightPartOrders orders("");
    orders.serve({[](LightPart) -> std::unique_ptr<PartsBuffer> { throw std::bad_alloc(); }, {}});
    for (int i = 0; i < 2; ++i) EXPECT_THROW(orders.wait_for({LightPart::kSun}, 60s), std::bad_alloc);
    EXPECT_EQ(orders.begin(), nullptr);
}

}  // namespace
}  // namespace hilcam
