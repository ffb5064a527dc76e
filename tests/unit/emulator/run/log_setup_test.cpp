#include "emulator/run/log_setup.h"

#include <gtest/gtest.h>
#include <pthread.h>

#include <new>
#include <stdexcept>
#include <thread>

namespace hilcam {
namespace {

void end_a_thread(void (*fail)()) {
    set_up_log();
    std::thread([fail] {
        pthread_setname_np(pthread_self(), "sense");
        fail();
    }).join();
}

TEST(LogSetupDeathTest, AThreadThatCannotGoOnSaysWhy) {
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    EXPECT_DEATH(end_a_thread([] { throw std::bad_alloc(); }),
                 "hilcam: thread 'sense' cannot go on, which ends the program: not enough memory\n");
    EXPECT_DEATH(end_a_thread([] { throw std::runtime_error("of \x1b[2Jthis"); }),
                 "which ends the program: of \\?\\[2Jthis\n");
}

}  // namespace
}  // namespace hilcam
