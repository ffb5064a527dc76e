#include "io/ip42/bounded_worker.h"

#include <gtest/gtest.h>

#include <atomic>

#include "io/ip42/ip42_sink.h"
#include "io/system/monotonic.h"

namespace hilcam {
namespace {

using Outcome = BoundedWorker::Outcome;
constexpr std::int64_t kMs_ns = 1'000'000, kLong_ns = 60'000 * kMs_ns;

TEST(BoundedWorker, WorkThatIsDoneInTimeIsWaitedFor) {
    BoundedWorker worker;
    int done = 0;
    for (int i = 1; i <= 100; ++i) {
        EXPECT_EQ(worker.run_until([&] { ++done; }, monotonic_ns() + kLong_ns), Outcome::kDone);
        EXPECT_EQ(done, i);
    }
}

TEST(BoundedWorker, AGiverWaitsNoLongerThanItSays) {
    std::atomic<bool> may_end{false};
    std::atomic<int> begun{0};
    const auto work = [&] {
        ++begun;
        while (!may_end) std::this_thread::yield();
    };
    BoundedWorker worker;
    const std::int64_t start_ns = monotonic_ns();
    EXPECT_EQ(worker.run_until(work, start_ns + 20 * kMs_ns), Outcome::kLate);
    EXPECT_GE(monotonic_ns(), start_ns + 20 * kMs_ns);
    // The next work is not begun, nor kept for later.
    EXPECT_EQ(worker.run_until(work, monotonic_ns() + 20 * kMs_ns), Outcome::kBusy);
    may_end = true;
    EXPECT_EQ(worker.run_until([] {}, monotonic_ns() + kLong_ns), Outcome::kDone);
    EXPECT_EQ(begun, 1);
}

TEST(BoundedWorker, ItsEndWaitsForTheWorkAtHand) {
    std::atomic<bool> may_end{false}, has_ended{false};
    std::thread friendly;
    {
        BoundedWorker worker;
        EXPECT_EQ(worker.run_until(
                      [&] {
                          while (!may_end) std::this_thread::yield();
                          has_ended = true;
                      },
                      monotonic_ns()),
                  Outcome::kLate);
        friendly = std::thread([&] { may_end = true; });
    }
    EXPECT_TRUE(has_ended);
    friendly.join();
}

TEST(Ip42Sink, SaysWhenTheAwaitedFrameIsDoneAndNoOther) {
    Ip42Sink sink("ip42 camera 1", [] { return std::vector<std::pair<std::string, double>>{{"steps", 7}}; });
    const DnImage image(1, 1);
    FrameRecord record;
    record.trigger_sequence = 5;
    record.exposure_mid = {100};
    sink.publish(image, record);  // not awaited
    sink.expect(5, {101});
    sink.publish(image, record);  // another instant's
    EXPECT_FALSE(sink.wait_until(monotonic_ns()));
    record.exposure_mid = {101};
    sink.publish(image, record);
    EXPECT_TRUE(sink.wait_until(monotonic_ns()));
    sink.publish(image, record);  // came already
    EXPECT_FALSE(sink.wait_until(monotonic_ns()));
    // A frame that came after its wait had ended is not the next one.
    sink.expect(6, {102});
    record.trigger_sequence = 6, record.exposure_mid = {102};
    sink.publish(image, record);
    sink.expect(7, {103});
    EXPECT_FALSE(sink.wait_until(monotonic_ns()));
    EXPECT_EQ(sink.report().frames, 2u);
    EXPECT_EQ(sink.report().figures.front().second, 7);
}

}  // namespace
}  // namespace hilcam
