#include "emulator/scenario/real_time.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/resource.h>
#include <unistd.h>

#include <atomic>
#include <semaphore>
#include <thread>

#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

using testing::HasSubstr;

// A thread that waits, and what the system says of it.
class Sleeper {
  public:
    // nicer: than the calling thread.
    explicit Sleeper(int nicer) {
        const int niceness = getpriority(PRIO_PROCESS, 0) + nicer;
        thread_ = std::thread([this, niceness] {
            setpriority(PRIO_PROCESS, 0, niceness);
            id_.store(gettid());
            end_.acquire();
        });
        while (id_.load() == 0) std::this_thread::yield();
    }
    ~Sleeper() {
        end_.release();
        thread_.join();
    }
    int policy() const { return sched_getscheduler(id_.load()); }
    int priority() const {
        sched_param found{};
        sched_getparam(id_.load(), &found);
        return found.sched_priority;
    }
    cpu_set_t cores() const {
        cpu_set_t set;
        sched_getaffinity(id_.load(), sizeof set, &set);
        return set;
    }

  private:
    std::atomic<pid_t> id_{0};
    std::binary_semaphore end_{0};
    std::thread thread_;
};

std::size_t first_core() {
    cpu_set_t set;
    sched_getaffinity(0, sizeof set, &set);
    std::size_t core = 0;
    while (!CPU_ISSET(core, &set)) ++core;
    return core;
}

// Who is as nice as can be cannot be nicer.
bool can_be_nicer() { return getpriority(PRIO_PROCESS, 0) <= 14; }

bool may_have(const RealTime& wishes) {
    try {
        require_rights(wishes);
        return true;
    } catch (const DeviceError&) {
        return false;
    }
}

TEST(RealTime, WithoutAWishNothingChanges) {
    const int usual = sched_getscheduler(0);
    const Sleeper sleeper(0);
    const cpu_set_t before = sleeper.cores();
    raise_threads({});
    EXPECT_EQ(sleeper.policy(), usual);
    const cpu_set_t after = sleeper.cores();
    EXPECT_TRUE(CPU_EQUAL(&before, &after));
}

TEST(RealTime, ThreadsKeepToTheirCoresAndNicerOnesAndTheCallerDoNot) {
    if (!can_be_nicer()) GTEST_SKIP() << "the test itself is as nice as can be";
    const Sleeper loop(0), preview(5);
    const cpu_set_t usual = preview.cores();
    cpu_set_t wished, own;
    CPU_ZERO(&wished);
    CPU_SET(first_core(), &wished);
    raise_threads({0, {static_cast<double>(first_core())}, false});
    const cpu_set_t kept = loop.cores(), of_preview = preview.cores();
    EXPECT_TRUE(CPU_EQUAL(&kept, &wished));
    EXPECT_TRUE(CPU_EQUAL(&of_preview, &usual));
    sched_getaffinity(0, sizeof own, &own);
    EXPECT_TRUE(CPU_EQUAL(&own, &usual));
}

TEST(RealTime, ThreadsGetThePriorityOrAReason) {
    const RealTime wishes{7, {}, false};
    const int usual = sched_getscheduler(0);
    if (!may_have(wishes)) {
        try {
            require_rights(wishes);
        } catch (const DeviceError& error) {
            EXPECT_THAT(error.what(), HasSubstr("loop.priority: found 7; this process may not have it"));
            EXPECT_THAT(error.what(), HasSubstr("rtprio"));
        }
        return;
    }
    if (!can_be_nicer()) GTEST_SKIP() << "the test itself is as nice as can be";
    EXPECT_EQ(sched_getscheduler(0), usual);  // asking changes nothing
    const Sleeper loop(0), preview(5);
    raise_threads(wishes);
    EXPECT_EQ(loop.policy(), SCHED_FIFO);
    EXPECT_EQ(loop.priority(), 7);
    EXPECT_EQ(preview.policy(), usual);
    EXPECT_EQ(sched_getscheduler(0), usual);
}

TEST(RealTime, CoresThatAreNotThereAreNamed) {
    try {
        require_rights({0, {1023}, false});
        FAIL();
    } catch (const DeviceError& error) {
        EXPECT_THAT(error.what(), HasSubstr("loop.cores: found 1023; this process may run on "));
    }
    EXPECT_THROW(require_rights({0, {0.5}, false}), DeviceError);
}

}  // namespace
}  // namespace hilcam
