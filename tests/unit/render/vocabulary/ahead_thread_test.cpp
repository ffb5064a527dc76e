#include "render/vocabulary/ahead_thread.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <tbb/parallel_for.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <vector>

namespace hilcam {
namespace {

TEST(AheadThread, DoesWhatItIsAskedForOnceEach) {
    int done = 0;
    AheadThread ahead;
    ahead.start([&] { ++done; });
    for (int asked = 1; asked <= 100; ++asked) {
        EXPECT_FALSE(ahead.is_busy());
        ahead.ask();
        ahead.wait();
        EXPECT_EQ(done, asked);
    }
}

TEST(AheadThread, EndsWhenItIsDoneAndIsBusyFromThenOn) {
    int done = 0;
    AheadThread ahead;
    ahead.start([&] { ++done; });
    ahead.ask();
    ahead.stop();
    EXPECT_EQ(done, 1);
    EXPECT_TRUE(ahead.is_busy());
    EXPECT_FALSE(ahead.is_at_work());
    ahead.wait();  // does not wait
    ahead.stop();
}

// A second's work, of which nobody wants the rest.
TEST(AheadThread, WhoLetsGoOfItDoesNotWaitForAllOfTheWork) {
    constexpr int kPieces = 1000;
    std::atomic<int> made{0};
    {
        AheadThread ahead;
        ahead.start([&] {
            const auto make = [&](int) {
                made.fetch_add(1), made.notify_one();
                std::this_thread::sleep_for(std::chrono::milliseconds(1));
            };
            tbb::parallel_for(0, kPieces, make, tbb::simple_partitioner{});
        });
        ahead.ask();
        made.wait(0);
    }
    EXPECT_LT(made.load(), kPieces);
}

// Tables that come late are given by a thread which is nice itself (emulator/run/light_maker.h).
TEST(AheadThread, IsAsNiceWhoeverStartsIt) {
    const int program = getpriority(PRIO_PROCESS, static_cast<id_t>(getpid()));
    constexpr int kNice = 7;
    int of_plain = -1, of_nice = -1;
    const auto ask = [](int& niceness) {
        AheadThread ahead;
        ahead.start([&] { niceness = getpriority(PRIO_PROCESS, 0); });
        ahead.ask();
        ahead.wait();
    };
    ask(of_plain);
    std::thread([&] {
        setpriority(PRIO_PROCESS, 0, program + kNice);
        ask(of_nice);
    }).join();
    EXPECT_EQ(of_plain, std::min(program + 10, 19));
    EXPECT_EQ(of_nice, of_plain);
}

// Eight pieces, of which the thread is kept in the one that it begins with until it is to give up; the others are the frame's.
TEST(AheadThread, AFrameMakesWhatTheThreadHasNotBegun) {
    constexpr int kPieces = 8;
    std::vector<std::thread::id> made_by(kPieces);
    std::atomic<bool> is_begun{false}, is_whole{true}, gives_up{true};
    const auto make = [&](int piece) {
        made_by[static_cast<std::size_t>(piece)] = std::this_thread::get_id();
        is_begun.store(true), is_begun.notify_one();
        while (gives_up.load() && !AheadThread::was_given_up()) std::this_thread::yield();
    };
    AheadThread ahead;
    ahead.start([&] {
        tbb::parallel_for(0, kPieces, make, tbb::simple_partitioner{});
        is_whole.store(!AheadThread::was_given_up());
    });
    ahead.ask();
    is_begun.wait(false);
    ahead.give_up();
    ahead.wait();
    EXPECT_FALSE(ahead.is_busy());
    EXPECT_FALSE(is_whole.load());
    EXPECT_FALSE(AheadThread::was_given_up()) << "the frame makes the rest";
    EXPECT_EQ(std::ranges::count(made_by, std::thread::id{}), kPieces - 1);

    // The next time it does all of it.
    gives_up.store(false);
    ahead.give_up();  // what is done cannot be
    ahead.ask();
    ahead.wait();
    EXPECT_TRUE(is_whole.load());
    EXPECT_EQ(std::ranges::count(made_by, std::thread::id{}), 0);
}

TEST(AheadThread, NeedsNoStart) {
    AheadThread ahead;
    EXPECT_FALSE(ahead.is_busy());
    ahead.give_up();
    ahead.wait();
    ahead.stop();
}

// What it computes is counted while it runs, and when it is gone; what it waits for is not.
TEST(AheadThread, ItsProcessorTimeIsThatOfItsWork) {
    const std::int64_t before_ns = AheadThread::processor_ns();
    const auto own_ns = [] {
        timespec t{};
        clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
        return std::int64_t{t.tv_sec} * 1'000'000'000 + t.tv_nsec;
    };
    {
        AheadThread ahead;
        ahead.start([&] {
            while (own_ns() < 50'000'000) {
            }
        });
        ahead.ask();
        ahead.wait();
        EXPECT_GE(AheadThread::processor_ns() - before_ns, 50'000'000);
    }
    const std::int64_t all_ns = AheadThread::processor_ns() - before_ns;
    EXPECT_GE(all_ns, 50'000'000);
    EXPECT_LT(all_ns, 100'000'000) << "a thread that ends is not counted twice";
}

}  // namespace
}  // namespace hilcam
